// Places of nodes on shapes, on smooth surfaces, and on inclusions.
#include "meshing/true_boundary.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace palpate::meshing {
namespace {

// A node is on an inclusion if its distance from the centre differs from the radius by less than
// this.
constexpr double near_lump = 0.15;

}  // namespace

TrueBoundary::TrueBoundary(const geometry::TetMesh& start, std::optional<geometry::Shape> shape,
                           std::span<const geometry::Lump> lumps, std::span<const double> levels)
    : shape_(std::move(shape)),
      lumps_(lumps.begin(), lumps.end()),
      levels_(levels.begin(), levels.end()),
      nodes_(start.nodes),
      skin_(geometry::skin(start).surface),
      on_skin_(start.nodes.size()) {
  if (shape_) length_ = geometry::extent(*shape_).y();
  if (shape_ && std::holds_alternative<geometry::Cuboid>(*shape_)) shape_.reset();
  const std::vector<int> outer = geometry::skin(start).nodes;
  for (std::size_t v = 0; v < outer.size(); ++v)
    on_skin_[as_index(outer[v])] = {{static_cast<int>(v), -1, -1}, Vec3::UnitX()};
}

// Whether all boundary faces at the edge lie in a flat end of the shape.
bool TrueBoundary::on_end(const Bisection::Middle& edge) const {
  const double close = 1e-9 * length_;
  for (const double end : {0.0, length_}) {
    const auto lies = [&](int node) { return std::abs(nodes_[as_index(node)].y() - end) <= close; };
    if (lies(edge.a) && lies(edge.b) && std::all_of(edge.outer.begin(), edge.outer.end(), lies))
      return true;
  }
  return false;
}

Vec3 TrueBoundary::place(const Bisection::Middle& edge) {
  OnSkin here;
  if (!edge.outer.empty())
    here = between(on_skin_[as_index(edge.a)], on_skin_[as_index(edge.b)], edge.share);
  Vec3 at = smooth_place(edge, here);
  const double close = 1e-9 * (nodes_[as_index(edge.a)] - nodes_[as_index(edge.b)]).norm();
  for (const double level : levels_)
    if (std::abs(nodes_[as_index(edge.a)].z() - level) <= close &&
        std::abs(nodes_[as_index(edge.b)].z() - level) <= close)
      at.z() = level;
  on_skin_.push_back(here);
  nodes_.push_back(at);
  return at;
}

Vec3 TrueBoundary::smooth_place(const Bisection::Middle& edge, const OnSkin& here) const {
  const bool outer = !edge.outer.empty();
  if (edge.inner && !outer)
    for (const geometry::Lump& lump : lumps_) {
      const double first = (nodes_[as_index(edge.a)] - lump.centre).norm();
      const double second = (nodes_[as_index(edge.b)] - lump.centre).norm();
      if (std::max(std::abs(first - lump.radius), std::abs(second - lump.radius)) <
          near_lump * lump.radius)
        return lump.centre + 0.5 * (first + second) * (edge.between - lump.centre).normalized();
    }
  if (shape_ && (edge.inner || (outer && !on_end(edge))))
    return geometry::onto(*shape_, edge.between);
  if (!shape_ && outer) return position(here).value_or(edge.between);
  return edge.between;
}

TrueBoundary::OnSkin TrueBoundary::between(const OnSkin& a, const OnSkin& b, double share) const {
  OnSkin sum;
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
std::optional<Vec3> TrueBoundary::position(const OnSkin& at) const {
  if (at.vertices[0] < 0) return std::nullopt;
  Vec3 sum = Vec3::Zero();
  Vec3 flat = Vec3::Zero();
  int sides = 0;
  bool creased = false;
  for (const int triangle : skin_.neighbours().triangles_at(at.vertices[0])) {
    const auto& corners = skin_.surface().triangles[as_index(triangle)];
    geometry::SurfacePoint point{.triangle = triangle, .weights = Vec3::Zero()};
    bool within = true;
    std::size_t missing = 3;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto found = std::find(at.vertices.begin(), at.vertices.end(), corners[c]);
      if (found == at.vertices.end())
        missing = c;
      else
        point.weights[static_cast<Eigen::Index>(c)] =
            at.weights[static_cast<Eigen::Index>(found - at.vertices.begin())];
    }
    for (const int vertex : at.vertices)
      within = within &&
               (vertex < 0 || std::find(corners.begin(), corners.end(), vertex) != corners.end());
    if (!within) continue;
    if (at.vertices[1] >= 0 && missing < 3 && skin_.crease(triangle, (missing + 1) % 3))
      creased = true;
    flat = skin_.flat_position(point);
    sum += skin_.position(point) - flat;
    ++sides;
  }
  if (sides == 0) return std::nullopt;
  return flat + (creased ? sum : Vec3(sum / sides));
}

void TrueBoundary::restore_lumps(geometry::TetMesh& mesh) {
  for (const geometry::Lump& lump : lumps_) {
    std::vector<char> sides(mesh.nodes.size(), 0);
    const auto volume = [&] {
      double sum = 0.0;
      for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        if (mesh.region(static_cast<int>(t)) == lump.region)
          sum += geometry::signed_volume(mesh, static_cast<int>(t));
      return sum;
    };
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      for (const int node : mesh.tetrahedra[t])
        sides[as_index(node)] |= mesh.region(static_cast<int>(t)) == lump.region ? 1 : 2;
    const double wanted = 4.0 / 3.0 * std::numbers::pi * lump.radius * lump.radius * lump.radius;
    // All nodes of the inclusion move, so that nothing inside turns inside out; around it the move
    // is taken back in part where something would.
    const double wider = std::cbrt(wanted / volume());
    const std::vector<Vec3> before = mesh.nodes;
    for (const double share : {1.0, 0.5, 0.25, 0.0}) {
      const double scale = 1.0 + share * (wider - 1.0);
      for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
        if ((sides[n] & 1) != 0) mesh.nodes[n] = lump.centre + scale * (before[n] - lump.centre);
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

}  // namespace palpate::meshing
