// Measures surfaces, and walks over neighbourhoods; half_edges.cpp finds these.
#include "geometry/surface.h"

#include <algorithm>
#include <map>
#include <set>

namespace palpate::geometry {
OuterSurface outer_surface(const TetMesh& mesh) {
  OuterSurface outer_surface;
  outer_surface.surface.triangles = boundary_faces(mesh);
  std::vector<int> vertex_of(mesh.nodes.size(), -1);
  for (const auto& triangle : outer_surface.surface.triangles)
    for (const int node : triangle) vertex_of[as_index(node)] = 0;
  for (std::size_t n = 0; n < vertex_of.size(); ++n) {
    if (vertex_of[n] < 0) continue;
    vertex_of[n] = static_cast<int>(outer_surface.nodes.size());
    outer_surface.nodes.push_back(static_cast<int>(n));
    outer_surface.surface.vertices.push_back(mesh.nodes[n]);
  }
  for (auto& triangle : outer_surface.surface.triangles)
    for (int& corner : triangle) corner = vertex_of[as_index(corner)];
  return outer_surface;
}

Vec3 twice_area(const Surface& surface, int triangle) {
  const auto& [a, b, c] = surface.triangles[as_index(triangle)];
  const Vec3& origin = surface.vertices[as_index(a)];
  return (surface.vertices[as_index(b)] - origin).cross(surface.vertices[as_index(c)] - origin);
}

Surface piece_of(const Surface& surface, std::span<const int> triangles) {
  Surface piece;
  std::vector<int> number(surface.vertices.size(), -1);
  for (const int t : triangles) {
    std::array<int, 3> corners = surface.triangles[as_index(t)];
    for (int& corner : corners) {
      int& own = number[as_index(corner)];
      if (own < 0) {
        own = static_cast<int>(piece.vertices.size());
        piece.vertices.push_back(surface.vertices[as_index(corner)]);
      }
      corner = own;
    }
    piece.triangles.push_back(corners);
  }
  return piece;
}

Surface with_halved_edges(Surface surface, std::size_t count) {
  std::map<std::array<int, 2>, std::vector<int>> sides;     // an edge's triangles
  std::set<std::pair<double, std::array<int, 2>>> longest;  // the negative of its length, m^2
  const auto edge_of = [](int a, int b) { return std::array{std::min(a, b), std::max(a, b)}; };
  const auto key = [&](const std::array<int, 2>& edge) {
    const Vec3 along = surface.vertices[as_index(edge[1])] - surface.vertices[as_index(edge[0])];
    return std::pair(-along.squaredNorm(), edge);
  };
  const auto join = [&](int t) {
    const auto& triangle = surface.triangles[as_index(t)];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto edge = edge_of(triangle[i], triangle[(i + 1) % 3]);
      sides[edge].push_back(t);
      longest.insert(key(edge));
    }
  };
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) join(t);
  while (surface.vertices.size() < count && !longest.empty()) {
    const std::array<int, 2> edge = longest.begin()->second;
    longest.erase(longest.begin());
    const auto middle = static_cast<int>(surface.vertices.size());
    surface.vertices.emplace_back(
        0.5 * (surface.vertices[as_index(edge[0])] + surface.vertices[as_index(edge[1])]));
    const std::vector<int> beside = sides[edge];
    for (const int t : beside) {
      auto other = surface.triangles[as_index(t)];
      for (std::size_t i = 0; i < 3; ++i)
        std::erase(sides[edge_of(other[i], other[(i + 1) % 3])], t);
      std::ranges::replace(surface.triangles[as_index(t)], edge[0], middle);
      std::ranges::replace(other, edge[1], middle);
      surface.triangles.push_back(other);
      join(t);
      join(static_cast<int>(surface.triangles.size()) - 1);
    }
    sides.erase(edge);
  }
  return surface;
}

double area(const Surface& surface) {
  double sum = 0.0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    sum += 0.5 * twice_area(surface, static_cast<int>(t)).norm();
  return sum;
}

Enclosed enclosed(const Surface& surface) {
  Enclosed inside;
  if (surface.vertices.empty()) return inside;
  // Tetrahedra from one vertex to every triangle: V = sum a . (b x c) / 6, with centroids that are
  // a quarter of the sum of their corners. docs/theory.md [volume]
  const Vec3 apex = surface.vertices.front();
  Vec3 moment = Vec3::Zero();
  for (const auto& triangle : surface.triangles) {
    const Vec3 a = surface.vertices[as_index(triangle[0])] - apex;
    const Vec3 b = surface.vertices[as_index(triangle[1])] - apex;
    const Vec3 c = surface.vertices[as_index(triangle[2])] - apex;
    const double volume = a.dot(b.cross(c)) / 6.0;
    inside.volume += volume;
    moment += 0.25 * volume * (a + b + c);
  }
  inside.centroid = apex;
  if (inside.volume != 0.0) inside.centroid += moment / inside.volume;
  return inside;
}

double corner_angle(const Surface& surface, int triangle, std::size_t corner) {
  const auto at = [&](std::size_t i) -> const Vec3& {
    return surface.vertices[as_index(surface.triangles[as_index(triangle)][i % 3])];
  };
  const Vec3 left = at(corner + 1) - at(corner);
  const Vec3 right = at(corner + 2) - at(corner);
  return angle_between(left, right);
}

std::size_t corner_of(const std::array<int, 3>& triangle, int vertex) {
  return as_index(std::ranges::find(triangle, vertex) - triangle.begin());
}

std::span<const int> list_of(const std::vector<int>& starts, const std::vector<int>& items,
                             int index) {
  const auto first = as_index(starts[as_index(index)]);
  const auto last = as_index(starts[as_index(index) + 1]);
  return std::span(items).subspan(first, last - first);
}

std::span<const int> Neighbours::triangles_at(int vertex) const {
  return list_of(triangle_starts_, triangles_, vertex);
}

std::span<const int> Neighbours::vertices_at(int vertex) const {
  return list_of(vertex_starts_, vertices_, vertex);
}

std::vector<int> Neighbours::rings(std::span<const int> start, int rings) const {
  std::vector<char> known(on_boundary_.size(), 0);
  std::vector<int> found(start.begin(), start.end());
  for (const int vertex : start) known[as_index(vertex)] = 1;
  std::size_t first = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t last = found.size();
    for (; first < last; ++first)
      for (const int next : vertices_at(found[first])) {
        if (known[as_index(next)] != 0) continue;
        known[as_index(next)] = 1;
        found.push_back(next);
      }
  }
  std::ranges::sort(found);
  return found;
}

std::vector<Vec3> vertex_normals(const Surface& surface) {
  std::vector<Vec3> normals(surface.vertices.size(), Vec3::Zero());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Vec3 normal = twice_area(surface, static_cast<int>(t)).normalized();
    for (std::size_t i = 0; i < 3; ++i)
      normals[as_index(surface.triangles[t][i])] +=
          corner_angle(surface, static_cast<int>(t), i) * normal;
  }
  for (Vec3& normal : normals)
    if (normal.squaredNorm() > 0.0) normal.normalize();
  return normals;
}

}  // namespace palpate::geometry
