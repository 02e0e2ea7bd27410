// Tabulates the integral by cubic pieces through its values and slopes.
#include "contact/layer_sinking.h"

#include <math.h>  // j0, j1: POSIX

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/index.h"
#include "base/numerics.h"

namespace palpate::contact {
namespace {

constexpr double last_rho = 12.0;
constexpr int waves_for_bessel =
    400;  // the integrand has (20 / pi) rho periods, 80 at the last rho

}  // namespace

LayerSinking::LayerSinking(const Layer& layer, double farthest) {
  const auto tabulate = [&](double last, int pieces, int count) {
    const auto waves = layer_waves(layer, count);
    Table table{last, pieces, {}};
    // One piece more than is needed, because of rounding.
    const double most = std::min(farthest * pieces / last + 2.0, static_cast<double>(pieces));
    for (int i = 0; i <= most; ++i) {
      const double rho = last * i / pieces;
      Knot knot{0.0, 0.0};
      for (const auto& wave : waves) {
        knot.value += wave.missing * numerics::bessel_j(0, wave.number * rho);
        knot.slope -= wave.missing * wave.number * numerics::bessel_j(1, wave.number * rho);
      }
      table.knots.push_back(knot);
    }
    tables_.push_back(std::move(table));
  };
  // Near the force the shortest length is the top layer's thickness, far away it is the distance.
  const double top = layer.top();
  tabulate(last_rho * top, 480, waves_for_bessel);
  if (!layer.below.empty() && farthest >= last_rho * top)
    tabulate(last_rho, 64, static_cast<int>(waves_for_bessel / top));
}

double LayerSinking::gamma(double rho) const {
  const auto table = std::find_if(tables_.begin(), tables_.end(),
                                  [&](const Table& one) { return rho < one.last_rho; });
  if (table == tables_.end()) return 1.0 / rho;
  const double width = table->last_rho / table->pieces;
  const double at = rho / width;
  const int piece = std::min(static_cast<int>(at), table->pieces - 1);
  assert(as_index(piece) + 1 < table->knots.size());
  const Knot& left = table->knots[as_index(piece)];
  const Knot& right = table->knots[as_index(piece) + 1];
  const double t = at - piece;
  const double s = 1.0 - t;
  return s * s * ((1.0 + 2.0 * t) * left.value + t * width * left.slope) +
         t * t * ((1.0 + 2.0 * s) * right.value - s * width * right.slope);
}

}  // namespace palpate::contact
