// Collects the faces of a scene's body, its base and its finger.
#include "run/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/text.h"
#include "base/units.h"
#include "geometry/body.h"
#include "geometry/half_edges.h"
#include "scene/first_touch.h"
#include "scene/places.h"
#include "scene/specimen_mesh.h"

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

geometry::Surface ball(const scenario::Inclusion& inclusion) {
  const Vec3 radius = Vec3::Constant(inclusion.radius);
  geometry::Surface surface = geometry::sampled(geometry::Ellipsoid{2.0 * radius},
                                                {0.4 * inclusion.radius, 0.4 * inclusion.radius})
                                  .parts.front()
                                  .surface;
  for (Vec3& vertex : surface.vertices)
    vertex += Vec3(inclusion.centre[0], inclusion.centre[1], inclusion.centre[2]) - radius;
  return surface;
}

// The body of a scene without a mesh: its shape, or a piece of a half-space, with its inclusions.
geometry::Body given_body(const scene::Scene& scene) {
  const scenario::Resolved& scenario = scene.scenario;
  geometry::Body body;
  if (const auto& given = scene.solid ? scene.solid->surface : scene.of_file) {
    body.parts.push_back({given->surface(), 0});
  } else if (const auto shape = scene::parametric(scenario.tissue.shape)) {
    const double spacing = 0.04 * geometry::extent(*shape).norm();
    body = geometry::sampled(*shape, {spacing, spacing});
    for (geometry::Part& part : body.parts)
      part.region = scene::substance_of(scenario, part.region);
  } else {
    const double size = 8.0 * scenario.finger.radius;
    body = geometry::sampled(geometry::Cuboid{{size, size, 0.4 * size}}, {0.1 * size, 0.1 * size});
    const Vec3 corner = scene::pressed_place(scene) - Vec3(0.5 * size, 0.5 * size, 0.4 * size);
    for (Vec3& vertex : body.parts.front().surface.vertices) vertex += corner;
  }
  for (std::size_t i = 0; i < scenario.regions.size(); ++i)
    if (const auto* inclusion = std::get_if<scenario::Inclusion>(&scenario.regions[i].part))
      body.parts.push_back({ball(*inclusion), static_cast<int>(i) + 1});
  return body;
}

// Cuts the faces of the surface along the plane where `up` times the place is `level`.
std::vector<Face> cut(const std::vector<Face>& all, const Vec3& up, double level, double rounding) {
  std::vector<Face> found;
  for (const Face& face : all) {
    std::array<double, 3> heights{};
    for (std::size_t i = 0; i < 3; ++i) heights[i] = face.corners[i].dot(up) - level;
    const auto [lowest, highest] = std::ranges::minmax_element(heights);
    if (face.within >= 0 || *lowest >= -rounding || *highest <= rounding) {
      found.push_back(face);
      continue;
    }
    std::array<std::vector<Vec3>, 2> sides;  // below and above
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      if (heights[i] <= rounding) sides[0].push_back(face.corners[i]);
      if (heights[i] >= -rounding) sides[1].push_back(face.corners[i]);
      if (std::min(heights[i], heights[next]) >= -rounding ||
          std::max(heights[i], heights[next]) <= rounding)
        continue;
      // From below, so that the face beyond the edge has the same point to the last bit.
      const std::size_t low = heights[i] < 0.0 ? i : next;
      const std::size_t high = i + next - low;
      const double share = heights[low] / (heights[low] - heights[high]);
      const Vec3 between = face.corners[low] + share * (face.corners[high] - face.corners[low]);
      for (auto& side : sides) side.push_back(between);
    }
    for (const auto& side : sides)
      for (std::size_t i = 1; i + 1 < side.size(); ++i) {
        found.push_back(face);
        found.back().corners = {side[0], side[i], side[i + 1]};
      }
  }
  return found;
}

std::vector<Face> faces(const geometry::Body& body, const scenario::Resolved& scenario) {
  std::vector<Face> found;
  for (const geometry::Part& part : body.parts)
    for (const auto& triangle : part.surface.triangles) {
      Face one;
      for (std::size_t i = 0; i < 3; ++i)
        one.corners[i] = part.surface.vertices[as_index(triangle[i])];
      one.region = part.region;
      if (&part != &body.parts.front()) one.within = 0;
      found.push_back(one);
    }
  for (std::size_t i = 0; i < scenario.regions.size(); ++i) {
    const auto* slab = std::get_if<scenario::Slab>(&scenario.regions[i].part);
    if (slab == nullptr) continue;
    const double rounding = 1e-6 * (slab->top - slab->bottom);
    for (const double level : {slab->bottom, slab->top})
      found = cut(found, Vec3::UnitZ(), level, rounding);
    for (Face& face : found) {
      const auto& [a, b, c] = face.corners;
      // On a boundary of the layer the tissue behind the face decides.
      const double height =
          (a + b + c).z() / 3.0 - 2.0 * rounding * (b - a).cross(c - a).normalized().z();
      if (face.within < 0 && height > slab->bottom && height < slab->top)
        face.region = static_cast<int>(i) + 1;
    }
  }
  return found;
}

// Joins corners that lie in one cell of a grid, the coarser the more faces there are. Those of held
// faces, of free ones, and on the border between both are joined among themselves, so that the
// outline of the base stays where it is.
std::vector<Face> thinned(std::vector<Face> all) {
  constexpr std::size_t most = 6000;
  if (all.size() <= most) return all;
  constexpr int held = 1, free = 2;
  std::map<std::array<double, 3>, int> sides;
  const auto sides_at = [&](const Vec3& corner) -> int& {
    return sides[{corner.x(), corner.y(), corner.z()}];
  };
  for (const Face& face : all)
    for (const Vec3& corner : face.corners)
      if (face.within < 0) sides_at(corner) |= face.held ? held : free;
  Vec3 low = all.front().corners[0], high = low;
  for (const Face& face : all)
    for (const Vec3& corner : face.corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  std::vector<Face> fewer;
  for (double cell = (high - low).norm() / 90.0; fewer.empty() || fewer.size() > most;
       cell *= 1.25) {
    fewer.clear();
    std::map<std::array<int, 5>, Vec3> joined;
    for (Face face : all) {
      for (Vec3& corner : face.corners) {
        const Vec3 at = (corner - low) / cell;
        corner = joined
                     .try_emplace({static_cast<int>(at.x()), static_cast<int>(at.y()),
                                   static_cast<int>(at.z()), face.region, sides_at(corner)},
                                  corner)
                     .first->second;
      }
      const auto& [a, b, c] = face.corners;
      if (a != b && b != c && c != a) fewer.push_back(face);
    }
  }
  return fewer;
}

// Marks the surface up to the base's level.
void mark_held(const scenario::Resolved& scenario, const geometry::Surface& outer_surface,
               std::vector<Face>& all) {
  const scene::Box box = scene::box_of(outer_surface.vertices);
  const double size = (box.high - box.low).norm();
  const double level = scene::base_level(scenario, outer_surface) + 1e-9 * size;
  all = cut(all, scenario.tissue.base_up, level, 1e-6 * size);
  for (Face& face : all) {
    const Vec3 middle = (face.corners[0] + face.corners[1] + face.corners[2]) / 3.0;
    face.held = face.within < 0 && middle.dot(scenario.tissue.base_up) <= level;
  }
}

// The walls of cavities, seen from the tissue around them.
std::vector<Face> cavity_faces(const geometry::Surface& outer_surface, int region) {
  std::vector<Face> found;
  for (const auto& [part, triangles] : geometry::parts_of(outer_surface)) {
    if (geometry::enclosed(part).volume > 0.0) continue;
    for (const auto& [a, b, c] : part.triangles)
      found.push_back(
          {{part.vertices[as_index(a)], part.vertices[as_index(c)], part.vertices[as_index(b)]},
           region,
           0});
  }
  return found;
}

// What the upper plate does in the first step of a test between plates.
std::string load_text(const scenario::Step& step) {
  if (const auto* creep = std::get_if<scenario::Creep>(&step))
    return quantity_text(creep->stress, unit::kPa);
  const auto* relax = std::get_if<scenario::Relax>(&step);
  const double strain = relax ? relax->strain : std::get<scenario::Compress>(step).strain;
  return "a strain of " + percent_text(strain);
}

}  // namespace

record::ScenePicture picture_of(const scene::Scene& scene) {
  const scenario::Resolved& scenario = scene.scenario;
  record::ScenePicture picture;
  const geometry::TetMesh* mesh = scene.specimen                     ? &scene.specimen->mesh
                                  : scene.solid && scene.solid->mesh ? &*scene.solid->mesh
                                                                     : nullptr;
  const geometry::Body body = mesh ? geometry::Body{} : given_body(scene);
  picture.faces = mesh ? faces(*mesh) : faces(body, scenario);
  const geometry::Surface outer_surface =
      mesh ? geometry::outer_surface(*mesh).surface : body.parts.front().surface;
  if (!std::holds_alternative<scenario::HalfSpace>(scenario.tissue.shape)) {
    mark_held(scenario, outer_surface, picture.faces);
    picture.base = scenario.tissue.base == tissue::Base::bonded ? "fixed (bonded base)"
                                                                : "on a table (slides)";
  }
  picture.materials = {scenario.tissue.material};
  for (const auto& region : scenario.regions) picture.materials.push_back(region.material);
  const std::vector<Face> walls =
      cavity_faces(outer_surface, static_cast<int>(picture.materials.size()));
  if (!walls.empty()) picture.materials.emplace_back(record::ScenePicture::cavity);
  picture.faces.insert(picture.faces.end(), walls.begin(), walls.end());
  picture.faces = thinned(std::move(picture.faces));

  // From the scene, where the finger comes down, to the body as it stands.
  picture.axes = scene::standing(scenario);
  const Eigen::Matrix3d upright = picture.axes * scenario.tissue.turn.transpose();
  picture.towards = -upright.col(2);
  for (Face& face : picture.faces)
    for (Vec3& corner : face.corners) corner = upright * corner;
  if (scenario.uniform()) {
    picture.load = load_text(scenario.steps.front());
    return picture;
  }
  Vec3 finger = scene::pressed_place(scene);
  picture.touch = finger;
  if (scene.solid) {
    finger = scene.solid->first_touch;
    picture.touch = scene.solid->touched;
  } else if (scene.specimen) {
    const scene::FirstTouch first = scene::first_touch(scene);
    finger = first.finger;
    picture.touch = scene.specimen->surface->position(first.at);
  } else {
    finger.z() += scene.finger.sphere_radius;
  }
  picture.touch = upright * picture.touch;
  for (const Vec3& centre : scene.finger.centres)
    picture.finger.push_back({upright * (finger + centre), scene.finger.sphere_radius});
  picture.travel = scene::deepest_travel(scenario, scene.law());
  for (const scenario::Step& step : scenario.steps)
    if (const auto* slide = std::get_if<scenario::Slide>(&step))
      picture.slides.emplace_back(upright * slide->way());
  return picture;
}

}  // namespace palpate::run
