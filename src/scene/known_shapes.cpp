// The shapes and programmes to which closed forms apply.
#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/hertz.h"
#include "scenario/programme.h"
#include "scene/scene.h"
#include "scene/specimen_mesh.h"

namespace palpate::scene {
namespace {

// Whether the finger's path leaves the top of a cuboid.
bool leaves(const scenario::Resolved& scenario, const scenario::Cuboid& box) {
  for (const auto& [x, y] : scenario::finger_places(scenario, box))
    if (std::min({x, box.size[0] - x, y, box.size[1] - y}) < 0.0) return true;
  return false;
}

std::optional<std::string> beyond_half_space(const scenario::Resolved& scenario) {
  const auto top = top_curvature(scenario.tissue.shape);
  if (!top) return "no formula gives the curvature of its shape";
  const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape);
  if (box != nullptr && leaves(scenario, *box)) return "the finger leaves the specimen's top";
  if (top->kappa_1 == 0.0 && top->kappa_2 == 0.0) return std::nullopt;
  if (scenario.finger.spheres > 1) return "several spheres press a curved surface";
  if (scenario.finger.x || scenario.finger.y) return "the finger may stand off the curved top";
  for (const scenario::Step& step : scenario.steps)
    if (std::holds_alternative<scenario::Slide>(step))
      return "the finger slides over a curved surface";
  return std::nullopt;
}

constexpr const char* has_regions = "it has regions of other tissues";

}  // namespace

std::optional<TopCurvature> top_curvature(const scenario::Shape& shape) {
  if (std::holds_alternative<scenario::Cuboid>(shape)) return TopCurvature{};
  if (const auto* half = std::get_if<scenario::HalfSpace>(&shape)) {
    const double across = half->curvature_2.value_or(half->curvature);
    if (half->curvature >= across) return TopCurvature{half->curvature, across};
    return TopCurvature{across, half->curvature, Vec3::UnitY()};
  }
  if (const auto* cylinder = std::get_if<scenario::Cylinder>(&shape))
    return TopCurvature{1.0 / cylinder->radius, 0.0};
  if (const auto* ellipsoid = std::get_if<scenario::Ellipsoid>(&shape)) {
    // The top of z = c sqrt(1 - x^2/a^2 - y^2/b^2) has the curvatures c/a^2 and c/b^2.
    const Vec3 half = 0.5 * ellipsoid->size;
    const double x = half.z() / (half.x() * half.x());
    const double y = half.z() / (half.y() * half.y());
    return x >= y ? TopCurvature{x, y} : TopCurvature{y, x, Vec3::UnitY()};
  }
  return std::nullopt;
}

std::optional<std::string> beyond(scenario::Model model, const scenario::Resolved& scenario) {
  switch (model) {
    case scenario::Model::hertz:
      if (!scenario.regions.empty()) return has_regions;
      return beyond_half_space(scenario);
    case scenario::Model::layer:
      if (!std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape))
        return "a layer is a `cuboid` pressed on its flat top";
      if (scenario.finger.spheres > 1) return "several spheres press into one layer";
      if (!all_slabs(scenario)) return has_regions;
      return beyond_half_space(scenario);
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
