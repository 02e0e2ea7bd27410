// F is proportional to E; the contact point is searched on a grid first, then both by Ceres.
#include "fit/contact_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"
#include "contact/hertz.h"
#include "contact/layer.h"
#include "fit/ceres_fit.h"
#include "fit/settle.h"

namespace palpate::fit {
namespace {

// The contact law for E* = 1 Pa.
class UnitLaw {
 public:
  explicit UnitLaw(const ContactTest& test) : radius_(test.radius) {
    if (!test.thickness) return;
    const contact::Layer layer{.poisson_ratio = test.poisson_ratio, .base = test.base};
    layer_.emplace(
        contact::LayerContact{test.radius, 1.0, *test.thickness, contact::LayerLaw(layer)});
  }

  [[nodiscard]] double force(double depth) const {
    return layer_ ? layer_->force(depth) : contact::hertz::force(depth, radius_, 1.0);
  }
  [[nodiscard]] double stiffness(double depth) const {
    if (layer_) return layer_->stiffness(depth);
    return depth > 0.0 ? contact::hertz::stiffness(depth, radius_, 1.0) : 0.0;
  }
  [[nodiscard]] double deepest() const {  // m
    return layer_ ? layer_->last_depth() : std::numeric_limits<double>::infinity();
  }

 private:
  double radius_;
  std::optional<contact::LayerContact> layer_;
};

struct Points {
  std::vector<double> depth;  // m
  std::vector<double> force;  // divided by force_scale
  double force_scale = 1.0;   // N, largest magnitude
  double low = 0.0;           // m, smallest depth
  double high = 0.0;          // m, largest depth
};

Points usable(std::span<const double> depth, std::span<const double> force, Fit& fit) {
  Points points;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (!std::isfinite(depth[i]) || !std::isfinite(force[i])) continue;
    points.depth.push_back(depth[i]);
    points.force.push_back(force[i]);
  }
  fit.n = static_cast<int>(points.depth.size());
  fit.left_out = static_cast<int>(depth.size()) - fit.n;
  if (fit.n < 4)
    throw InputError({}, "the model `" + fit.name + "` needs at least 4 points, and " +
                             std::to_string(fit.n) + (fit.n == 1 ? " is" : " are") +
                             " usable; record more points");
  const auto [low, high] = std::minmax_element(points.depth.begin(), points.depth.end());
  points.low = *low;
  points.high = *high;
  if (points.low == points.high)
    throw InputError({}, "all points have the same depth; give a curve over depth");
  double largest = 0.0;
  for (const double each : points.force) largest = std::max(largest, std::abs(each));
  if (largest > 0.0) points.force_scale = largest;
  for (double& each : points.force) each /= points.force_scale;
  return points;
}

struct Start {
  double factor = 0.0;   // E* / force_scale, 1/m^2
  double contact = 0.0;  // h_0, m
};

// The best factor for a given contact point, by linear least squares, and its sum of squares.
struct Suited {
  double factor, squares;
};
std::optional<Suited> suited(const UnitLaw& law, const Points& points, double contact) {
  double product = 0.0;
  double norm = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < points.depth.size(); ++i) {
    const double unit = law.force(points.depth[i] - contact);
    product += unit * points.force[i];
    norm += unit * unit;
    total += points.force[i] * points.force[i];
  }
  if (!(norm > 0.0) || !std::isfinite(norm)) return std::nullopt;
  return Suited{product / norm, total - product * product / norm};
}

// The best of 400 contact points, from one range before the first depth to just before the last.
std::optional<Start> start_of(const UnitLaw& law, const Points& points) {
  constexpr int steps = 400;
  const double range = points.high - points.low;
  std::optional<Start> best;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < steps; ++i) {
    const double contact = points.low + range * (2.0 * i / steps - 1.0);
    if (points.high - contact > law.deepest()) continue;
    const auto found = suited(law, points, contact);
    if (!found || !(found->squares < least)) continue;
    least = found->squares;
    best = Start{found->factor, contact};
  }
  return best;
}

}  // namespace

Fit fit_contact(std::span<const double> depth, std::span<const double> force,
                const ContactTest& test) {
  assert(depth.size() == force.size() && test.radius > 0.0);
  Fit fit;
  fit.name = test.thickness ? "layer" : "hertz";
  fit.parameters = {{.name = "E", .unit = "kPa"}, {.name = "h_0", .unit = "mm"}};
  const Points points = usable(depth, force, fit);
  fit.range_low = unit::mm.from_si(points.low);
  fit.range_high = unit::mm.from_si(points.high);
  const UnitLaw law(test);
  const auto start = start_of(law, points);
  if (!start)
    throw InputError({},
                     "the curve is deeper than " + rounded_text(unit::mm.from_si(law.deepest())) +
                         " mm, up to which the law of so thin a layer is valid; give the part of "
                         "the curve up to that depth");
  if (!(start->factor > 0.0))
    throw InputError({},
                     "the load falls with depth; give `--compression negative` if the load cell "
                     "reports compression as negative, or another `--x`");

  // Unknowns: E* divided by its initial guess, the contact point divided by the range of depths.
  const double range = points.high - points.low;
  const CurveAt curve = [&](std::span<const double> p, std::span<double> values,
                            std::span<double> slopes) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double at = points.depth[i] - p[1] * range;
      const double unit = start->factor * law.force(at);
      values[i] = p[0] * unit;
      if (slopes.empty()) continue;
      slopes[2 * i] = unit;
      slopes[2 * i + 1] = -p[0] * start->factor * law.stiffness(at) * range;
    }
    return true;
  };
  const std::array unknowns{1.0, start->contact / range};
  const Minimum minimum = minimise(points.force, curve, unknowns, 200);
  // E = E* (1 - nu^2) for a rigid sphere               Chen 2007 eq. (2); docs/theory.md (1)
  const double young =
      start->factor * points.force_scale * (1.0 - test.poisson_ratio * test.poisson_ratio);
  const std::array scale{unit::kPa.from_si(young), unit::mm.from_si(range)};
  fit.parameters[0].initial = scale[0];
  fit.parameters[1].initial = unknowns[1] * scale[1];
  settle(fit, minimum, {points.force, points.force_scale, scale});
  return fit;
}

}  // namespace palpate::fit
