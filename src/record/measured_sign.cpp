// A test begins unloaded: compression is where the load goes from there.
#include "record/measured_sign.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace palpate::record {
namespace {

constexpr Dimension length{1, 0, 0};
constexpr Dimension force{1, 1, -2};
constexpr Dimension pressure{-1, 1, -2};

// By how much the larger side must outweigh the other: an adhesive or noisy curve stays below.
constexpr double clear = 3.0;

bool is_load(const Dimension& dimension) { return dimension == force || dimension == pressure; }

void turn(std::vector<double>& si, std::vector<double>& written) {
  for (double& value : si) value = 0.0 - value;  // so that 0 stays 0 and does not become -0
  for (double& value : written) value = 0.0 - value;
}

struct Span {
  double up = 0.0;    // above the start
  double down = 0.0;  // below it
  std::size_t peak = 0;
};

Span span_of(const std::vector<double>& values, double start) {
  Span span;
  double farthest = -1.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double away = values[i] - start;
    if (!std::isfinite(away)) continue;
    span.up = std::max(span.up, away);
    span.down = std::max(span.down, -away);
    if (std::abs(away) > farthest) span.peak = i;
    farthest = std::max(farthest, std::abs(away));
  }
  return span;
}

[[noreturn]] void refuse(const MeasuredCurve& curve) {
  throw InputError({curve.file, 0, 0},
                   "`" + curve.y_axis.column +
                       "` goes both ways from where it starts, so that "
                       "its sign in compression cannot be told; give `--compression positive` or "
                       "`--compression negative`");
}

// Whether the load is negative in compression.
bool load_is_negative(const MeasuredCurve& curve) {
  // Over a length the load starts at rest; over time it may start at its peak, so that its own
  // sign tells.
  const bool along = curve.x_axis.dimension == length;
  const Span span = span_of(curve.y, along ? curve.y.front() : 0.0);
  if (span.down >= clear * span.up && span.down > 0.0) return true;
  if (span.up >= clear * span.down && span.up > 0.0) return false;
  refuse(curve);
}

// Where a length falls while the load (or, over time, the length itself) grows, down is negative.
void turn_length(MeasuredCurve& curve) {
  if (curve.x_axis.dimension != length || !is_load(curve.y_axis.dimension)) return;
  const std::size_t peak = span_of(curve.y, curve.y.front()).peak;
  if (curve.x[peak] >= curve.x.front()) return;
  turn(curve.x, curve.x_written);
  curve.notes.push_back("`" + curve.x_axis.column + "` falls as the load grows; turned round");
}

}  // namespace

void orient(MeasuredCurve& curve, const DataLayout& layout) {
  const std::string& said = layout.compression;
  if (!said.empty() && said != "positive" && said != "negative" && said != "auto")
    throw InputError({}, "palpate: `--compression " + said +
                             "` is unknown; give `positive`, `negative` or `auto`");
  if (said.empty() || said == "positive" || curve.y.empty()) return;
  if (!is_load(curve.y_axis.dimension)) {
    if (said == "auto") return;
    throw InputError({curve.file, 0, 0}, "`" + curve.y_axis.column +
                                             "` is no load, so that `--compression negative` says "
                                             "nothing of it; name a column of forces with `--y`");
  }
  const bool negative = said == "negative" || load_is_negative(curve);
  if (negative) {
    turn(curve.y, curve.y_written);
    curve.notes.push_back("`" + curve.y_axis.column + "` reads compression negative; turned round");
  }
  turn_length(curve);
}

}  // namespace palpate::record
