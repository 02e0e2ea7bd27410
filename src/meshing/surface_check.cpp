// The checks, each with its message; later checks rely on earlier ones.
#include "meshing/surface_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "geometry/half_edges.h"
#include "meshing/cgal_library.h"

namespace palpate::meshing {
namespace {

constexpr double smallest = 1e-6;  // m: smaller than any cell
constexpr double largest = 10.0;   // m: larger than any tissue
// In single precision a normal is meaningless below about 1e-7 of the longest edge.
constexpr double needle = 1e-6;

// A guess of the unit for a body of a strange size (m).
std::string unit_guess(double size) {
  constexpr double least = 0.005, most = 2.0;  // m, of what is usually pressed
  for (const auto& [factor, words] :
       {std::pair(1e-3, "`mm` in place of `m`"), std::pair(1e3, "`m` in place of `mm`"),
        std::pair(1e-6, "`um` in place of `m`")})
    if (size * factor >= least && size * factor <= most)
      return "check its unit: with " + std::string(words) + " it would be " +
             rounded_text(size * factor) + " m";
  return "check its unit";
}

class SurfaceChecker {
 public:
  SurfaceChecker(const geometry::Surface& surface, const std::string& name)
      : surface_(surface), name_(name) {}

  void indices() const {
    if (surface_.triangles.empty()) fail("has no faces; export it again");
    const int count = static_cast<int>(surface_.vertices.size());
    for (int f = 0; f < faces(); ++f)
      for (const int v : corners(f))
        if (v < 0 || v >= count)
          fail("face " + std::to_string(f) + " names vertex " + std::to_string(v) +
               ", but the vertices run from 0 to " + std::to_string(count - 1) +
               "; check whether the numbering starts from 0 or 1");
  }

  void positions() const {
    for (std::size_t v = 0; v < surface_.vertices.size(); ++v)
      if (!surface_.vertices[v].allFinite())
        fail("vertex " + std::to_string(v) +
             " has a coordinate that is not a finite number; export the surface again");
    Vec3 low = surface_.vertices.front();
    Vec3 high = low;
    for (const Vec3& vertex : surface_.vertices) {
      low = low.cwiseMin(vertex);
      high = high.cwiseMax(vertex);
    }
    const double size = (high - low).maxCoeff();
    if (!(size >= smallest && size <= largest))
      fail("is " + rounded_text(size) + " m long, but wants 1e-6 m to 10 m; " + unit_guess(size));
  }

  void shapes() const {
    for (int f = 0; f < faces(); ++f) {
      const auto& [a, b, c] = corners(f);
      if (a == b || b == c || c == a)
        fail(face(f) + " has vertex " + std::to_string(a == b ? a : c) +
             " twice; remove it, and close the hole where it leaves one");
    }
    std::vector<std::pair<std::array<int, 3>, int>> sorted;
    for (int f = 0; f < faces(); ++f) {
      std::array<int, 3> key = corners(f);
      std::sort(key.begin(), key.end());
      sorted.emplace_back(key, f);
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 1; i < sorted.size(); ++i)
      if (sorted[i].first == sorted[i - 1].first)
        fail("faces " + std::to_string(sorted[i - 1].second) + " and " +
             std::to_string(sorted[i].second) + " have the same vertices" +
             place(sorted[i].first[0]) + "; remove one of them");
    for (int f = 0; f < faces(); ++f) {
      double longest = 0.0;
      for (std::size_t i = 0; i < 3; ++i)
        longest = std::max(longest, (at(corners(f)[i]) - at(corners(f)[(i + 1) % 3])).norm());
      if (!(geometry::twice_area(surface_, f).norm() > needle * longest * longest))
        fail(face(f) + " has no area: its height is below 1e-6 of its longest edge (" +
             rounded_text(longest * 1e3) +
             " mm); merge its close vertices or swap its longest edge");
    }
    std::vector<char> used(surface_.vertices.size(), 0);
    for (const auto& triangle : surface_.triangles)
      for (const int v : triangle) used[as_index(v)] = 1;
    const auto unused = std::find(used.begin(), used.end(), 0);
    if (unused != used.end())
      fail("vertex " + std::to_string(unused - used.begin()) +
           " belongs to no face; remove it and renumber the vertices");
  }

  // Also fills joints_, which the following checks use.
  void joints() {
    joints_ = geometry::joints(surface_);
    if (!joints_.refused) return;
    const auto& [f, from, to, others] = *joints_.refused;
    const std::string first = std::to_string(others.front());
    if (to < 0)
      fail(face(f) + " touches face " + first + " in vertex " + std::to_string(from) +
           " only; give each side a vertex of its own and move them apart, or join them");
    if (others.size() > 1)
      fail(face(f) + " is a third face at edge " + edge(from, to) + ", after faces " + first +
           " and " + std::to_string(others.back()) +
           "; keep two of them, or separate the surfaces there");
    fail(face(f) + " faces the side opposite to that of face " + first + " across edge " +
         edge(from, to) + "; turn one of them round, so that all normals point outwards");
  }

  void holes() const {
    std::size_t count = 0;
    const geometry::Joints::OpenEdge* first = nullptr;
    const auto key = [](const auto& open) { return std::minmax({open.from, open.to}); };
    for (const auto& hole : joints_.holes)
      for (const auto& open : hole) {
        ++count;
        if (first == nullptr || key(open) < key(*first)) first = &open;
      }
    if (count > 0)
      fail("is open: " + counted(count, "edge") + " in " + counted(joints_.holes.size(), "hole") +
           " belong to one face only, first edge " + edge(first->from, first->to) + " of face " +
           std::to_string(first->triangle) + place(std::min(first->from, first->to)) +
           "; merge vertices in one place and fill the holes");
  }

  void parts() const {
    const std::vector<int>& first = joints_.first_triangles;
    if (first.size() < 2) return;
    const auto box = [&](int part) {
      const Vec3& start = at(corners(first[as_index(part)])[0]);
      std::pair<Vec3, Vec3> found{start, start};
      for (int f = 0; f < faces(); ++f) {
        if (joints_.part[as_index(f)] != part) continue;
        for (const int v : corners(f)) {
          found.first = found.first.cwiseMin(at(v));
          found.second = found.second.cwiseMax(at(v));
        }
      }
      return found;
    };
    const auto [low_a, high_a] = box(0);
    const auto [low_b, high_b] = box(1);
    const auto within = [](const Vec3& low, const Vec3& high, const Vec3& l, const Vec3& h) {
      return (low.array() > l.array()).all() && (high.array() < h.array()).all();
    };
    const char* how = within(low_b, high_b, low_a, high_a)   ? "the second inside the first"
                      : within(low_a, high_a, low_b, high_b) ? "the first inside the second"
                                                             : "beside each other";
    fail("has " + std::to_string(first.size()) + " parts, the first with face 0" +
         place(corners(0)[0]) + ", the second with face " + std::to_string(first[1]) +
         place(corners(first[1])[0]) + ", " + how +
         "; keep one of them, or join them into one surface");
  }

  void right_side_out() const {
    const double volume = geometry::enclosed(surface_).volume;
    if (!(volume > 0.0))
      fail("is inside out (volume " + rounded_text(volume) +
           " m^3); turn all faces round, so that their normals point outwards");
  }

  void crossings() const {
    const auto pair = cgal_library::self_intersection(surface_);
    if (pair)
      fail("faces " + std::to_string((*pair)[0]) + " and " + std::to_string((*pair)[1]) +
           " cut, touch or overlap each other" + place(corners((*pair)[0])[0]) +
           "; remove one of them or move their vertices apart");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw MeshError("surface `" + name_ + "`: " + what);
  }

  [[nodiscard]] int faces() const { return static_cast<int>(surface_.triangles.size()); }
  [[nodiscard]] const std::array<int, 3>& corners(int f) const {
    return surface_.triangles[as_index(f)];
  }
  [[nodiscard]] const Vec3& at(int v) const { return surface_.vertices[as_index(v)]; }

  // In mm, the unit of most surface files.
  [[nodiscard]] std::string place(int v) const {
    const Vec3 p = 1e3 * at(v);
    return " near (" + rounded_text(p.x()) + ", " + rounded_text(p.y()) + ", " +
           rounded_text(p.z()) + ") mm";
  }
  [[nodiscard]] std::string face(int f) const {
    const auto& [a, b, c] = corners(f);
    return "face " + std::to_string(f) + " (" + std::to_string(a) + ", " + std::to_string(b) +
           ", " + std::to_string(c) + ")" + place(a);
  }
  [[nodiscard]] static std::string edge(int from, int to) {
    return "(" + std::to_string(std::min(from, to)) + ", " + std::to_string(std::max(from, to)) +
           ")";
  }
  [[nodiscard]] static std::string counted(std::size_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
  }

  const geometry::Surface& surface_;
  const std::string& name_;
  geometry::Joints joints_;
};

}  // namespace

void check_closed(const geometry::Surface& surface, const std::string& name) {
  SurfaceChecker checker(surface, name);
  checker.indices();
  checker.positions();
  checker.shapes();
  checker.joints();
  checker.holes();
  checker.parts();
  checker.right_side_out();
  checker.crossings();
}

}  // namespace palpate::meshing
