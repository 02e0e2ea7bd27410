// Parts of a quadratic face are quadratic faces: their middles are its values at their places.
#include "geometry/curved_edges.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace palpate::geometry {
namespace {

std::array<int, 2> ascending(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

CurvedEdges::CurvedEdges(std::vector<Vec3> nodes, EdgeMiddles middles)
    : nodes_(std::move(nodes)),
      middles_(std::move(middles)),
      given_(static_cast<int>(nodes_.size())) {}

Vec3 CurvedEdges::middle(int a, int b) const {
  const auto place = [&](int node) -> const Vec3& { return nodes_[as_index(node)]; };
  if (const auto known = middles_.find(ascending(a, b)); known != middles_.end())
    return known->second;
  const auto [older, newer] = std::minmax(a, b);
  if (newer < given_) return 0.5 * (place(a) + place(b));
  const auto& [one, other] = parents_[as_index(newer - given_)];
  // The parabola through an edge's three nodes at a quarter of it.
  if (older == one || older == other) {
    const int beyond = older == one ? other : one;
    return 0.375 * place(older) + 0.75 * place(newer) - 0.125 * place(beyond);
  }
  // The quadratic function of a face at the barycentric coordinates 1/4, 1/4 and 1/2.
  return 0.25 * place(newer) - 0.125 * (place(one) + place(other)) +
         0.5 * (middle(one, older) + middle(other, older));
}

Vec3 CurvedEdges::split(int a, int b) {
  nodes_.push_back(middle(a, b));
  parents_.push_back({a, b});
  return nodes_.back();
}

Surface curved_boundary(const TetMesh& mesh, const EdgeMiddles& middles) {
  OuterSurface straight = outer_surface(mesh);
  if (middles.empty()) return std::move(straight.surface);
  std::map<int, int> vertex;  // by nodes
  for (std::size_t v = 0; v < straight.nodes.size(); ++v)
    vertex[straight.nodes[v]] = static_cast<int>(v);
  EdgeMiddles outer;
  for (const auto& [edge, place] : middles) {
    const auto a = vertex.find(edge[0]), b = vertex.find(edge[1]);
    if (a != vertex.end() && b != vertex.end()) outer[{a->second, b->second}] = place;
  }
  CurvedEdges edges(std::move(straight.surface.vertices), std::move(outer));
  std::vector<std::array<int, 3>> triangles = std::move(straight.surface.triangles);
  constexpr double most_turn = 25.0 * std::numbers::pi / 180.0;
  constexpr int most_rounds = 3;
  double turn = 0.0;
  for (int round = 0; round == 0 || (round < most_rounds && turn > most_turn); ++round) {
    turn = 0.0;
    std::map<std::array<int, 2>, int> middle;
    std::vector<std::array<int, 3>> parts;
    for (const auto& triangle : triangles) {
      std::array<int, 3> between{};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto edge = ascending(triangle[i], triangle[(i + 1) % 3]);
        const auto [found, added] =
            middle.try_emplace(edge, static_cast<int>(edges.nodes().size()));
        between[i] = found->second;
        if (!added) continue;
        const Vec3 place = edges.split(edge[0], edge[1]);
        turn = std::max(turn, angle_between(place - edges.nodes()[as_index(edge[0])],
                                            edges.nodes()[as_index(edge[1])] - place));
      }
      const auto& [a, b, c] = triangle;
      const auto& [ab, bc, ca] = between;
      parts.insert(parts.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(parts);
  }
  return {edges.nodes(), std::move(triangles)};
}

}  // namespace palpate::geometry
