// Longest-edge bisection with propagation to the neighbours.
#include "meshing/bisection.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

namespace palpate::meshing {
namespace {

// A half keeps at least this part of the volume that it has with the node halfway.
constexpr double least_volume = 0.2;

bool has(const std::array<int, 4>& corners, int node) {
  return std::ranges::find(corners, node) != corners.end();
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
  std::ranges::copy(marked, left_.begin());
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
    const auto other = std::ranges::find_if(ring, [&](int t) { return !(longest(t) == edge); });
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
    std::ranges::sort(crossing);
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
      std::ranges::replace(half, end, fresh);
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

namespace {

// A node is on an inclusion if its distance from the centre differs from the radius by less than
// this.
constexpr double near_inclusion = 0.15;

}  // namespace

TrueBoundary::TrueBoundary(const geometry::TetMesh& start, std::optional<geometry::Shape> shape,
                           std::span<const geometry::Inclusion> inclusions,
                           std::span<const double> levels)
    : shape_(std::move(shape)),
      inclusions_(inclusions.begin(), inclusions.end()),
      levels_(levels.begin(), levels.end()),
      nodes_(start.nodes),
      outer_surface_(geometry::outer_surface(start).surface),
      on_surface_(start.nodes.size()) {
  if (shape_) axis_ = geometry::axis_of(*shape_);
  if (shape_) length_ = geometry::extent(*shape_)[axis_];
  if (shape_ && std::holds_alternative<geometry::Cuboid>(*shape_)) shape_.reset();
  const std::vector<int> outer = geometry::outer_surface(start).nodes;
  for (std::size_t v = 0; v < outer.size(); ++v)
    on_surface_[as_index(outer[v])] = {{static_cast<int>(v), -1, -1}, Vec3::UnitX()};
}

// Whether all boundary faces at the edge lie in a flat end of the shape.
bool TrueBoundary::on_end(const Bisection::Middle& edge) const {
  const double close = 1e-9 * length_;
  for (const double end : {0.0, length_}) {
    const auto lies = [&](int node) {
      return std::abs(nodes_[as_index(node)][axis_] - end) <= close;
    };
    if (lies(edge.a) && lies(edge.b) && std::ranges::all_of(edge.outer, lies)) return true;
  }
  return false;
}

Vec3 TrueBoundary::place(const Bisection::Middle& edge) {
  OnSurface here;
  if (!edge.outer.empty())
    here = between(on_surface_[as_index(edge.a)], on_surface_[as_index(edge.b)], edge.share);
  Vec3 at = smooth_place(edge, here);
  const double close = 1e-9 * (nodes_[as_index(edge.a)] - nodes_[as_index(edge.b)]).norm();
  for (const double level : levels_)
    if (std::abs(nodes_[as_index(edge.a)].z() - level) <= close &&
        std::abs(nodes_[as_index(edge.b)].z() - level) <= close)
      at.z() = level;
  on_surface_.push_back(here);
  nodes_.push_back(at);
  return at;
}

Vec3 TrueBoundary::smooth_place(const Bisection::Middle& edge, const OnSurface& here) const {
  const bool outer = !edge.outer.empty();
  if (edge.inner && !outer)
    for (const geometry::Inclusion& inclusion : inclusions_) {
      const double first = (nodes_[as_index(edge.a)] - inclusion.centre).norm();
      const double second = (nodes_[as_index(edge.b)] - inclusion.centre).norm();
      if (std::max(std::abs(first - inclusion.radius), std::abs(second - inclusion.radius)) <
          near_inclusion * inclusion.radius)
        return inclusion.centre +
               0.5 * (first + second) * (edge.between - inclusion.centre).normalized();
    }
  if (shape_ && (edge.inner || (outer && !on_end(edge))))
    return geometry::onto(*shape_, edge.between);
  if (!shape_ && outer) return position(here).value_or(edge.between);
  return edge.between;
}

TrueBoundary::OnSurface TrueBoundary::between(const OnSurface& a, const OnSurface& b,
                                              double share) const {
  OnSurface sum;
  std::size_t count = 0;
  for (const auto& [part, weight] : {std::pair{&a, 1.0 - share}, std::pair{&b, share}})
    for (std::size_t k = 0; k < 3; ++k) {
      const int vertex = part->vertices[k];
      if (vertex < 0) continue;
      std::size_t at = 0;
      while (at < count && sum.vertices[at] != vertex) ++at;
      if (at == 3) return {};  // not within one triangle
      if (at == count) sum.vertices[count++] = vertex;
      sum.weights[static_cast<Eigen::Index>(at)] +=
          weight * part->weights[static_cast<Eigen::Index>(k)];
    }
  return sum;
}

// On a crease both sides displace the point from its place on the flat triangles.
std::optional<Vec3> TrueBoundary::position(const OnSurface& at) const {
  if (at.vertices[0] < 0) return std::nullopt;
  Vec3 sum = Vec3::Zero();
  Vec3 flat = Vec3::Zero();
  int sides = 0;
  bool creased = false;
  for (const int triangle : outer_surface_.neighbours().triangles_at(at.vertices[0])) {
    const auto& corners = outer_surface_.surface().triangles[as_index(triangle)];
    geometry::SurfacePoint point{.triangle = triangle, .weights = Vec3::Zero()};
    bool within = true;
    std::size_t missing = 3;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto found = std::ranges::find(at.vertices, corners[c]);
      if (found == at.vertices.end())
        missing = c;
      else
        point.weights[static_cast<Eigen::Index>(c)] =
            at.weights[static_cast<Eigen::Index>(found - at.vertices.begin())];
    }
    for (const int vertex : at.vertices)
      within = within && (vertex < 0 || std::ranges::find(corners, vertex) != corners.end());
    if (!within) continue;
    if (at.vertices[1] >= 0 && missing < 3 && outer_surface_.crease(triangle, (missing + 1) % 3))
      creased = true;
    flat = outer_surface_.flat_position(point);
    sum += outer_surface_.position(point) - flat;
    ++sides;
  }
  if (sides == 0) return std::nullopt;
  return flat + (creased ? sum : Vec3(sum / sides));
}

void TrueBoundary::restore_inclusions(geometry::TetMesh& mesh) {
  for (const geometry::Inclusion& inclusion : inclusions_) {
    std::vector<char> sides(mesh.nodes.size(), 0);
    const auto volume = [&] {
      double sum = 0.0;
      for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        if (mesh.region(static_cast<int>(t)) == inclusion.region)
          sum += geometry::signed_volume(mesh, static_cast<int>(t));
      return sum;
    };
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      for (const int node : mesh.tetrahedra[t])
        sides[as_index(node)] |= mesh.region(static_cast<int>(t)) == inclusion.region ? 1 : 2;
    const double wanted =
        4.0 / 3.0 * std::numbers::pi * inclusion.radius * inclusion.radius * inclusion.radius;
    // All nodes of the inclusion move, so that nothing inside turns inside out; around it the move
    // is taken back in part where something would.
    const double wider = std::cbrt(wanted / volume());
    const std::vector<Vec3> before = mesh.nodes;
    for (const double share : {1.0, 0.5, 0.25, 0.0}) {
      const double scale = 1.0 + share * (wider - 1.0);
      for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
        if ((sides[n] & 1) != 0)
          mesh.nodes[n] = inclusion.centre + scale * (before[n] - inclusion.centre);
      bool good = true;
      for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        const int tetrahedron = static_cast<int>(t);
        good = good && geometry::signed_volume(mesh, tetrahedron) > 0.0;
      }
      if (good) break;
    }
  }
  nodes_ = mesh.nodes;
}

namespace {

// The part of an edge from a node to the plane, up to which the node is moved.
constexpr double near_part = 0.25;
constexpr double near_part_on_skin = 0.5;  // needs no new nodes where nodes are free to move
constexpr double least_volume_left = 0.2;  // of a tetrahedron, that moving a node leaves

// How freely a node may move, and along which edges.
enum class Freedom { everywhere, outer_surface, crease, fixed };

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
    borders.edges[edge] = crease ? Freedom::crease : Freedom::outer_surface;
    for (const int node : edge) {
      Freedom& own = borders.freedom[as_index(node)];
      own = std::max(own, crease ? Freedom::crease : Freedom::outer_surface);
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
      if (shape && own == Freedom::outer_surface) {
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
