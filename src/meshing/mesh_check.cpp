// The checks, each with its message; later checks rely on earlier ones.
#include "meshing/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/text.h"
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
      std::sort(sorted.begin(), sorted.end());
      const auto twin = std::adjacent_find(sorted.begin(), sorted.end());
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
    const auto unused = std::find(used.begin(), used.end(), 0);
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
    const geometry::Skin skin = geometry::skin(mesh_);
    if (const auto refused = geometry::joints(skin.surface).refused)
      fail("parts of its boundary touch at node " +
           std::to_string(skin.nodes[as_index(refused->from)]) +
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
    const auto start = std::find(b.nodes.begin(), b.nodes.end(), a.nodes[0]) - b.nodes.begin();
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

}  // namespace palpate::meshing
