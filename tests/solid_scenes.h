// Presses of scenario files by the solid: what a scenario says as an order for it.
#pragma once

#include <memory>

#include "scene/first_touch.h"
#include "scene/scene.h"
#include "scene/specimen_mesh.h"
#include "scene/specimen_shape.h"
#include "solid/finger_press.h"

namespace palpate::test {

struct SolidScene {
  solid::FingerOrder order;
  // What the order points to.
  scene::SpecimenShapes shapes;
  std::unique_ptr<geometry::SmoothSurface> skin;
  std::optional<geometry::TetMesh> mesh;
};

// Of the first case of a scenario file.
inline std::unique_ptr<SolidScene> solid_scene(const std::string& path) {
  auto made = std::make_unique<SolidScene>();
  const scenario::Family family = scenario::read(path, {});
  const scene::Choice choice = scene::choose(family.cases.front(), made->shapes);
  const scenario::Resolved& scenario = choice.chosen;
  const scene::Finger finger = scene::make_finger(scenario);
  solid::FingerOrder& order = made->order;
  solid::BodyOrder& body = order.body;
  body.mirrored = {true, true};
  body.tissues = scene::tissues_of(scenario);
  body.base = scenario.tissue.base;
  geometry::Surface skin;
  if (std::holds_alternative<scenario::MeshFile>(scenario.tissue.mesh)) {
    made->mesh = scene::specimen_mesh(scenario, family.folder).mesh;
    body.mesh = &*made->mesh;
    skin = geometry::skin(*made->mesh).surface;
  } else if (const auto* file = std::get_if<scenario::SurfaceFile>(&scenario.tissue.shape)) {
    body.surface = made->shapes.surface(*file, family.folder).surface.get();
    skin = body.surface->surface();
  } else {
    body.shape = scene::parametric(scenario.tissue.shape);
    const double spacing = 0.02 * geometry::extent(*body.shape).norm();
    skin = geometry::sampled(*body.shape, {spacing, spacing}).parts.front().surface;
  }
  Vec3 low = skin.vertices.front();
  Vec3 high = low;
  for (const Vec3& vertex : skin.vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  int lowest = 0;  // vertices of a flat underside
  for (const Vec3& vertex : skin.vertices) lowest += vertex.z() < low.z() + 1e-9 ? 1 : 0;
  body.base_level =
      low.z() + scenario.tissue.base_height.value_or(lowest > 2 ? 0.0 : 0.1 * (high.z() - low.z()));
  made->skin = std::make_unique<geometry::SmoothSurface>(std::move(skin));
  order.skin = made->skin.get();
  for (std::size_t i = 0; i < scenario.regions.size(); ++i) {
    solid::Inclusion one{.region = static_cast<int>(i) + 1};
    if (const auto* lump = std::get_if<scenario::Lump>(&scenario.regions[i].part))
      one.lump = geometry::Lump{Vec3(lump->centre[0], lump->centre[1], lump->centre[2]),
                                lump->radius, one.region};
    else if (const auto* slab = std::get_if<scenario::Slab>(&scenario.regions[i].part))
      std::tie(one.bottom, one.top) = std::pair(slab->bottom, slab->top);
    else
      continue;
    body.inclusions.push_back(one);
  }
  order.centres = finger.centres;
  order.radius = finger.sphere_radius;
  order.deepest = scene::deepest_travel(scenario, finger.whole);
  if (scenario.finger.elastic) {
    const auto& [modulus, ratio] = *scenario.finger.elastic;
    order.ball = tissue::Isotropic{modulus, std::min(ratio, scene::most_poisson_ratio)};
    order.share = 1.0 - finger.compliance_share;
  }
  const Vec3 middle = 0.5 * (low + high);
  const Vec3 place(scenario.finger.x.value_or(middle.x()), scenario.finger.y.value_or(middle.y()),
                   high.z());
  if (body.shape && choice.touch.known() && finger.centres.size() == 1) {
    order.first_touch = choice.touch.lowest + finger.sphere_radius * Vec3::UnitZ();
    order.touched = choice.touch.position;
  } else {
    const auto first =
        scene::lowered_onto(*order.skin, place, {finger.centres, finger.sphere_radius});
    order.first_touch = first.finger;
    order.touched = order.skin->position(first.at);
  }
  return made;
}

}  // namespace palpate::test
