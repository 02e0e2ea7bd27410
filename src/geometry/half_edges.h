// How the triangles of a surface join at edges and vertices, by OpenMesh's half-edge structure.
#pragma once

#include <optional>
#include <vector>

#include "geometry/surface.h"

namespace palpate::geometry {

// Indices are those of the surface.
struct Joints {
  // The first triangle that cannot be joined to those before it, and why: the edge (from, to) that
  // it shares has two triangles already, or one that runs from `from` to `to` as well (`others`);
  // or it touches one of them in the vertex `from` only, and then `to` is -1.
  struct Refused {
    int triangle = -1;
    int from = -1, to = -1;
    std::vector<int> others;
  };
  std::optional<Refused> refused;  // what follows is then empty

  struct OpenEdge {
    int from, to, triangle;  // it runs from `from` to `to`
  };
  std::vector<std::vector<OpenEdge>> holes;  // the edges of one triangle, by boundary

  std::vector<int> first_triangles;  // the lowest one of each connected part, ascending
  std::vector<int> part;             // of each triangle: an index into `first_triangles`
};

// The triangles have three different corners each.
[[nodiscard]] Joints joints(const Surface& surface);

// A connected part of a surface, with its own vertices.
struct SurfacePart {
  Surface surface;
  std::vector<int> triangles;  // of the whole surface, ascending
};

// In the order of their first triangles; none if triangles cannot be joined.
[[nodiscard]] std::vector<SurfacePart> parts_of(const Surface& surface);

}  // namespace palpate::geometry
