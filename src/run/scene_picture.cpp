// Finds the faces of only one tetrahedron, and those between tetrahedra of different regions.
#include "run/scene_picture.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "scene/first_touch.h"

namespace palpate::run {
namespace {

using Face = record::ScenePicture::Face;

Face face(const geometry::TetMesh& mesh, const geometry::FaceUse& use) {
  Face result;
  for (std::size_t i = 0; i < 3; ++i) result.corners[i] = mesh.nodes[as_index(use.nodes[i])];
  result.region = mesh.region(use.tetrahedron);
  return result;
}

std::vector<Face> faces(const geometry::TetMesh& mesh) {
  std::vector<Face> found;
  const std::vector<geometry::FaceUse> uses = geometry::face_uses(mesh);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    Face one = face(mesh, uses[i]);
    if (i + 1 < uses.size() && uses[i + 1].key == uses[i].key) {
      // Between two regions, the face belongs to the later one and is seen from the earlier one.
      Face other = face(mesh, uses[++i]);
      if (one.region == other.region) continue;
      if (one.region < other.region) std::swap(one, other);
      one.within = other.region;
    }
    found.push_back(one);
  }
  return found;
}

}  // namespace

record::ScenePicture make_picture(const scene::Scene& scene) {
  record::ScenePicture picture;
  picture.faces = faces(scene.specimen->mesh);
  picture.materials = {scene.scenario.tissue.material};
  for (const auto& region : scene.scenario.regions) picture.materials.push_back(region.material);
  const scene::FirstTouch first = scene::first_touch(scene);
  for (const Vec3& centre : scene.finger.centres)
    picture.finger.push_back({first.finger + centre, scene.finger.sphere_radius});
  picture.travel = scene::deepest_travel(scene.scenario, scene.law());
  picture.touch = scene.specimen->surface->position(first.at);
  for (const scenario::Step& step : scene.scenario.steps)
    if (const auto* slide = std::get_if<scenario::Slide>(&step)) {
      const double angle = slide->direction * std::numbers::pi / 180.0;
      picture.slides.emplace_back(slide->by * Vec3(std::cos(angle), std::sin(angle), 0.0));
    }
  return picture;
}

}  // namespace palpate::run
