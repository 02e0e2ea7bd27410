// Adds what a rung leaves out to what its mesh costs.
#include "scene/model_errors.h"

#include <algorithm>
#include <cmath>

#include "scenario/integrators.h"
#include "scene/refining_press.h"
#include "scene/scene.h"
#include "scene/time_plan.h"

namespace palpate::scene {

using scenario::Found;
using scenario::Rung;

namespace {

// What two or three meshes of `solid` leave open where a tolerance below that of one is asked for.
constexpr double least_of_solid = 0.005;

// The error of cells that are coarse compared with the thickness, 0.15 (cell / thickness)^2:
// measured on discs of 5 and 10 mm and on thin blocks. Flat layers have an exact law.
double coarseness(const scenario::Resolved& scenario, const SurfaceTouch& touch) {
  const bool box = std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape);
  const Vec3& size = touch.size;
  if (!size.allFinite() || (box && !scenario.regions.empty() && all_slabs(scenario))) return 0.0;
  const double cell = std::cbrt(size.prod() / expected_nodes(scenario.tissue.mesh));
  double thickness = size.z();
  if (const auto* limb = std::get_if<scenario::LayeredLimb>(&scenario.tissue.shape))
    thickness = limb->skin_thickness;
  const double ratio = std::min(1.0, cell / thickness);
  return 0.15 * ratio * ratio;
}

// What an edge at the distance d costs a formula, beyond what bodies as wide as 6 a have: its force
// was 23, 14 and 5 % high at d / a = 1.3, 1.7 and 2.6 on a block from a file.
double beside_edge(const SurfaceTouch& touch, const Estimates& estimates) {
  const double near = std::min(1.0, estimates.contact_radius / touch.to_edge);
  return 0.3 * std::max(0.0, near - 1.0 / 3.0);
}

}  // namespace

double ModelErrors::of(const Rung& rung, const Found& found) const {
  if (rung.solid) return of_mesh(rung) + of_waves(rung, found);
  return (rung.meshed() ? of_mesh(rung) : of_size(rung, found) + beside_edge(touch_, e_)) +
         of_waves(rung, found) + of_overhang() + of_depth(found);
}

double ModelErrors::of_mesh(const Rung& rung) const {
  if (rung.solid)
    return std::min(rung.error.flat, std::max(asked_.solver.tolerance, least_of_solid));
  if (!rung.meshed()) return 0.0;
  const bool box = std::holds_alternative<scenario::Cuboid>(asked_.tissue.shape);
  const double error = coarseness(asked_, touch_) + rung.error.flat + rung.error.sides * e_.sides +
                       (box ? 0.0 : rung.error.curved + rung.error.size * e_.curved_body) +
                       (all_slabs(asked_) || !several_tissues(asked_) ? 0.0 : rung.error.mixed);
  return refines(asked_) ? std::min(error, refined_share * asked_.solver.tolerance) : error;
}

double ModelErrors::counted(double inertia) const {
  return inertia < 0.2 * asked_.solver.tolerance ? 0.0 : inertia;
}

bool ModelErrors::has_depth_ratio() const {
  return e_.depth_ratio && !contact::mesh_is_tissue(asked_.contact.coupling);
}

bool ModelErrors::moves() const { return inertia_reaches_force(asked_); }

// What a formula does not know of the body's size.
double ModelErrors::of_size(const Rung& rung, const Found& found) const {
  using Size = scenario::Contact::Size;
  if (given_.contact.size.value_or(found.size_matters ? Size::body : Size::half_space) ==
      Size::body)
    if (const auto ratio = size_ratio(rung.of, asked_, touch_, e_)) return ratio->error;
  if (rung.of == scenario::Model::hertz) return half_space_error(e_);
  return 1.0 / (1.0 - std::min(e_.sides, 0.99)) - 1.0 + doubt_of_sides * e_.sides;
}

// What the depth leaves open: the error of its factor, or the effect that is left out. At least
// 0.1 %, for a contact that is never quite as small as a contact law assumes.
double ModelErrors::of_depth(const Found& found) const {
  using Depth = scenario::Contact::Depth;
  constexpr double least = 1e-3;
  const auto depth =
      given_.contact.depth.value_or(found.depth_matters ? Depth::neo_hookean : Depth::hertz);
  const bool used = depth == Depth::neo_hookean && has_depth_ratio();
  return std::max(least, used ? e_.deep_error : std::abs(e_.deep) + e_.deep_error);
}

// Hertz's law has skin all round. On a block with d the distance of its edge over the contact
// radius, the force was 3, 33 and 54 % above that of resolved contact at d = 1, 0.5 and 0.26.
double ModelErrors::of_overhang() const {
  if (contact::mesh_is_tissue(asked_.contact.coupling)) return 0.0;
  const double left = 1.0 - e_.overhang;
  return 1.0 / (left * left) - 1.0;
}

// All of the effect where the model does not move.
double ModelErrors::of_waves(const Rung& rung, const Found& found) const {
  const auto& integrator = given_.solver.integrator;
  const bool moving = integrator ? about(*integrator).inertia : found.inertia_matters;
  return (rung.inertia && moving && moves() ? rung.error.waves : 1.0) * counted(e_.inertia);
}

bool coarse_mesh(const scenario::Resolved& scenario, const SurfaceTouch& touch) {
  return scenario.meshed() && !refines(scenario) && coarseness(scenario, touch) > 0.0;
}

}  // namespace palpate::scene
