// Fits a sphere's force over its depth: the tissue's Young's modulus and the contact point.
#pragma once

#include <optional>
#include <span>

#include "base/units.h"
#include "contact/layer_integral.h"
#include "fit/regression.h"

namespace palpate::fit {

// The known quantities of a test with a rigid sphere.
struct ContactTest {
  double radius = 0.0;                   // of the sphere, m
  double poisson_ratio = 0.5;            // of the tissue, 0 to 1/2
  std::optional<double> thickness = {};  // m, of a layer on a rigid base; none: a half-space
  contact::LayerBase base = contact::LayerBase::bonded;
};

// Fits F = 4/3 E / (1 - nu^2) sqrt(R) (h - h_0)^(3/2) (0 before contact), or the same times the
// exact factor of a finite layer (contact/layer.h), to `depth` (m) and `force` (N) of equal size.
// Parameters: E in kPa and h_0 in mm; ranges in mm, rmse in N. Points that are not finite are left
// out and counted. Throws InputError for fewer than 4 points, for a single depth, for a load that
// does not increase with depth, and for data deeper than the law of a thin layer permits.
// Hertz: Chen 2007 eq. (2); a layer: docs/theory.md (57)-(59)
[[nodiscard]] Fit fit_contact(std::span<const double> depth, std::span<const double> force,
                              const ContactTest& test);

}  // namespace palpate::fit
