// Fast estimates of the change of a press's force by each simplification of the model.
#pragma once

#include <optional>

#include "contact/depth_ratio.h"
#include "scenario/resolved.h"
#include "scene/surface_touch.h"

namespace palpate::scene {

// All effects are relative to the force at the loading history's deepest travel and fastest rate.
// See docs/theory.md [estimates] for their equations and docs/accuracy.md for measurements.
struct Estimates {
  double travel = 0.0;          // m, the deepest
  double rate = 0.0;            // m/s, the fastest
  double contact_radius = 0.0;  // m, that of Hertz's contact at this travel
  double tissue_share = 1.0;    // lambda_2 / (lambda_1 + lambda_2)
  double chi = 0.0;             // sqrt(R h) / H, H down to the base
  double thickness = 0.0;       // change by the thickness of flat layers, exact for wide ones
  // Measured by run::choose() on a coarse mesh of the body.
  double sides = 0.0;            // change of a flat layer's force by its sides
  double size = 0.0;             // change of a half-space's force by the whole body
  double size_error = 0.0;       // the mesh's own, a fraction of the body's force
  bool measured = false;         // whether there was a mesh, and a solution on it
  double edge = 0.0;             // bound where an edge is nearer than two contact radii; [edge]
  double ball = 0.0;             // what a ball in place of a half-space adds to the force; [ball]
  double deep = 0.0;             // change in neo-Hookean tissue by `depth_ratio`; [deep]
  double deep_error = 0.0;       // of that, or a bound where there is none
  double viscous = 0.0;          // increase by the tissue's viscosity
  double fresh = 0.0;            // increase by that of the tissue that a slide reaches
  double deep_bound = 0.0;       // of what large strains change
  double inertia = 0.0;          // change by waves that the contact radiates, and by `swing`
  double swing = 0.0;            // the part of a body that swings as a whole
  double yields = 0.0;           // what the body yields under a force, over Hertz's depth
  double curvature_ratio = 1.0;  // (1/R + kappa_1) / (1/R + kappa_2)
  std::optional<contact::DepthRatio> depth_ratio;  // of wide flat tissue of one kind
};

// The estimates for a scenario with a finger, from what is known of the surface and of how far the
// body yields.
[[nodiscard]] Estimates estimate(const scenario::Resolved& scenario, const SurfaceTouch& touch,
                                 double yields = 0.0);

// By how much of the final strain a specimen rings about its law of time in steps with inertia: by
// what it strains at once under a load that jumps. Relaxation starts in its static shape and does
// not ring, nor does nodal drag, whose motion is the law.         docs/theory.md [estimates]
[[nodiscard]] double uniform_ringing(const scenario::Resolved& scenario);

// Meshes that follow their error are refined until this share of `solver.tolerance` is stated.
inline constexpr double refined_share = 0.5;

// contact::bonded_stiffening() of a prism between its platens; one bonded end is the middle of a
// body of twice the height.
[[nodiscard]] double bonded_stiffening(const scenario::Resolved& scenario, double poisson_ratio);

// The longest edge (m) of a mesh that still carries the waves of a fast press: half of the way of a
// shear wave while the finger comes down at its fastest rate, or the contact's radius if that is
// longer, since the load is spread over three of them. Rounded down to a power of sqrt(2), so
// that like presses share a mesh, and infinite where the tissue's inertia does not reach the force.
//                                                                     docs/theory.md [wave_mesh]
[[nodiscard]] double longest_for_waves(const scenario::Resolved& scenario);

// Whether the mesh in motion represents the waves, as far as can be known before it is made: the
// contact's wide patch lies within the body, and the mesh is refined for them or fine enough.
[[nodiscard]] bool carries_waves(const scenario::Resolved& scenario, const SurfaceTouch& touch,
                                 double contact_radius);

// The number of nodes that the mesh will have, before it is refined; 1000 for a ready mesh, which
// is not read here.
[[nodiscard]] double expected_nodes(const scenario::Mesh& mesh);

}  // namespace palpate::scene
