// The contact law of one sphere at one place: force and contact patch as functions of the depth.
#pragma once

#include <array>
#include <optional>

#include "base/vec3.h"
#include "contact/balance.h"
#include "geometry/curvature.h"

namespace palpate::contact {

// A sphere with the effective modulus of the contact.
struct SphereLaw {
  double radius = 0.0;   // m
  double modulus = 0.0;  // Pa, E*
};

// How the tissue's two principal curvatures enter: exactly, by the geometric mean of the relative
// curvatures, or by their mean (Chen 2007). docs/theory.md [ellipse_force], [circles]
enum class CurvatureLaw { elliptic, geometric, mean };

// The force `point` over an ellipse whose semi-axes grow with sqrt(h), or over a layer's circle.
struct ContactLaw {
  PointLaw point;
  double a = 0.0, b = 0.0;      // sqrt(m): semi-axes divided by sqrt(h), a >= b; without a layer
  Vec3 axis = Vec3::UnitX();    // along a: the direction of least curvature
  double mean_curvature = 0.0;  // 1/m, of the tissue
  bool nearly_conforming = false;
  double radius_share = 1.0;  // factor on a layer's contact radius where several spheres share it

  // m, the longer semi-axis first; zero at a depth of 0 or less.
  [[nodiscard]] std::array<double, 2> semi_axes(double depth) const;
};

// The law of a sphere on tissue with these curvatures (1/m, convex positive). Empty if the tissue
// conforms to the sphere, 1/R_1 + kappa <= 0 for either curvature. `layer` is the law of the sphere
// on a flat layer, which then replaces Hertz's force, or null.
[[nodiscard]] std::optional<ContactLaw> contact_law(CurvatureLaw kind, const SphereLaw& sphere,
                                                    const geometry::Curvature& curvature,
                                                    const LayerContact* layer = nullptr);

}  // namespace palpate::contact
