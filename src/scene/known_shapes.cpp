// The shapes and loading histories to which closed forms apply.
#include <algorithm>

#include "base/text.h"
#include "contact/hertz.h"
#include "scenario/programme.h"
#include "scene/scene.h"

namespace palpate::scene {
namespace {

// Whether the finger's path leaves the top of a cuboid.
bool leaves(const scenario::Resolved& scenario, const scenario::Cuboid& box) {
  for (const auto& [x, y] : scenario::finger_places(scenario, box))
    if (std::min({x, box.size[0] - x, y, box.size[1] - y}) < 0.0) return true;
  return false;
}

std::optional<std::string> beyond_half_space(const scenario::Resolved& scenario,
                                             const SurfaceTouch& touch) {
  // Steeper, the second order of SurfaceTouch::pressed() is not enough.
  constexpr double steepest = 60.0;  // degrees
  if (!touch.known()) return touch.cannot;
  if (!scenario.tissue.held_from_below()) return "the body is not held from below the finger";
  const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape);
  if (box != nullptr && leaves(scenario, *box)) return "the finger leaves the top of the body";
  if (!touch.curved() && !touch.tilted()) return std::nullopt;
  if (scenario.finger.spheres > 1) return "several spheres meet a curved surface";
  for (const scenario::Step& step : scenario.steps)
    if (std::holds_alternative<scenario::Slide>(step))
      return "the finger slides over a curved surface";
  if (touch.inclination() > steepest)
    return "the surface is inclined by " + rounded_text(touch.inclination(), 2) +
           " degrees where the finger touches it, and the formula holds up to 60";
  return std::nullopt;
}

constexpr const char* has_regions = "the body has several tissues";

}  // namespace

std::optional<std::string> beyond(scenario::Model model, const scenario::Resolved& scenario,
                                  const SurfaceTouch& touch) {
  switch (model) {
    case scenario::Model::hertz:
      if (several_tissues(scenario)) return has_regions;
      return beyond_half_space(scenario, touch);
    case scenario::Model::layer:
      if (!std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape))
        return "a layer is a `cuboid` pressed on its flat top";
      if (scenario.finger.spheres > 1) return "several spheres share one layer";
      if (!all_slabs(scenario) && several_tissues(scenario)) return has_regions;
      return beyond_half_space(scenario, touch);
    case scenario::Model::solid:
      if (scenario.finger.spheres > 1 && scenario.finger.calibration == finger::Calibration::force)
        return "several spheres with `finger.calibration = \"force\"` stand for one";
      [[fallthrough]];
    case scenario::Model::mass_spring:
    case scenario::Model::coupled_springs:
      if (std::holds_alternative<scenario::HalfSpace>(scenario.tissue.shape))
        return "a `half_space` is infinite and cannot be meshed";
  }
  return std::nullopt;
}

double deepest_travel(const scenario::Resolved& scenario, const contact::SphereLaw& law) {
  double travel = 0.0;
  for (const scenario::Step& step : scenario.steps)
    if (const auto* indent = std::get_if<scenario::Indent>(&step))
      travel = std::max(travel, indent->to.second ? contact::hertz::depth(indent->to.value,
                                                                          law.radius, law.modulus)
                                                  : indent->to.value);
  return travel;
}

}  // namespace palpate::scene
