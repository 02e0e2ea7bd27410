// The body of a scene for the model `solid`, which makes meshes of its own.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "geometry/shapes.h"
#include "geometry/smooth_surface.h"
#include "geometry/tet_mesh.h"
#include "scenario/resolved.h"

namespace palpate::scene {

struct Finger;
struct Scene;

// One of the first three gives the body; inclusions and layers of the scenario come on top.
struct SolidBody {
  std::optional<geometry::Shape> shape;
  std::shared_ptr<const geometry::SmoothSurface> surface;  // of a file
  std::optional<geometry::TetMesh> mesh;                   // with the numbers of substances
  std::shared_ptr<const geometry::SmoothSurface> skin;     // the surface of any of them
  double base_level = 0.0;          // m; the surface up to here along `tissue.base_up` is held
  Vec3 first_touch = Vec3::Zero();  // m, the finger's point there
  Vec3 touched = Vec3::Zero();      // m, the place of the surface there
};

// The substance of a part of a shape: 0 is the tissue, then the scenario's regions in order.
[[nodiscard]] int substance_of(const scenario::Resolved& scenario, int part);

// The finger's point and the place of the skin (m) at first touch, with the finger at a place (m)
// beside that of the body; nothing where it passes beside the body.
[[nodiscard]] std::optional<std::pair<Vec3, Vec3>> touch_beside(const SolidBody& body,
                                                                const Finger& finger,
                                                                const Vec3& place);

// With the triangles of a file's surface as they are, and their first touch. Throws MeshError if
// the finger passes beside the body.
[[nodiscard]] SolidBody flattened(const SolidBody& body, const Scene& scene);

// Throws MeshError if the finger passes beside the body, or as specimen_mesh() does.
[[nodiscard]] std::unique_ptr<SolidBody> make_solid_body(const Scene& scene,
                                                         const std::string& folder);

}  // namespace palpate::scene
