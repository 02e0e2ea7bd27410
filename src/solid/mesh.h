// A mesh of ten-node tetrahedra with its outer faces.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "geometry/tet_mesh.h"

namespace palpate::solid {

// Corners as those of geometry::TetMesh, then the middles of geometry::corner_edges in their order.
using Element = std::array<int, 10>;
// Corners counter-clockwise from outside, then the middles of edges (0, 1), (1, 2), (2, 0).
using Face = std::array<int, 6>;

struct OuterFace {
  Face nodes{};
  int element = 0;
};

struct Mesh {
  std::vector<Vec3> nodes;  // m
  std::vector<Element> elements;
  std::vector<int> regions;         // one per element
  std::vector<OuterFace> boundary;  // in the order of the elements
};

// The place (m) of the middle of an edge between two corners (ascending) of the mesh, or nothing
// for its straight middle.
using Middle = std::function<std::optional<Vec3>(const std::array<int, 2>& corners)>;

// Gives every tetrahedron middles of its edges; corners keep their numbers. Where a curved edge
// would turn an element inside out, it stays straight. Throws MeshError if a tetrahedron is flat.
[[nodiscard]] Mesh quadratic(const geometry::TetMesh& mesh, const Middle& middle = {});

// Values and derivatives of the ten functions of an element at barycentric coordinates of its
// corners; the derivatives are those to the last three.
struct Functions {
  std::array<double, 10> values{};
  std::array<Vec3, 10> derivatives{};
};
[[nodiscard]] Functions functions_at(const std::array<double, 4>& corners);

// The four integration points of an element, each with the weight 1/24.
inline constexpr int points = 4;
[[nodiscard]] const std::array<Functions, points>& at_points();

}  // namespace palpate::solid
