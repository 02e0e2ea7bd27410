// Colgate and Brown's bound, for the damping and for the stiffness.
#include "contact/passivity.h"

#include <cmath>
#include <limits>

#include "base/numerics.h"

namespace palpate::contact {

double needed_damping(double stiffness, const SampledDevice& device) {
  return stiffness * (0.5 * device.frame + device.delay) + std::abs(device.virtual_damping);
}

double passive_stiffness(const SampledDevice& device) {
  const double spare = device.damping - std::abs(device.virtual_damping);
  return spare > 0.0 ? spare / (0.5 * device.frame + device.delay) : 0.0;
}

double passive_depth(const PointLaw& law, const SampledDevice& device) {
  const double most = passive_stiffness(device);
  if (most <= 0.0) return 0.0;
  double low = 0.0;
  double high = 1e-9;
  while (law.stiffness(high) < most) {
    low = high;
    high *= 2.0;
    if (high > 1e3 || high > law.last_depth()) return std::numeric_limits<double>::infinity();
  }
  return numerics::root({low, high}, [&](double depth) { return law.stiffness(depth) - most; })
      .high;
}

}  // namespace palpate::contact
