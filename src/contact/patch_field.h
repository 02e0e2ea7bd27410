// The displacement and stress of a half-space under a contact patch with Hertz's pressure or the
// friction of its slip.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "base/vec3.h"

namespace palpate::contact {

// Isotropic moduli of the half-space, Pa.
struct HalfSpace {
  double shear_modulus = 0.0;
  double poisson_ratio = 0.0;
};

// At one point, per newton on the patch.
struct FieldValue {
  Vec3 displacement = Vec3::Zero();                  // m/N
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();  // Pa/N
};

// The field of an elliptic patch on the plane z = 0 of a half-space z <= 0, whose traction has the
// shape of Hertz's pressure. It is replaced by point loads, the more of them the nearer the point
// is: Boussinesq's along -z, Cerruti's in the plane. Points above the plane count as points on it.
//      K. L. Johnson 1985, eq. (3.18)-(3.19), (3.75)-(3.76); docs/theory.md [split]
class PatchField {
 public:
  // Semi-axes along x and y, m, above 0. The unit vector `along` is the traction's direction: -z,
  // or any in the plane. `finer` multiplies the numbers of point loads.
  PatchField(double a, double b, const HalfSpace& half_space, int finer = 1,
             const Vec3& along = -Vec3::UnitZ());

  [[nodiscard]] FieldValue at(const Vec3& point) const;  // m, from the patch's centre
  [[nodiscard]] Vec3 displacement(const Vec3& point) const;

 private:
  struct PointLoad {
    double x = 0.0, y = 0.0;  // m
    double share = 0.0;
  };
  [[nodiscard]] const std::vector<PointLoad>& loads_for(const Vec3& point) const;
  [[nodiscard]] Vec3 dragged(const Vec3& point) const;  // m/N, the displacement
  [[nodiscard]] Eigen::Matrix3d drag_stress(const Vec3& point) const;

  HalfSpace half_space_;
  Vec3 along_;
  double reach_ = 0.0;                           // m, the longer semi-axis
  std::array<std::vector<PointLoad>, 3> loads_;  // for far, near and nearest points
};

}  // namespace palpate::contact
