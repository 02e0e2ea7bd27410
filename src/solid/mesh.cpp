// Numbers the middles of edges, and places those of the boundary.
#include "solid/mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"

namespace palpate::solid {
namespace {

using Edge = std::array<int, 2>;

Edge sorted(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// Whether the element's Jacobian is positive at its integration points and corners, by a margin
// against that of its straight tetrahedron.
bool stands(const Mesh& mesh, const Element& element) {
  constexpr double least = 0.1;
  const auto jacobian = [&](const Functions& at) {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    for (std::size_t a = 0; a < 10; ++a)
      matrix += mesh.nodes[as_index(element[a])] * at.derivatives[a].transpose();
    return matrix.determinant();
  };
  const auto corner = [&](std::size_t a) { return mesh.nodes[as_index(element[a])]; };
  const double straight =
      (corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0));
  for (const Functions& at : at_points())
    if (jacobian(at) < least * straight) return false;
  for (std::size_t a = 0; a < 4; ++a) {
    std::array<double, 4> only{};
    only[a] = 1.0;
    if (jacobian(functions_at(only)) < least * straight) return false;
  }
  return straight > 0.0;
}

}  // namespace

Functions functions_at(const std::array<double, 4>& l) {
  static const std::array<Vec3, 4> slope{Vec3(-1, -1, -1), Vec3(1, 0, 0), Vec3(0, 1, 0),
                                         Vec3(0, 0, 1)};
  Functions at;
  for (std::size_t a = 0; a < 4; ++a) {
    at.values[a] = l[a] * (2.0 * l[a] - 1.0);
    at.derivatives[a] = (4.0 * l[a] - 1.0) * slope[a];
  }
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] =
        std::pair(as_index(geometry::corner_edges[e][0]), as_index(geometry::corner_edges[e][1]));
    at.values[4 + e] = 4.0 * l[i] * l[j];
    at.derivatives[4 + e] = 4.0 * (l[i] * slope[j] + l[j] * slope[i]);
  }
  return at;
}

const std::array<Functions, points>& at_points() {
  static const std::array<Functions, points> all = [] {
    const double b = (5.0 - std::sqrt(5.0)) / 20.0;  // exact for polynomials of degree two
    std::array<Functions, points> found;
    for (std::size_t q = 0; q < points; ++q) {
      std::array<double, 4> at{b, b, b, b};
      at[q] = 1.0 - 3.0 * b;
      found[q] = functions_at(at);
    }
    return found;
  }();
  return all;
}

Mesh quadratic(const geometry::TetMesh& from, const Middle& middle) {
  Mesh mesh;
  mesh.nodes = from.nodes;
  mesh.regions.resize(from.tetrahedra.size(), 0);
  std::map<Edge, int> middles;
  for (std::size_t t = 0; t < from.tetrahedra.size(); ++t) {
    mesh.regions[t] = from.region(static_cast<int>(t));
    Element element{};
    for (std::size_t a = 0; a < 4; ++a) element[a] = from.tetrahedra[t][a];
    for (std::size_t e = 0; e < 6; ++e) {
      const int i = element[as_index(geometry::corner_edges[e][0])];
      const int j = element[as_index(geometry::corner_edges[e][1])];
      const auto [found, added] =
          middles.try_emplace(sorted(i, j), static_cast<int>(mesh.nodes.size()));
      if (added) mesh.nodes.emplace_back(0.5 * (mesh.nodes[as_index(i)] + mesh.nodes[as_index(j)]));
      element[4 + e] = found->second;
    }
    mesh.elements.push_back(element);
  }
  std::map<std::array<int, 3>, int> uses;
  const auto key = [](std::array<int, 3> face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  const auto corners = [&](std::size_t t, const std::array<int, 3>& face) {
    const auto& element = mesh.elements[t];
    return std::array<int, 3>{element[as_index(face[0])], element[as_index(face[1])],
                              element[as_index(face[2])]};
  };
  for (std::size_t t = 0; t < mesh.elements.size(); ++t)
    for (const auto& face : geometry::outward_faces) ++uses[key(corners(t, face))];
  for (std::size_t t = 0; t < mesh.elements.size(); ++t)
    for (const auto& face : geometry::outward_faces) {
      const std::array<int, 3> c = corners(t, face);
      if (uses[key(c)] != 1) continue;
      OuterFace one{.element = static_cast<int>(t)};
      for (std::size_t i = 0; i < 3; ++i) {
        one.nodes[i] = c[i];
        one.nodes[3 + i] = middles.at(sorted(c[i], c[(i + 1) % 3]));
      }
      mesh.boundary.push_back(one);
    }
  std::map<int, Vec3> straight;  // of the middles that were moved
  if (middle)
    for (const auto& [edge, node] : middles) {
      const auto place = middle(edge);
      if (!place) continue;
      straight[node] = mesh.nodes[as_index(node)];
      mesh.nodes[as_index(node)] = *place;
    }
  // A node that is put back may be needed by a neighbour, so that all are looked at again.
  for (bool all_stand = false; !all_stand;) {
    all_stand = true;
    for (const Element& element : mesh.elements) {
      if (stands(mesh, element)) continue;
      // The one that moved farthest goes back.
      auto farthest = straight.end();
      for (std::size_t a = 4; a < 10; ++a) {
        const auto was = straight.find(element[a]);
        if (was == straight.end()) continue;
        const auto moved = [&](const auto& one) {
          return (mesh.nodes[as_index(one->first)] - one->second).squaredNorm();
        };
        if (farthest == straight.end() || moved(was) > moved(farthest)) farthest = was;
      }
      if (farthest == straight.end())
        throw MeshError(
            "a tetrahedron of the mesh is flat; change the size or the surface a little");
      mesh.nodes[as_index(farthest->first)] = farthest->second;
      straight.erase(farthest);
      all_stand = false;
    }
  }
  return mesh;
}

}  // namespace palpate::solid
