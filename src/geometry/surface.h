// A body's skin as triangles, open or closed: its neighbourhoods, normals, area and volume.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec3.h"
#include "geometry/tet_mesh.h"

namespace palpate::geometry {

// Indices count from 0; triangles run counter-clockwise from outside.
struct Surface {
  std::vector<Vec3> vertices;                 // m
  std::vector<std::array<int, 3>> triangles;  // indices into `vertices`
};

// The boundary of a mesh. Its vertices keep the order of the mesh's nodes.
struct Skin {
  Surface surface;
  std::vector<int> nodes;  // of the mesh, one a vertex of the surface, ascending
};
[[nodiscard]] Skin skin(const TetMesh& mesh);

// (b - a) x (c - a), in m^2: along the outward normal, twice the triangle's area long.
[[nodiscard]] Vec3 twice_area(const Surface& surface, int triangle);

[[nodiscard]] double area(const Surface& surface);  // m^2

// What a closed surface encloses: negative where it is inside out.            docs/theory.md (18)
struct Enclosed {
  double volume = 0.0;           // m^3
  Vec3 centroid = Vec3::Zero();  // m, of a homogeneous inside
};
[[nodiscard]] Enclosed enclosed(const Surface& surface);

// Who is next to whom. Needs a surface whose edges have at most two triangles each.
class Neighbours {
 public:
  explicit Neighbours(const Surface& surface);

  // The triangles at a vertex, ascending.
  [[nodiscard]] std::span<const int> triangles_at(int vertex) const;

  // The triangles across edges (0, 1), (1, 2) and (2, 0) of a triangle; -1 beyond a boundary.
  [[nodiscard]] const std::array<int, 3>& across(int triangle) const {
    return across_[static_cast<std::size_t>(triangle)];
  }

  // The vertices joined to a vertex by an edge, ascending.
  [[nodiscard]] std::span<const int> vertices_at(int vertex) const;

  [[nodiscard]] bool on_boundary(int vertex) const {
    return on_boundary_[static_cast<std::size_t>(vertex)] != 0;
  }

  // The vertices within `rings` edges of any of `start`, these included, ascending.
  [[nodiscard]] std::vector<int> rings(std::span<const int> start, int rings) const;

 private:
  std::vector<int> triangle_starts_, triangles_;  // those at vertex v from starts[v]
  std::vector<int> vertex_starts_, vertices_;
  std::vector<std::array<int, 3>> across_;
  std::vector<char> on_boundary_;
};

// The unit outward normal at every vertex: the triangles' normals weighted by their angle there
// (Thuermer & Wuethrich 1998). Zero for a vertex without triangles.
[[nodiscard]] std::vector<Vec3> vertex_normals(const Surface& surface);

}  // namespace palpate::geometry
