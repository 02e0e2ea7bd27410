// Longest-edge bisection with propagation to the neighbours.
#include "meshing/bisection.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>

namespace palpate::meshing {
namespace {

// A half keeps at least this part of the volume that it has with the node halfway.
constexpr double least_volume = 0.2;

bool has(const std::array<int, 4>& corners, int node) {
  return std::find(corners.begin(), corners.end(), node) != corners.end();
}

}  // namespace

Bisection::Bisection(geometry::TetMesh mesh, Place place)
    : mesh_(std::move(mesh)),
      place_(std::move(place)),
      left_(mesh_.tetrahedra.size(), 0),
      gone_(mesh_.tetrahedra.size(), 0),
      at_(mesh_.nodes.size()) {
  for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t)
    for (const int node : mesh_.tetrahedra[t]) at_[as_index(node)].push_back(static_cast<int>(t));
}

void Bisection::halve(std::span<const char> marked) {
  std::copy(marked.begin(), marked.end(), left_.begin());
  // Halves are appended, so that they are reached as well.
  for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t)
    if (gone_[t] == 0 && left_[t] > 0) halve(static_cast<int>(t));
}

Bisection::Edge Bisection::longest(int tetrahedron) const {
  const std::array<int, 4>& corners = mesh_.tetrahedra[as_index(tetrahedron)];
  Edge best;
  for (const auto& [i, j] : geometry::corner_edges) {
    const auto [a, b] = std::minmax(corners[as_index(i)], corners[as_index(j)]);
    const double squared = (mesh_.nodes[as_index(a)] - mesh_.nodes[as_index(b)]).squaredNorm();
    if (std::tie(squared, a, b) > std::tie(best.squared, best.a, best.b)) best = {a, b, squared};
  }
  return best;
}

std::vector<int> Bisection::around(const Edge& edge) const {
  std::vector<int> found;
  for (const int t : at_[as_index(edge.a)])
    if (gone_[as_index(t)] == 0 && has(mesh_.tetrahedra[as_index(t)], edge.b)) found.push_back(t);
  return found;
}

void Bisection::halve(int tetrahedron) {
  const Edge edge = longest(tetrahedron);
  while (gone_[as_index(tetrahedron)] == 0) {
    const std::vector<int> ring = around(edge);
    const auto other =
        std::find_if(ring.begin(), ring.end(), [&](int t) { return !(longest(t) == edge); });
    if (other != ring.end())
      halve(*other);  // ends, because its edge is longer
    else
      split(edge);
  }
}

void Bisection::cut(double z, bool outer_only) {
  const auto height = [&](int node) { return mesh_.nodes[as_index(node)].z(); };
  std::vector<std::array<int, 2>> crossing;
  const auto add = [&](int a, int b) {
    if ((height(a) < z && height(b) > z) || (height(b) < z && height(a) > z))
      crossing.push_back({std::min(a, b), std::max(a, b)});
  };
  if (outer_only) {
    for (const auto& [a, b, c] : geometry::boundary_faces(mesh_)) {
      add(a, b);
      add(b, c);
      add(c, a);
    }
    std::sort(crossing.begin(), crossing.end());
    crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
  } else {
    for (const auto& [a, b] : geometry::edges(mesh_)) add(a, b);
  }
  // On the boundary alone, a node as near as this counts as in the plane, and no sliver is cut.
  constexpr double in_plane = 0.02;  // of an edge
  for (const auto& [a, b] : crossing) {
    const double share = (z - height(a)) / (height(b) - height(a));
    if (outer_only && std::min(share, 1.0 - share) < in_plane) continue;
    split({.a = a, .b = b}, share, &z);
  }
}

// The new node is at `share` of the edge and, if given, at `height`.
void Bisection::split(const Edge& edge, double share, const double* height) {
  const std::vector<int> ring = around(edge);
  const Vec3& start = mesh_.nodes[as_index(edge.a)];
  Middle middle{.a = edge.a,
                .b = edge.b,
                .share = share,
                .between = start + share * (mesh_.nodes[as_index(edge.b)] - start),
                .outer = {}};
  if (height != nullptr) middle.between.z() = *height;
  std::map<int, std::vector<int>> regions;  // by the third node of the faces at the edge
  for (const int t : ring)
    for (const int node : mesh_.tetrahedra[as_index(t)])
      if (node != edge.a && node != edge.b) regions[node].push_back(mesh_.region(t));
  for (const auto& [node, sides] : regions) {
    if (sides.size() == 1) middle.outer.push_back(node);
    middle.inner = middle.inner || sides.front() != sides.back();
  }

  const int fresh = static_cast<int>(mesh_.nodes.size());
  Vec3 wanted = place_(middle);
  if (height != nullptr) wanted.z() = *height;
  std::vector<std::array<int, 4>> halves;
  for (const int t : ring)
    for (const int end : {edge.b, edge.a}) {
      std::array<int, 4> half = mesh_.tetrahedra[as_index(t)];
      std::replace(half.begin(), half.end(), end, fresh);
      halves.push_back(half);
    }
  mesh_.nodes.push_back(middle.between);
  at_.emplace_back();
  const auto volume = [&](const std::array<int, 4>& corners) {
    const auto node = [&](std::size_t k) -> const Vec3& {
      return mesh_.nodes[as_index(corners[k])];
    };
    return (node(1) - node(0)).cross(node(2) - node(0)).dot(node(3) - node(0));
  };
  std::vector<double> least;
  for (const auto& half : halves) least.push_back(least_volume * volume(half));
  for (const double part : {1.0, 0.5, 0.25}) {
    mesh_.nodes.back() = middle.between + part * (wanted - middle.between);
    bool good = true;
    for (std::size_t i = 0; i < halves.size(); ++i) good = good && volume(halves[i]) >= least[i];
    if (good) break;
    mesh_.nodes.back() = middle.between;
  }

  for (std::size_t i = 0; i < halves.size(); ++i) {
    const std::size_t parent = as_index(ring[i / 2]);
    const int child = static_cast<int>(mesh_.tetrahedra.size());
    mesh_.tetrahedra.push_back(halves[i]);
    if (!mesh_.regions.empty()) mesh_.regions.push_back(mesh_.regions[parent]);
    left_.push_back(static_cast<char>(std::max(0, left_[parent] - 1)));
    gone_.push_back(0);
    gone_[parent] = 1;
    for (const int node : halves[i]) at_[as_index(node)].push_back(child);
  }
}

geometry::TetMesh Bisection::mesh() const {
  geometry::TetMesh kept{.nodes = mesh_.nodes, .tetrahedra = {}, .regions = {}};
  for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
    if (gone_[t] != 0) continue;
    kept.tetrahedra.push_back(mesh_.tetrahedra[t]);
    if (!mesh_.regions.empty()) kept.regions.push_back(mesh_.regions[t]);
  }
  return kept;
}

}  // namespace palpate::meshing
