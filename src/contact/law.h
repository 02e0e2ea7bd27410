// The contact law of one sphere at one place: what its force and patch are at any depth.
#pragma once

#include <array>
#include <optional>

#include "base/vec3.h"
#include "contact/balance.h"
#include "geometry/curvature.h"

namespace palpate::contact {

// A sphere against a flat, for estimates.
struct SphereLaw {
  double radius = 0.0;   // m
  double modulus = 0.0;  // Pa, E*
};

// How the tissue's two curvatures enter: exactly, by their geometric mean, or by their mean (the
// paper's).                                                   docs/theory.md (23)-(26)
enum class CurvatureLaw { elliptic, geometric, mean };

// F = c h^(3/2) over an ellipse whose semi-axes grow with sqrt(h), or a layer's circle.
struct ContactLaw {
  PointLaw point;
  double a = 0.0, b = 0.0;      // sqrt(m): semi-axes over sqrt(h), a >= b, without a layer
  Vec3 axis = Vec3::UnitX();    // along a: the direction of least curvature
  double mean_curvature = 0.0;  // 1/m, of the tissue
  bool nearly_conforming = false;
  double radius_share = 1.0;  // of the layer's contact radius, where several spheres press as one

  // m, the greater semi-axis first; none at a depth of 0 or less.
  [[nodiscard]] std::array<double, 2> semi_axes(double depth) const;
};

// Of a sphere of radius R_1 (m) and E* (Pa) on a tissue so curved (1/m, convex positive). Nothing
// where the tissue conforms to the sphere, 1/R_1 + kappa <= 0 for either curvature: Hertz ends.
// `layer`: of the sphere on the flat of a layer, which takes the place of Hertz's law there; or
// null.
[[nodiscard]] std::optional<ContactLaw> contact_law(CurvatureLaw kind, const SphereLaw& sphere,
                                                    const geometry::Curvature& curvature,
                                                    const LayerContact* layer = nullptr);

}  // namespace palpate::contact
