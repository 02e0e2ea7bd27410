// Boussinesq's and Cerruti's solutions summed over a quadrature of Hertz's pressure.
#include "contact/patch_field.h"

#include <cmath>
#include <numbers>

#include "base/numerics.h"

namespace palpate::contact {
PatchField::PatchField(double a, double b, const HalfSpace& half_space, int finer,
                       const Vec3& along)
    : half_space_(half_space), along_(along), reach_(std::max(a, b)) {
  constexpr std::array<std::array<int, 2>, 3> rings_and_spokes{{{2, 6}, {4, 12}, {10, 30}}};
  for (std::size_t level = 0; level < loads_.size(); ++level) {
    const int rings = finer * rings_and_spokes[level][0];
    const int spokes = finer * rings_and_spokes[level][1];
    // With v^2 = 1 - s^2 the load inside the radius s is the integral of 3 v^2 dv: polynomials in
    // s^2 are integrated exactly by a Gauss-Legendre rule for even functions of v.
    const numerics::GaussRule& rule = numerics::gauss_rule(2 * rings);
    for (int ring = 0; ring < rings; ++ring) {
      const auto outermost = as_index(2 * rings - 1 - ring);  // of those that are left, v > 0
      const double v = rule.nodes[outermost];
      const double s = std::sqrt(1.0 - v * v);
      const double share = 3.0 * v * v * rule.weights[outermost] / spokes;
      for (int spoke = 0; spoke < spokes; ++spoke) {
        const double angle = 2.0 * std::numbers::pi * (spoke + 0.5 * (ring % 2)) / spokes;
        loads_[level].push_back({a * s * std::cos(angle), b * s * std::sin(angle), share});
      }
    }
  }
}

const std::vector<PatchField::PointLoad>& PatchField::loads_for(const Vec3& point) const {
  const double distance = point.norm() / reach_;
  return loads_[distance > 8.0 ? 0 : distance > 3.0 ? 1 : 2];
}

// With R from the load to the point, z its depth and p = R . along (Johnson 1985, eq. (3.75)):
// 4 pi G u = along (1/|R| + k/(|R|+z)) + R p/|R|^3 - k p r/(|R| (|R|+z)^2) - k p n/(|R| (|R|+z)),
// k = 1 - 2 nu, r the part of R in the plane, n = (0, 0, 1) outwards.
Vec3 PatchField::dragged(const Vec3& point) const {
  const double k = 1.0 - 2.0 * half_space_.poisson_ratio;
  const double z = std::max(-point.z(), 0.0);
  const double least = 1e-12 * reach_ * reach_;
  Vec3 sum = Vec3::Zero();
  for (const PointLoad& load : loads_for(point)) {
    const Vec3 from(point.x() - load.x, point.y() - load.y, -z);
    const double away = std::sqrt(from.squaredNorm() + least);
    const double inner = away * (away + z);
    const double p = from.dot(along_);
    sum += load.share * ((1.0 / away + k / (away + z)) * along_ + p / (away * away * away) * from -
                         k * p / inner * Vec3(from.x() / (away + z), from.y() / (away + z), 1.0));
  }
  return sum / (4.0 * std::numbers::pi * half_space_.shear_modulus);
}

// 2 pi sigma = -3 p R R^T/|R|^5 + k [p (1/|R|^3 - 1/(|R| d^2)) 1 - (along r^T + r along^T)/(|R|
// d^2)
//              + p (1/(|R|^3 d^2) + 2/(|R|^2 d^3)) r r^T],  d = |R| + z;       eq. (3.76)
// what has the factor k acts in the plane only.
Eigen::Matrix3d PatchField::drag_stress(const Vec3& point) const {
  const double k = 1.0 - 2.0 * half_space_.poisson_ratio;
  const double z = std::max(-point.z(), 0.0);
  const double least = 1e-12 * reach_ * reach_;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const PointLoad& load : loads_for(point)) {
    const Vec3 from(point.x() - load.x, point.y() - load.y, -z);
    const double away2 = from.squaredNorm() + least;
    const double away = std::sqrt(away2);
    const double d = away + z;
    const double inner = 1.0 / (away * d * d);
    const double p = from.dot(along_);
    sum -= load.share * 3.0 * p / (away2 * away2 * away) * from * from.transpose();
    const Eigen::Vector2d r = from.head<2>();
    const Eigen::Matrix2d turned = along_.head<2>() * r.transpose();
    sum.topLeftCorner<2, 2>() += load.share * k *
                                 (p * (1.0 / (away2 * away) - inner) * Eigen::Matrix2d::Identity() -
                                  inner * (turned + turned.transpose()) +
                                  p * inner * (1.0 / away2 + 2.0 / (away * d)) * r * r.transpose());
  }
  return sum / (2.0 * std::numbers::pi);
}

Vec3 PatchField::displacement(const Vec3& point) const {
  if (along_.z() > -0.5) return dragged(point);
  const double nu = half_space_.poisson_ratio;
  const double scale = 1.0 / (4.0 * std::numbers::pi * half_space_.shear_modulus);
  const double z = std::max(-point.z(), 0.0);
  const double least = 1e-12 * reach_ * reach_;  // m^2: the point may lie on a point load
  Vec3 sum = Vec3::Zero();
  for (const PointLoad& load : loads_for(point)) {
    const double x = point.x() - load.x;
    const double y = point.y() - load.y;
    const double away = std::sqrt(x * x + y * y + least + z * z);
    const double inward = z / (away * away * away) - (1.0 - 2.0 * nu) / (away * (away + z));
    const double down = z * z / (away * away * away) + 2.0 * (1.0 - nu) / away;
    sum += load.share * Vec3(inward * x, inward * y, -down);
  }
  return scale * sum;
}

FieldValue PatchField::at(const Vec3& point) const {
  if (along_.z() > -0.5) return {.displacement = dragged(point), .stress = drag_stress(point)};
  const double nu = half_space_.poisson_ratio;
  const double z = std::max(-point.z(), 0.0);
  const double least = 1e-12 * reach_ * reach_;
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
  for (const PointLoad& load : loads_for(point)) {
    const double x = point.x() - load.x;
    const double y = point.y() - load.y;
    const double r2 = x * x + y * y + least;
    const double away2 = r2 + z * z;
    const double away = std::sqrt(away2);
    const double away5 = away2 * away2 * away;
    const double inner = away * (away + z);
    const double radial = load.share * ((1.0 - 2.0 * nu) / inner - 3.0 * r2 * z / away5);
    const double hoop = load.share * (1.0 - 2.0 * nu) * (z / (away2 * away) - 1.0 / inner);
    const double shear = load.share * 3.0 * z * z / away5;
    xx += (radial * x * x + hoop * y * y) / r2;
    yy += (radial * y * y + hoop * x * x) / r2;
    xy += (radial - hoop) * x * y / r2;
    zz -= shear * z;
    xz += shear * x;
    yz += shear * y;
  }
  FieldValue value;
  value.displacement = displacement(point);
  value.stress << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  value.stress /= 2.0 * std::numbers::pi;
  return value;
}

}  // namespace palpate::contact
