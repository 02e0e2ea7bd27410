// Fits a tip's force over its depth: the tissue's Young's modulus and the contact point.
#pragma once

#include <optional>
#include <span>

#include "base/units.h"
#include "contact/layer_integral.h"
#include "fit/loading_part.h"
#include "fit/regression.h"
#include "fit/tip.h"

namespace palpate::fit {

// A depth below the contact point: a length (m), or a share of the largest depth.
struct DepthLimit {
  double value = 0.0;
  bool share = false;
};

// The known quantities of a test with a rigid tip, and the part of the curve that is fitted.
struct ContactTest {
  double radius = 0.0;                   // of the sphere or the punch, m
  double poisson_ratio = 0.5;            // of the tissue, 0 to 1/2
  std::optional<double> thickness = {};  // m, of a layer on a rigid base; none: a half-space
  contact::LayerBase base = contact::LayerBase::bonded;
  Tip::Kind tip = Tip::Kind::paraboloid;  // of a half-space; a layer is pressed by a paraboloid
  double half_angle = 0.0;                // rad, of cones and pyramids

  enum class BaselineChoice { automatic, none, offset, tilt };
  BaselineChoice baseline = BaselineChoice::automatic;
  std::optional<double> baseline_from = {};  // m: of the rows before contact, only those from here
  std::optional<double> baseline_to = {};    // to here count
  std::optional<double> contact_point = {};  // m, known; none: fitted
  std::optional<DepthLimit> from = {};
  std::optional<DepthLimit> to = {};
  using Way = fit::Way;
  Way way = Way::approach;
  Residuals residuals = Residuals::independent;
  // m/N, of a cantilever whose bending was taken off the depth; 0: none. The tilt of its baseline
  // is light from elsewhere and bends nothing.
  double bending = 0.0;
};

// Fits F = E/(1 - nu^2) f(h - h_0) + F_0 + k (h - h_min) to `depth` (m) and `force` (N) of equal
// size, where f is the law of the tip (tip.h) or of a paraboloid on a finite layer
// (contact/layer.h), 0 before contact. Parameters: E in kPa, h_0 in mm and, if there is a
// baseline, F_0 in N and k in N/mm; ranges in mm, rmse in N. `automatic` fits an offset where three
// rows lie before contact, and a tilt where ten do. Of a curve that goes in and out, `way` is
// fitted. A known contact point is no parameter. Points that are not used are counted, and named in
// the notes.
// Throws InputError for fewer than 4 points, for fewer than 3 beyond the contact point, for a
// single depth, for a curve in which the load does not grow with depth or that shows no contact,
// and for data deeper than the law of a thin layer permits.
// docs/theory.md [layer], [tips], [tip_sphere], [contact_point]
[[nodiscard]] Fit fit_contact(std::span<const double> depth, std::span<const double> force,
                              const ContactTest& test);

}  // namespace palpate::fit
