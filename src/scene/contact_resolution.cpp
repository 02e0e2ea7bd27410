// Measures the surface's triangles under the finger along the loading history.
#include "scene/contact_resolution.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "contact/hertz.h"
#include "scene/first_touch.h"

namespace palpate::scene {
namespace {

constexpr double least_cells = 3.0;

// The places where the finger presses, at most `apart` (m) from each other along slides.
std::vector<Vec3> places(const Scene& scene, double apart) {
  std::vector<Vec3> all{pressed_place(scene)};
  for (const scenario::Step& step : scene.scenario.steps) {
    const auto* slide = std::get_if<scenario::Slide>(&step);
    if (slide == nullptr) continue;
    const Vec3 move = slide->way();
    const Vec3 start = all.back();
    const int pieces = std::max(1, static_cast<int>(std::ceil(slide->by / apart)));
    for (int i = 1; i <= pieces; ++i) all.emplace_back(start + move * i / pieces);
  }
  return all;
}

// The side of a cell within `radius` (m) of a place, seen from above, or else of the nearest cell.
double cell_at(const geometry::Surface& outer_surface, const Vec3& place, double radius) {
  double sum = 0.0;
  int count = 0;
  double nearest = std::numeric_limits<double>::infinity();
  double area_there = 0.0;
  for (std::size_t t = 0; t < outer_surface.triangles.size(); ++t) {
    const Vec3 twice = geometry::twice_area(outer_surface, static_cast<int>(t));
    if (twice.z() <= 0.0) continue;
    Vec3 centre = Vec3::Zero();
    for (const int v : outer_surface.triangles[t])
      centre += outer_surface.vertices[as_index(v)] / 3.0;
    const double distance = (centre - place).head<2>().norm();
    if (distance < nearest) {
      nearest = distance;
      area_there = 0.5 * twice.norm();
    }
    if (distance > radius) continue;
    sum += 0.5 * twice.norm();
    ++count;
  }
  return std::sqrt(2.0 * (count > 0 ? sum / count : area_there));
}

}  // namespace

double cells_per_contact_radius(const Scene& scene) {
  const double depth = deepest_travel(scene.scenario, scene.law());
  const double radius = contact::hertz::contact_radius(depth, scene.finger.sphere_radius);
  double widest = 0.0;
  for (const Vec3& place : places(scene, radius))
    widest = std::max(widest, cell_at(scene.specimen->surface->surface(), place, radius));
  return radius / widest;
}

void refuse_unresolved(const Scene& scene) {
  if (scene.scenario.uniform() || scene.scenario.contact.coupling != contact::Coupling::resolved)
    return;
  const double cells = cells_per_contact_radius(scene);
  if (cells >= least_cells) return;
  throw MeshError("`resolved` needs 3 cells along the contact radius, and the mesh has " +
                  rounded_text(cells, 2) + " at the largest displacement of " +
                  quantity_text(deepest_travel(scene.scenario, scene.law()), unit::mm) +
                  "; give `tissue.mesh` more cells or a `grading`, or set "
                  "`contact.coupling = \"consistent\"`");
}

}  // namespace palpate::scene
