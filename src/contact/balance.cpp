// One scalar equation a contact, in turn until none of them moves.
#include "contact/balance.h"

#include <algorithm>
#include <cmath>

namespace palpate::contact {

double PointLaw::force(double depth) const {
  return depth > 0.0 ? coefficient * depth * std::sqrt(depth) : 0.0;
}

double PointLaw::stiffness(double depth) const {
  return depth > 0.0 ? 1.5 * coefficient * std::sqrt(depth) : 0.0;
}

std::optional<double> penetration(const PointLaw& law, double approach, double compliance) {
  if (approach <= 0.0) return 0.0;
  const auto excess = [&](double h) { return h + compliance * law.force(h) - approach; };
  double low = 0.0;
  double high = approach;
  if (compliance < 0.0) {
    // h + C F(h) grows until its slope 1 + C dF/dh is zero, at sqrt(h) = -2 / (3 C c).
    const double root = -2.0 / (3.0 * compliance * law.coefficient);
    high = root * root;
    if (excess(high) < 0.0) return std::nullopt;
  }
  // Newton within a bracket: the function rises all the way, so it cannot miss.
  double h = std::min(approach, high);
  for (int i = 0; i < 100; ++i) {
    const double value = excess(h);
    if (value == 0.0) return h;
    (value > 0.0 ? high : low) = h;
    const double slope = 1.0 + compliance * law.stiffness(h);
    double next = h - value / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - h) <= 1e-15 * h) return next;
    h = next;
  }
  return h;
}

bool balance(std::span<const PointLaw> laws, std::span<const double> approaches,
             const Eigen::MatrixXd& compliance, std::span<double> depths) {
  constexpr int most_sweeps = 1000;
  const std::size_t count = laws.size();
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double moved = 0.0;
    double deepest = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      double approach = approaches[i];
      for (std::size_t j = 0; j < count; ++j)
        if (j != i)
          approach -= compliance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *
                      laws[j].force(depths[j]);
      const auto own = static_cast<Eigen::Index>(i);
      const auto depth = penetration(laws[i], approach, compliance(own, own));
      if (!depth) return false;
      moved = std::max(moved, std::abs(*depth - depths[i]));
      deepest = std::max(deepest, *depth);
      depths[i] = *depth;
    }
    if (count == 1 || moved <= 1e-15 * deepest) return true;
  }
  return false;
}

}  // namespace palpate::contact
