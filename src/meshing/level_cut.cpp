// Moves nodes that are near the plane, then splits edges.
#include "meshing/level_cut.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "geometry/smooth_surface.h"
#include "meshing/bisection.h"
#include "meshing/true_boundary.h"

namespace palpate::meshing {
namespace {

// The part of an edge from a node to the plane, up to which the node is moved.
constexpr double near_part = 0.25;
constexpr double near_part_on_skin = 0.5;  // needs no new nodes where nodes are free to move
constexpr double least_volume_left = 0.2;  // of a tetrahedron, that moving a node leaves

// How freely a node may move, and along which edges.
enum class Freedom { everywhere, skin, crease, fixed };

struct Borders {
  std::vector<Freedom> freedom;                 // per node
  std::map<std::array<int, 2>, Freedom> edges;  // of the boundary: surface or crease
};

Borders borders_of(const geometry::TetMesh& mesh) {
  Borders borders;
  borders.freedom.assign(mesh.nodes.size(), Freedom::everywhere);
  std::map<std::array<int, 2>, std::vector<Vec3>> normals;
  for (const auto& face : geometry::boundary_faces(mesh)) {
    const auto node = [&](std::size_t k) -> const Vec3& { return mesh.nodes[as_index(face[k])]; };
    const Vec3 normal = (node(1) - node(0)).cross(node(2) - node(0)).normalized();
    for (std::size_t k = 0; k < 3; ++k)
      normals[{std::min(face[k], face[(k + 1) % 3]), std::max(face[k], face[(k + 1) % 3])}]
          .push_back(normal);
  }
  std::vector<int> creases(mesh.nodes.size(), 0);
  for (const auto& [edge, sides] : normals) {
    const bool crease =
        sides.size() != 2 || sides.front().dot(sides.back()) < geometry::crease_cosine;
    borders.edges[edge] = crease ? Freedom::crease : Freedom::skin;
    for (const int node : edge) {
      Freedom& own = borders.freedom[as_index(node)];
      own = std::max(own, crease ? Freedom::crease : Freedom::skin);
      if (crease && ++creases[as_index(node)] > 2) own = Freedom::fixed;
    }
  }
  std::vector<std::set<int>> regions(mesh.nodes.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (const int node : mesh.tetrahedra[t]) {
      regions[as_index(node)].insert(mesh.region(static_cast<int>(t)));
      if (regions[as_index(node)].size() > 1) borders.freedom[as_index(node)] = Freedom::fixed;
    }
  return borders;
}

// Moves nodes near the plane into it.
void snap(geometry::TetMesh& mesh, double z, bool outer_only,
          const std::optional<geometry::Shape>& shape) {
  const Borders borders = borders_of(mesh);
  std::vector<std::vector<int>> at(mesh.nodes.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (const int node : mesh.tetrahedra[t]) at[as_index(node)].push_back(static_cast<int>(t));
  struct Move {
    double share = 0.0;  // of an edge, to the plane
    Vec3 to = Vec3::Zero();
    bool found = false;
  };
  std::vector<Move> moves(mesh.nodes.size(),
                          Move{.share = outer_only ? near_part_on_skin : near_part});
  for (const auto& edge : geometry::edges(mesh)) {
    const auto outer = borders.edges.find(edge);
    const Freedom along = outer != borders.edges.end() ? outer->second : Freedom::everywhere;
    if (outer_only && along == Freedom::everywhere) continue;
    for (const auto& [from, to] : {std::pair{edge[0], edge[1]}, std::pair{edge[1], edge[0]}}) {
      const Vec3& start = mesh.nodes[as_index(from)];
      const Vec3 way = mesh.nodes[as_index(to)] - start;
      const double share = (z - start.z()) / way.z();
      Move& move = moves[as_index(from)];
      const Freedom own = borders.freedom[as_index(from)];
      // On the boundary a node moves along its surface, on a crease along that crease.
      if (!(share > 0.0 && share < move.share) || own == Freedom::fixed || along < own) continue;
      move = {share, start + share * way, true};
      if (shape && own == Freedom::skin) {
        // A node in a flat end stays there.
        const Vec3 round = geometry::onto(*shape, move.to);
        if ((round - move.to).norm() < 0.1 * way.norm()) move.to = round;
      }
      move.to.z() = z;
    }
  }
  for (std::size_t n = 0; n < moves.size(); ++n) {
    if (!moves[n].found) continue;
    std::vector<double> least;
    for (const int t : at[n]) least.push_back(least_volume_left * geometry::signed_volume(mesh, t));
    const Vec3 before = std::exchange(mesh.nodes[n], moves[n].to);
    for (std::size_t i = 0; i < at[n].size(); ++i)
      if (geometry::signed_volume(mesh, at[n][i]) < least[i]) mesh.nodes[n] = before;
  }
}

}  // namespace

geometry::TetMesh cut_at(geometry::TetMesh mesh, double z, bool outer_only,
                         const std::optional<geometry::Shape>& shape) {
  snap(mesh, z, outer_only, shape);
  TrueBoundary boundary(mesh, shape, {}, {});
  Bisection bisection(std::move(mesh),
                      [&](const Bisection::Middle& edge) { return boundary.place(edge); });
  bisection.cut(z, outer_only);
  return bisection.mesh();
}

}  // namespace palpate::meshing
