// Cubic pieces through values and slopes of the integral.
#include "contact/layer_sinking.h"

#include <math.h>  // j0, j1: POSIX

#include <algorithm>
#include <cmath>

namespace palpate::contact {
namespace {

constexpr double last_rho = 12.0;
constexpr int waves_for_bessel = 400;  // which make (20 / pi) rho turns, 80 at the last rho

}  // namespace

LayerSinking::LayerSinking(const Layer& layer) {
  const auto tabulate = [&](double last, int pieces, int count) {
    const auto waves = layer_waves(layer, count);
    Table table{last, {}};
    table.knots.reserve(static_cast<std::size_t>(pieces) + 1);
    for (int i = 0; i <= pieces; ++i) {
      const double rho = last * i / pieces;
      Knot knot{0.0, 0.0};
      // Bessel's functions are evaluated here, at set-up, only: those of the C library, within
      // its last digits of std::cyl_bessel_j and 30 times faster.
      for (const auto& wave : waves) {
        knot.value += wave.missing * ::j0(wave.number * rho);
        knot.slope -= wave.missing * wave.number * ::j1(wave.number * rho);
      }
      table.knots.push_back(knot);
    }
    tables_.push_back(std::move(table));
  };
  // The top layer's thickness is the shortest length near the force, the distance itself far away.
  const double top = layer.top();
  tabulate(last_rho * top, 480, waves_for_bessel);
  if (!layer.below.empty()) tabulate(last_rho, 64, static_cast<int>(waves_for_bessel / top));
}

double LayerSinking::gamma(double rho) const {
  const auto table = std::find_if(tables_.begin(), tables_.end(),
                                  [&](const Table& one) { return rho < one.last_rho; });
  if (table == tables_.end()) return 1.0 / rho;
  const int pieces = static_cast<int>(table->knots.size()) - 1;
  const double width = table->last_rho / pieces;
  const double at = rho / width;
  const int piece = std::min(static_cast<int>(at), pieces - 1);
  const Knot& left = table->knots[static_cast<std::size_t>(piece)];
  const Knot& right = table->knots[static_cast<std::size_t>(piece) + 1];
  const double t = at - piece;
  const double s = 1.0 - t;
  return s * s * ((1.0 + 2.0 * t) * left.value + t * width * left.slope) +
         t * t * ((1.0 + 2.0 * s) * right.value - s * width * right.slope);
}

}  // namespace palpate::contact
