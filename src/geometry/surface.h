// A triangulated surface, open or closed: neighbourhoods, normals, area and volume.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec3.h"
#include "geometry/tet_mesh.h"

namespace palpate::geometry {

// Indices count from 0; triangles are counter-clockwise seen from outside.
struct Surface {
  std::vector<Vec3> vertices;                 // m
  std::vector<std::array<int, 3>> triangles;  // indices into `vertices`
};

// The boundary of a mesh. Its vertices have the order of the mesh's nodes.
struct OuterSurface {
  Surface surface;
  std::vector<int> nodes;  // node of the mesh for each vertex of the surface, ascending
};
[[nodiscard]] OuterSurface outer_surface(const TetMesh& mesh);

// (b - a) x (c - a), m^2: the outward normal, with twice the triangle's area as length.
[[nodiscard]] Vec3 twice_area(const Surface& surface, int triangle);

// These triangles as a surface of their own, with the vertices in the order of their first use.
[[nodiscard]] Surface piece_of(const Surface& surface, std::span<const int> triangles);

[[nodiscard]] double area(const Surface& surface);  // m^2

// The closed surface with more vertices, `count` in all: time and again the longest edge gets one
// in its middle.
[[nodiscard]] Surface with_halved_edges(Surface surface, std::size_t count);

// The interior of a closed surface; volume < 0 if the triangles face inwards.
//                                                                           docs/theory.md [volume]
struct Enclosed {
  double volume = 0.0;           // m^3
  Vec3 centroid = Vec3::Zero();  // m, for uniform density
};
[[nodiscard]] Enclosed enclosed(const Surface& surface);

// The angle (rad) of a triangle at its corner 0, 1 or 2.
[[nodiscard]] double corner_angle(const Surface& surface, int triangle, std::size_t corner);

// Which corner (0, 1 or 2) of a triangle is `vertex`; 3 if none is.
[[nodiscard]] std::size_t corner_of(const std::array<int, 3>& triangle, int vertex);

// A list among lists of different lengths in one array: list i is from starts[i] to starts[i + 1].
[[nodiscard]] std::span<const int> list_of(const std::vector<int>& starts,
                                           const std::vector<int>& items, int index);

// Neighbourhoods of vertices and triangles, from OpenMesh's half-edges.
class Neighbours {
 public:
  // Throws MeshError for the first triangle that is not part of an orientable manifold with those
  // before it; see half_edges.h.
  explicit Neighbours(const Surface& surface);

  // The triangles at a vertex, ascending.
  [[nodiscard]] std::span<const int> triangles_at(int vertex) const;

  // The triangles across edges (0, 1), (1, 2) and (2, 0) of a triangle; -1 beyond a boundary.
  [[nodiscard]] const std::array<int, 3>& across(int triangle) const {
    return across_[as_index(triangle)];
  }

  // The vertices connected to a vertex by an edge, ascending.
  [[nodiscard]] std::span<const int> vertices_at(int vertex) const;

  [[nodiscard]] bool on_boundary(int vertex) const { return on_boundary_[as_index(vertex)] != 0; }

  // The vertices within `rings` edges of any vertex of `start`, including these, ascending.
  [[nodiscard]] std::vector<int> rings(std::span<const int> start, int rings) const;

 private:
  std::vector<int> triangle_starts_, triangles_;  // for vertex v from starts[v]
  std::vector<int> vertex_starts_, vertices_;
  std::vector<std::array<int, 3>> across_;
  std::vector<char> on_boundary_;
};

// The unit outward normal at every vertex: the mean of the triangles' normals weighted by their
// angles at the vertex (Thuermer & Wuethrich 1998). Zero for a vertex without triangles.
[[nodiscard]] std::vector<Vec3> vertex_normals(const Surface& surface);

}  // namespace palpate::geometry
