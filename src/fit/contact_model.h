// A sphere's force over its depth, fitted for the tissue's stiffness and where contact began.
#pragma once

#include <optional>
#include <span>

#include "base/units.h"
#include "contact/layer_integral.h"
#include "fit/regression.h"

namespace palpate::fit {

// What is known of the test. The sphere is rigid.
struct ContactTest {
  double radius = 0.0;         // of the sphere, m
  double poisson_ratio = 0.5;  // of the tissue, 0 to 1/2
  // Of a layer on a rigid base, m; nothing: a half-space.
  std::optional<double> thickness = {};
  contact::LayerBase base = contact::LayerBase::bonded;
};

// Fits F = 4/3 E / (1 - nu^2) sqrt(R) (h - h_0)^(3/2), 0 before contact, or the same times the
// exact factor of a finite layer (contact/layer.h), to `depth` (m) and `force` (N) of one size.
// Parameters: E in kPa and h_0 in mm; ranges in mm, rmse in N. Points that are not finite are left
// out and counted. Throws InputError: fewer than 4 points, a load that does not grow with depth, or
// a layer so thin that no contact point keeps the data within the law's reach.
// Hertz: Chen 2007 eq. (2); a layer: docs/theory.md (57)-(59)
[[nodiscard]] Fit fit_contact(std::span<const double> depth, std::span<const double> force,
                              const ContactTest& test);

}  // namespace palpate::fit
