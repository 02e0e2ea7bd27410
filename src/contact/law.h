// The contact law of one sphere at one place: what its force and patch are at any depth.
#pragma once

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
// paper's).                                                   docs/theory.md (23)
enum class CurvatureLaw { elliptic, geometric, mean };

// F = c h^(3/2) over an ellipse whose semi-axes grow with sqrt(h).
struct ContactLaw {
  PointLaw point;
  double a = 0.0, b = 0.0;      // sqrt(m): semi-axes over sqrt(h), a >= b
  Vec3 axis = Vec3::UnitX();    // along a: the direction of least curvature
  double mean_curvature = 0.0;  // 1/m, of the tissue
  bool nearly_conforming = false;
};

// Of a sphere of radius R_1 (m) and E* (Pa) on a tissue so curved (1/m, convex positive). Nothing
// where the tissue conforms to the sphere, 1/R_1 + kappa <= 0 for either curvature: Hertz ends.
[[nodiscard]] std::optional<ContactLaw> contact_law(CurvatureLaw kind, const SphereLaw& sphere,
                                                    const geometry::Curvature& curvature);

}  // namespace palpate::contact
