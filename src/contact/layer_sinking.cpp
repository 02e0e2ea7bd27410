// Cubic pieces through values and slopes of the integral.
#include "contact/layer_sinking.h"

#include <algorithm>
#include <cmath>

namespace palpate::contact {
namespace {

constexpr int pieces = 480;
constexpr int waves_for_bessel = 400;  // which make (20 / pi) rho turns, 80 at the last rho

}  // namespace

LayerSinking::LayerSinking(const Layer& layer) {
  const auto waves = layer_waves(layer, waves_for_bessel);
  knots_.reserve(pieces + 1);
  for (int i = 0; i <= pieces; ++i) {
    const double rho = last_rho * i / pieces;
    Knot knot{0.0, 0.0};
    // Bessel's functions are evaluated here, at set-up, only.
    for (const auto& wave : waves) {
      knot.value += wave.missing * std::cyl_bessel_j(0.0, wave.number * rho);
      knot.slope -= wave.missing * wave.number * std::cyl_bessel_j(1.0, wave.number * rho);
    }
    knots_.push_back(knot);
  }
}

double LayerSinking::gamma(double rho) const {
  if (rho >= last_rho) return 1.0 / rho;
  const double width = last_rho / pieces;
  const double at = rho / width;
  const int piece = std::min(static_cast<int>(at), pieces - 1);
  const Knot& left = knots_[static_cast<std::size_t>(piece)];
  const Knot& right = knots_[static_cast<std::size_t>(piece) + 1];
  const double t = at - piece;
  const double s = 1.0 - t;
  return s * s * ((1.0 + 2.0 * t) * left.value + t * width * left.slope) +
         t * t * ((1.0 + 2.0 * s) * right.value - s * width * right.slope);
}

}  // namespace palpate::contact
