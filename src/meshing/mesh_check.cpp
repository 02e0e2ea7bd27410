// The checks, each with its message; later checks rely on earlier ones.
#include "meshing/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "geometry/box.h"
#include "geometry/half_edges.h"

namespace palpate::meshing {
namespace {

template <std::size_t N>
std::string listed(const std::array<int, N>& nodes) {
  std::string text = "(";
  for (std::size_t i = 0; i < N; ++i) text += (i ? ", " : "") + std::to_string(nodes[i]);
  return text + ")";
}

class Checker {
 public:
  Checker(const geometry::TetMesh& mesh, const std::string& name) : mesh_(mesh), name_(name) {}

  void indices() const {
    if (mesh_.tetrahedra.empty())
      fail("has no tetrahedra; check that the surface it was made from is closed");
    const int count = static_cast<int>(mesh_.nodes.size());
    for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t)
      for (const int node : mesh_.tetrahedra[t])
        if (node < 0 || node >= count)
          fail("tetrahedron " + std::to_string(t) + " names node " + std::to_string(node) +
               ", but the nodes run from 0 to " + std::to_string(count - 1) +
               "; check whether the numbering starts from 0 or 1");
  }

  void positions() const {
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n)
      if (!mesh_.nodes[n].allFinite())
        fail("node " + std::to_string(n) + " has a coordinate that is not a finite number" +
             "; write the mesh again from its source");
  }

  void shapes() const {
    for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
      auto sorted = mesh_.tetrahedra[t];
      std::ranges::sort(sorted);
      const auto twin = std::ranges::adjacent_find(sorted);
      if (twin != sorted.end())
        fail(tetrahedron(t) + " has node " + std::to_string(*twin) +
             " twice; remove it or mesh the body again");
      const double longest = longest_edge(t);
      // A regular tetrahedron has 0.118 of its edge cubed and a bad sliver 1e-4; 1e-9 is flat, but
      // far above the rounding error of 1e-16 of an exactly flat one.
      const double flat = 1e-9 * longest * longest * longest;
      const double volume = geometry::signed_volume(mesh_, static_cast<int>(t));
      if (volume < -flat)
        fail(tetrahedron(t) + " is inside out (volume " + rounded_text(volume) +
             " m^3); swap two of its nodes");
      if (!(volume > flat))
        fail(tetrahedron(t) + " is flat (volume " + rounded_text(volume) + " m^3, longest edge " +
             rounded_text(longest) + " m); mesh the body again with a quality bound");
    }
  }

  void every_node_used() const {
    std::vector<char> used(mesh_.nodes.size(), 0);
    for (const auto& corner : mesh_.tetrahedra)
      for (const int node : corner) used[as_index(node)] = 1;
    const auto unused = std::ranges::find(used, 0);
    if (unused != used.end())
      fail("node " + std::to_string(unused - used.begin()) +
           " belongs to no tetrahedron; remove it and renumber the nodes");
  }

  void faces() const {
    const std::vector<geometry::FaceUse> uses = geometry::face_uses(mesh_);
    for (std::size_t i = 1; i < uses.size(); ++i) {
      if (uses[i].key != uses[i - 1].key) continue;
      if (i > 1 && uses[i].key == uses[i - 2].key)
        fail("face " + listed(uses[i].key) + " belongs to more than two tetrahedra (" +
             std::to_string(uses[i - 2].tetrahedron) + ", " +
             std::to_string(uses[i - 1].tetrahedron) + ", " + std::to_string(uses[i].tetrahedron) +
             "); remove the ones that overlap");
      if (same_side(uses[i - 1], uses[i]))
        fail("tetrahedra " + std::to_string(uses[i - 1].tetrahedron) + " and " +
             std::to_string(uses[i].tetrahedron) + " lie on the same side of face " +
             listed(uses[i].key) + "; remove the one that overlaps");
    }
  }

  void boundary() const {
    const geometry::OuterSurface outer_surface = geometry::outer_surface(mesh_);
    if (const auto refused = geometry::joints(outer_surface.surface).refused)
      fail("parts of its boundary touch at node " +
           std::to_string(outer_surface.nodes[as_index(refused->from)]) +
           "; join the parts that only touch there, or separate them");
  }

  void total(double expected) const {
    const double sum = geometry::volume(mesh_);
    if (std::abs(sum - expected) > 1e-6 * expected)
      fail("the tetrahedra fill " + rounded_text(sum, 8) + " m^3, but the body has " +
           rounded_text(expected, 8) + " m^3; look for overlaps and holes, or for a wrong unit");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw MeshError("mesh `" + name_ + "`: " + what);
  }

  std::string tetrahedron(std::size_t t) const {
    return "tetrahedron " + std::to_string(t) + " " + listed(mesh_.tetrahedra[t]);
  }

  double longest_edge(std::size_t t) const {
    double longest = 0.0;
    for (const int i : mesh_.tetrahedra[t])
      for (const int j : mesh_.tetrahedra[t])
        longest = std::max(longest, (mesh_.nodes[as_index(i)] - mesh_.nodes[as_index(j)]).norm());
    return longest;
  }

  // Two neighbours have their common face's nodes in opposite orders.
  static bool same_side(const geometry::FaceUse& a, const geometry::FaceUse& b) {
    const auto start = std::ranges::find(b.nodes, a.nodes[0]) - b.nodes.begin();
    return b.nodes[as_index(start + 1) % 3] == a.nodes[1];
  }

  const geometry::TetMesh& mesh_;
  const std::string& name_;
};

}  // namespace

void check(const geometry::TetMesh& mesh, const std::string& name, double expected_volume) {
  const Checker checker(mesh, name);
  checker.indices();
  checker.positions();
  checker.shapes();
  checker.every_node_used();
  checker.faces();
  checker.boundary();
  if (expected_volume > 0.0) checker.total(expected_volume);
}

namespace {

struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

}  // namespace

Quality quality(const geometry::TetMesh& mesh) {
  Quality found;
  Extremes angles;
  Extremes volumes;
  Extremes lengths;
  found.smallest_mean_ratio = 1.0;
  found.shortest_altitude = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto at = [&](int local) -> const Vec3& {
      return mesh.nodes[as_index(mesh.tetrahedra[t][as_index(local)])];
    };
    const double volume = geometry::signed_volume(mesh, static_cast<int>(t));
    volumes.add(volume);

    std::array<Vec3, 4> twice_face;  // outward normals with twice the faces' areas as lengths
    for (std::size_t f = 0; f < 4; ++f) {
      const auto& [a, b, c] = geometry::outward_faces[f];
      twice_face[f] = (at(b) - at(a)).cross(at(c) - at(a));
      const double altitude = 6.0 * volume / twice_face[f].norm();
      if (altitude < found.shortest_altitude) {
        found.shortest_altitude = altitude;
        found.limiting_tetrahedron = static_cast<int>(t);
      }
    }

    Extremes edges;
    double squares = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        const Vec3 edge = at(static_cast<int>(j)) - at(static_cast<int>(i));
        edges.add(edge.norm());
        squares += edge.squaredNorm();
        // The faces opposite to i and j meet in the other edge, at pi minus their normals' angle.
        const double angle = std::numbers::pi - angle_between(twice_face[i], twice_face[j]);
        angles.add(angle);
        const auto bins = static_cast<double>(found.angles.size());
        const double bin = std::clamp(angle / std::numbers::pi * bins, 0.0, bins - 1.0);
        ++found.angles[static_cast<std::size_t>(bin)];
      }
    lengths.add(edges.low);
    lengths.add(edges.high);
    found.largest_edge_ratio = std::max(found.largest_edge_ratio, edges.high / edges.low);
    const double root = std::cbrt(3.0 * volume);
    found.smallest_mean_ratio = std::min(found.smallest_mean_ratio, 12.0 * root * root / squares);
  }
  found.smallest_angle = angles.low;
  found.largest_angle = angles.high;
  found.smallest_volume = volumes.low;
  found.largest_volume = volumes.high;
  found.shortest_edge = lengths.low;
  found.longest_edge = lengths.high;
  return found;
}

std::string other_units(double size, const std::string& unit) {
  constexpr double least = 0.005, most = 2.0;  // m
  if (size >= least && size <= most) return "";
  const double as_written = size / metres_per(unit);
  std::string text;
  for (const char* other : {"m", "cm", "mm", "um"}) {
    const double length = as_written * metres_per(other);
    if (other == unit || length < least || length > most) continue;
    text += (text.empty() ? "in `" : ", in `") + std::string(other) + "` " +
            (text.empty() ? "it would be " : "") + rounded_text(length) + " m" +
            (text.empty() ? " long" : "");
  }
  return text;
}

void refuse_size(std::span<const Vec3> places, const std::string& name, const std::string& unit,
                 const std::string& key) {
  constexpr double smallest = 1e-6;  // m: smaller than any cell
  constexpr double largest = 10.0;   // m: larger than any tissue
  if (places.empty()) return;
  for (const Vec3& place : places)
    if (!place.allFinite()) return;  // refused as such
  const double size = geometry::box_of(places).size().maxCoeff();
  if (size >= smallest && size <= largest) return;
  const std::string units = other_units(size, unit);
  throw KeyError(key, name + ": is " + rounded_text(size) + " m long in `" + unit +
                          "`, but wants 1e-6 m to 10 m; check its unit" +
                          (units.empty() ? "" : ": " + units));
}

}  // namespace palpate::meshing
