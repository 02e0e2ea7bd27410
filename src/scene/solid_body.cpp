// Finds the first touch of the finger on the body as it is given.
#include "scene/scene.h"

#include "base/error.h"
#include "geometry/curved_edges.h"
#include "geometry/surface.h"
#include "meshing/surface_repair.h"
#include "scene/first_touch.h"
#include "scene/places.h"
#include "scene/specimen_mesh.h"

namespace palpate::scene {

int substance_of(const scenario::Resolved& scenario, int part) {
  for (std::size_t i = 0; i < scenario.regions.size(); ++i)
    if (const auto* tagged = std::get_if<scenario::TaggedRegion>(&scenario.regions[i].part))
      if (tagged->tag == part) return static_cast<int>(i) + 1;
  return 0;
}

namespace {

void find_touch(SolidBody& body, const Scene& scene) {
  const scenario::PlainFinger& finger = scene.scenario.finger;
  const auto [low, high] = box_of(body.outer_surface->surface().vertices);
  const Vec3 middle = 0.5 * (low + high);
  const Vec3 place(finger.x.value_or(middle.x()), finger.y.value_or(middle.y()), high.z());
  const FirstTouch first =
      lowered_onto(*body.outer_surface, place, {scene.finger.centres, scene.finger.sphere_radius});
  body.first_touch = first.finger;
  body.touched = body.outer_surface->position(first.at);
}

// Whether a body of one tissue can be meshed anew from the boundary of its mesh.
bool bounds_a_body(const geometry::Surface& boundary, const std::string& name) {
  try {
    meshing::check_closed(boundary, name);
  } catch (const MeshError&) {
    return false;
  }
  return true;
}

}  // namespace

std::unique_ptr<SolidBody> make_solid_body(const Scene& scene, const std::string& folder) {
  constexpr double spacing_over_size = 0.02;  // of shapes, for the first touch alone
  const scenario::Resolved& scenario = scene.scenario;
  auto body = std::make_unique<SolidBody>();
  if (const auto* file = std::get_if<scenario::MeshFile>(&scenario.tissue.mesh)) {
    SpecimenMesh made = specimen_mesh(scenario, folder, nullptr);
    geometry::Surface boundary = geometry::curved_boundary(made.mesh, made.middles);
    const bool alone = made.mesh.regions.empty() && bounds_a_body(boundary, file->file);
    body->outer_surface = std::make_shared<const geometry::SmoothSurface>(std::move(boundary));
    if (alone) {
      body->surface = body->outer_surface;
    } else {
      body->mesh = std::move(made.mesh);
      body->middles = std::move(made.middles);
    }
  } else if (std::holds_alternative<scenario::SurfaceFile>(scenario.tissue.shape)) {
    body->surface = body->outer_surface = scene.of_file;
  } else {
    body->shape = parametric(scenario.tissue.shape);
    const double spacing = spacing_over_size * geometry::extent(*body->shape).norm();
    body->outer_surface = std::make_shared<const geometry::SmoothSurface>(
        geometry::sampled(*body->shape, {spacing, spacing}).parts.front().surface);
  }

  const geometry::Surface& outer_surface = body->outer_surface->surface();
  body->base_level = base_level(scenario, outer_surface);

  refuse_covered_inclusions(scenario);
  const SurfaceTouch& touch = scene.choice.touch;
  if (body->shape && touch.known() && scene.finger.centres.size() == 1) {
    body->first_touch = touch.lowest + scene.finger.sphere_radius * Vec3::UnitZ();
    body->touched = touch.position;
  } else {
    find_touch(*body, scene);
  }
  refuse_held(scenario, body->base_level, body->touched);
  return body;
}

SolidBody flattened(const SolidBody& body, const Scene& scene) {
  constexpr double no_cosine = 2.0;  // every edge is a crease
  SolidBody flat = body;
  flat.surface = flat.outer_surface =
      std::make_shared<const geometry::SmoothSurface>(body.surface->surface(), no_cosine);
  find_touch(flat, scene);
  return flat;
}

std::optional<std::pair<Vec3, Vec3>> touch_beside(const SolidBody& body, const Finger& finger,
                                                  const Vec3& place) {
  const double top = box_of(body.outer_surface->surface().vertices).high.z();
  const auto lowered = [&](const Vec3& beside) {
    const Vec3 from = body.first_touch + beside;
    return lowered_onto(*body.outer_surface, {from.x(), from.y(), top},
                        {finger.centres, finger.sphere_radius});
  };
  try {
    const FirstTouch there = lowered(place);
    // What a sampled surface misses of the body's own touch it misses beside it as well.
    const Vec3 missed = (body.first_touch - lowered(Vec3::Zero()).finger).z() * Vec3::UnitZ();
    return std::pair(there.finger + missed, body.outer_surface->position(there.at) + missed);
  } catch (const MeshError&) {
    return std::nullopt;
  }
}

}  // namespace palpate::scene
