// Finds the sign of compression: a test begins unloaded, and the load then changes towards it.
#include "measured/sign.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/index.h"
#include "measured/unit.h"

namespace palpate::measured {
namespace {

// Least ratio of the larger to the smaller change; adhesion and noise are smaller than a third.
constexpr double clear = 3.0;

bool is_load(const Dimension& dimension) { return dimension == force || dimension == stress; }

void turn(std::vector<double>& si, std::vector<double>& written) {
  for (double& value : si) value = 0.0 - value;  // 0 stays 0 and does not become -0
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

[[noreturn]] void refuse(const MeasuredCurve& curve, const Span& span) {
  if (span.up == 0.0 && span.down == 0.0)
    throw InputError(
        {curve.file, 0, 0},
        "`" + curve.y_axis.column + "` is the same at every point; name another column with `--y`");
  throw InputError({curve.file, 0, 0},
                   "`" + curve.y_axis.column +
                       "` both rises and falls from its start, so that "
                       "its sign in compression is not clear; give `--compression positive` or "
                       "`--compression negative`");
}

// Whether the load is negative in compression.
bool load_is_negative(const MeasuredCurve& curve, std::size_t rest) {
  // Over a length the load is at rest at one end; over time it may start at its peak, so that 0 is
  // used.
  const bool along = curve.x_axis.dimension == length ||
                     (curve.x_axis.has_unit && curve.x_axis.dimension == Dimension{});
  const Span span = span_of(curve.y, along ? curve.y[rest] : 0.0);
  if (span.down >= clear * span.up && span.down > 0.0) return true;
  if (span.up >= clear * span.down && span.up > 0.0) return false;
  refuse(curve, span);
}

// Changes the sign of x if it is a length or a strain that decreases while the load grows.
void turn_length(MeasuredCurve& curve, std::size_t rest) {
  const bool strain = curve.x_axis.has_unit && curve.x_axis.dimension == Dimension{};
  if ((curve.x_axis.dimension != length && !strain) || !is_load(curve.y_axis.dimension)) return;
  const std::size_t peak = span_of(curve.y, curve.y[rest]).peak;
  if (curve.x[peak] >= curve.x[rest]) return;
  turn(curve.x, curve.x_written);
  curve.notes.push_back("`" + curve.x_axis.column + "` falls as the load grows; sign changed");
}

}  // namespace

bool only_retracts(std::span<const double> x, std::span<const double> load) {
  std::vector<double> way, change;  // from the first row
  std::optional<std::size_t> first;
  std::size_t last = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(load[i])) continue;
    if (!first) first = i;
    last = i;
    way.push_back(std::abs(x[i] - x[*first]));
    change.push_back(std::abs(load[i] - load[*first]));
  }
  if (way.size() < 4 || way.back() < 0.9 * *std::max_element(way.begin(), way.end())) return false;
  if (!(std::abs(load[*first]) > std::abs(load[last]))) return false;
  const auto most = std::max_element(change.begin(), change.end());
  const auto half = std::find_if(way.begin(), way.end(), [&](double each) {
    return each >= 0.5 * way[as_index(most - change.begin())];
  });
  return change[as_index(half - way.begin())] > 0.5 * *most;
}

void orient(MeasuredCurve& curve, const DataLayout& layout) {
  const std::string& said = layout.compression;
  if (!said.empty() && said != "positive" && said != "negative" && said != "auto")
    throw InputError({}, "palpate: `--compression " + said +
                             "` is unknown; give `positive`, `negative` or `auto`");
  if (said.empty() || said == "positive" || curve.y.empty()) return;
  if (said == "auto" && curve.x_axis.stretch) return;  // below 1 it is compression
  if (!is_load(curve.y_axis.dimension)) {
    if (said == "auto") return;
    throw InputError({curve.file, 0, 0}, "`" + curve.y_axis.column +
                                             "` is no load, to which `--compression negative` "
                                             "could apply; name a column of forces with `--y`");
  }
  const bool retract = layout.segment.starts_with("retract") ||
                       (curve.x_axis.dimension == length && only_retracts(curve.x, curve.y));
  const std::size_t rest = retract ? curve.y.size() - 1 : 0;
  const bool negative = said == "negative" || load_is_negative(curve, rest);
  if (negative) {
    turn(curve.y, curve.y_written);
    curve.notes.push_back("`" + curve.y_axis.column + "` is negative in compression; sign changed");
  }
  turn_length(curve, rest);
}

}  // namespace palpate::measured
