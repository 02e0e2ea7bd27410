// Coulomb's limit, and the inverse of Cattaneo's and Mindlin's solution.
#include "contact/friction.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/numerics.h"

namespace palpate::contact::friction {
namespace {

// No body is taken to be stiffer than 5 half-spaces.
constexpr double most_stiffening = 0.8;

// `beyond`, shortened so that its smaller eigenvalue in the plane is at least `least` (m/N, < 0).
Eigen::Matrix3d bounded(const Eigen::Matrix3d& beyond, double least) {
  const double mean = 0.5 * beyond.trace();
  const double smaller = mean - std::sqrt(std::max(0.0, 0.5 * beyond.squaredNorm() - mean * mean));
  return smaller < least ? Eigen::Matrix3d(least / smaller * beyond) : beyond;
}

}  // namespace

double limit(double coefficient, double contact_force, double weight) {
  return coefficient * (contact_force + weight);
}

Vec3 drag(Vec3& stretch, double limit, double contact_radius, double shear_compliance,
          const Eigen::Matrix3d& beyond) {
  if (!(limit > 0.0)) {
    stretch.setZero();
    return Vec3::Zero();
  }
  // x_slip = 3 mu F q / (16 a),  T = mu F [1 - (1 - x / x_slip)^(3/2)]
  const double most = 3.0 * limit * shear_compliance / (16.0 * contact_radius);
  const double length = stretch.norm();
  if (length <= 0.0) return Vec3::Zero();
  if (!beyond.isZero(0.0)) {
    // T = (b 1 + S)^-1 x. While the core c = k a sticks, b T is Mindlin's displacement and
    // |T| = mu F (1 - k^3); during slip |T| = mu F determines b, and x is shortened.
    const Eigen::Matrix3d body =
        bounded(beyond, -most_stiffening * shear_compliance / (8.0 * contact_radius));
    const auto force = [&](double of_half_space) {
      const Eigen::Matrix3d whole = of_half_space * Eigen::Matrix3d::Identity() + body;
      return Vec3(whole.inverse() * stretch);
    };
    const auto sticking = [&](double k) { return most / limit * (1.0 + k) / (1.0 + k + k * k); };
    if (force(sticking(0.0)).norm() < limit) {
      const auto excess = [&](double k) {
        return limit * (1.0 - k * k * k) - force(sticking(k)).norm();
      };
      const double core = numerics::root({0.0, 1.0}, excess).middle();
      return force(sticking(core));
    }
    const auto excess = [&](double of_half_space) { return force(of_half_space).norm() - limit; };
    const double least = sticking(0.0);
    const double slipping =
        numerics::root({least, least + length / limit + body.norm()}, excess).middle();
    Vec3 slip = limit * force(slipping).normalized();
    stretch -= (slipping - least) * slip;
    return slip;
  }
  const Vec3 direction = stretch / length;
  if (length > most) stretch = most * direction;
  const double left = std::max(0.0, 1.0 - length / most);
  return limit * (1.0 - left * std::sqrt(left)) * direction;
}

}  // namespace palpate::contact::friction
