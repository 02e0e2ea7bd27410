// Fast estimates of the change of a press's force by each simplification of the model.
#pragma once

#include <optional>

#include "contact/depth_ratio.h"
#include "scenario/resolved.h"
#include "scene/surface_touch.h"

namespace palpate::scene {

// All effects are relative to the force at the programme's deepest travel and fastest rate. See
// docs/theory.md (68) for their equations and docs/accuracy.md for measurements.
struct Estimates {
  double travel = 0.0;           // m, the deepest
  double rate = 0.0;             // m/s, the fastest
  double contact_radius = 0.0;   // m, that of Hertz's contact at this travel
  double tissue_share = 1.0;     // lambda_2 / (lambda_1 + lambda_2)
  double chi = 0.0;              // sqrt(R h) / H, H down to the base
  double thickness = 0.0;        // increase by the finite thickness
  double sides = 0.0;            // decrease by free sides near the contact
  double curved_body = 0.0;      // bound for the effect of the finite size of a curved body
  double narrow = 0.0;           // decrease by the sides, or by the width of a curved body
  double overhang = 0.0;         // share of Hertz's pressure beyond an edge of a curved body
  double by_size = 0.0;          // change by thickness, sides and width together, of either sign
  double by_size_error = 0.0;    // of 1 + `by_size`, relative
  double deep = 0.0;             // change in neo-Hookean tissue, of either sign; (62)
  double deep_error = 0.0;       // of 1 + `deep`, relative
  double viscous = 0.0;          // increase by the tissue's viscosity
  double inertia = 0.0;          // increase by the waves that the contact radiates
  double curvature_ratio = 1.0;  // (1/R + kappa_1) / (1/R + kappa_2)
  // Empty where it is not known: `deep` is then that of the nearest place where it is.
  std::optional<contact::DepthRatio> depth_ratio;
};

// The estimates for a scenario with a finger, from what is known of the surface. Thickness and
// width of a body from a file are those of its bounding box.
[[nodiscard]] Estimates estimate(const scenario::Resolved& scenario, const SurfaceTouch& touch);

// Whether the change by the size of the body is that of a fit, (68): on the top of ellipsoids and
// of lying cylinders of one tissue that are held by their lowest tenth.
[[nodiscard]] bool size_is_fitted(const scenario::Resolved& scenario, const SurfaceTouch& touch);

// The factor of a formula's force with `contact.size = "body"`, and its error. docs/theory.md (68a)
//   1 + change sqrt(h / deepest), because the effects of size grow with the radius of the contact
struct SizeRatio {
  static constexpr double most = 0.5;  // of |change|
  double change = 0.0;                 // of the force at the deepest indentation, relative
  double deepest = 0.0;                // m
  double error = 0.0;                  // of the factor, relative

  // At the indentation h (m); beyond `deepest` that of `deepest`.
  [[nodiscard]] double value(double depth) const;
};

// What the width and the base of a curved body change of the force of `hertz`, or the sides of a
// cuboid of that of `layer`. Empty for other models, where the finger moves sideways, without an
// estimate, and beyond `most`.
[[nodiscard]] std::optional<SizeRatio> size_ratio(scenario::Model model,
                                                  const scenario::Resolved& scenario,
                                                  const SurfaceTouch& touch,
                                                  const Estimates& estimates);

inline constexpr double doubt_of_sides = 0.4;  // relative, of `sides`, which is a fit

// The error of a half-space's force by the body's size, as a fraction of the body's force. Effects
// that cancel in `by_size` are still uncertain.
[[nodiscard]] double half_space_error(const Estimates& estimates);

// By how much of the final strain a specimen rings about its law of time in steps with inertia: by
// what it strains at once under a load that jumps. Relaxation starts in its static shape and does
// not ring, nor does nodal drag, whose motion is the law.                docs/theory.md (68)
[[nodiscard]] double uniform_ringing(const scenario::Resolved& scenario);

// Meshes that follow their error are refined until this share of `solver.tolerance` is stated.
inline constexpr double refined_share = 0.5;

// How much stiffer bonded ends make a prism between platens, for a Poisson's ratio below 1/2: 1 + 2
// S^2 of an incompressible one (Gent and Lindley 1959), S its loaded over its free surface, in
// series with the modulus of uniaxial strain. One bonded end is the middle of a body of twice the
// height. Within 15 % of solutions by refined meshes.                 docs/theory.md, below (52a)
[[nodiscard]] double bonded_stiffening(const scenario::Resolved& scenario, double poisson_ratio);

// The error of its modulus by a mesh with the tissue's elasticity, relative.
[[nodiscard]] double bonded_mesh_error(const scenario::Resolved& scenario);

// The number of nodes that the mesh will have, before it is refined; 1000 for a ready mesh, which
// is not read here.
[[nodiscard]] double expected_nodes(const scenario::Mesh& mesh);

}  // namespace palpate::scene
