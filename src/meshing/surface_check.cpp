// The checks, each with its message; later checks rely on earlier ones.
#include "meshing/surface_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "meshing/cgal_library.h"

namespace palpate::meshing {
namespace {

constexpr double smallest = 1e-6;  // m: smaller than any cell
constexpr double largest = 10.0;   // m: larger than any tissue
// In single precision a normal is meaningless below about 1e-7 of the longest edge.
constexpr double needle = 1e-6;

// An edge of one face.
struct Side {
  int low, high, face;
  bool upwards;  // the face runs from low to high

  [[nodiscard]] bool same_edge(const Side& other) const {
    return low == other.low && high == other.high;
  }
};

// Disjoint sets (union-find); the lowest member identifies a set.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int of(int item) {
    while (parent(item) != item) item = parent(item) = parent(parent(item));
    return item;
  }
  void join(int a, int b) {
    const int root_a = of(a);
    const int root_b = of(b);
    parent(std::max(root_a, root_b)) = std::min(root_a, root_b);
  }

 private:
  int& parent(int item) { return parent_[as_index(item)]; }
  std::vector<int> parent_;
};

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
      fail("is " + rounded_text(size) + " m long, but wants 1e-6 m to 10 m; check its unit");
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

  // Also fills sides_, which the following checks use.
  void edges() {
    for (int f = 0; f < faces(); ++f)
      for (std::size_t i = 0; i < 3; ++i) {
        const int from = corners(f)[i];
        const int to = corners(f)[(i + 1) % 3];
        sides_.push_back({std::min(from, to), std::max(from, to), f, from < to});
      }
    std::stable_sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
      return std::pair(a.low, a.high) < std::pair(b.low, b.high);
    });
    for (std::size_t first = 0, last = 0; first < sides_.size(); first = last) {
      std::string users;
      for (; last < sides_.size() && sides_[last].same_edge(sides_[first]); ++last)
        users += (users.empty() ? "" : ", ") + std::to_string(sides_[last].face);
      if (last - first > 2)
        fail(edge(sides_[first]) + " has " + std::to_string(last - first) + " faces (" + users +
             ")" + place(sides_[first].low) + "; keep two of them, or separate the surfaces there");
    }
    for (std::size_t i = 1; i < sides_.size(); ++i)
      if (sides_[i].same_edge(sides_[i - 1]) && sides_[i].upwards == sides_[i - 1].upwards)
        fail("faces " + std::to_string(sides_[i - 1].face) + " and " +
             std::to_string(sides_[i].face) + " face opposite sides across " + edge(sides_[i]) +
             place(sides_[i].low) + "; turn one of them round, so that all normals point outwards");
  }

  void holes() const {
    Groups rims(surface_.vertices.size());
    std::vector<Side> open;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const bool shared = (i > 0 && sides_[i].same_edge(sides_[i - 1])) ||
                          (i + 1 < sides_.size() && sides_[i].same_edge(sides_[i + 1]));
      if (shared) continue;
      open.push_back(sides_[i]);
      rims.join(sides_[i].low, sides_[i].high);
    }
    if (open.empty()) return;
    std::vector<int> names;  // of the holes
    for (const Side& side : open) names.push_back(rims.of(side.low));
    std::sort(names.begin(), names.end());
    const auto holes = std::unique(names.begin(), names.end()) - names.begin();
    fail("is open: " + counted(open.size(), "edge") + " in " + counted(as_index(holes), "hole") +
         " belong to one face only, first " + edge(open.front()) + " of face " +
         std::to_string(open.front().face) + place(open.front().low) +
         "; merge vertices in one place and fill the holes");
  }

  void parts() const {
    Groups groups(surface_.vertices.size());
    for (const auto& [a, b, c] : surface_.triangles) {
      groups.join(a, b);
      groups.join(b, c);
    }
    std::vector<int> roots;  // of the parts, in the order of their first faces
    std::vector<char> seen(surface_.vertices.size(), 0);
    int first_of_second = 0;
    for (int f = 0; f < faces(); ++f) {
      const int root = groups.of(corners(f)[0]);
      if (std::exchange(seen[as_index(root)], 1) != 0) continue;
      roots.push_back(root);
      if (roots.size() == 2) first_of_second = f;
    }
    if (roots.size() < 2) return;
    const auto box = [&](int root) {
      std::pair<Vec3, Vec3> found{at(root), at(root)};
      for (std::size_t v = 0; v < surface_.vertices.size(); ++v) {
        if (groups.of(static_cast<int>(v)) != root) continue;
        found.first = found.first.cwiseMin(surface_.vertices[v]);
        found.second = found.second.cwiseMax(surface_.vertices[v]);
      }
      return found;
    };
    const auto [low_a, high_a] = box(roots[0]);
    const auto [low_b, high_b] = box(roots[1]);
    const auto within = [](const Vec3& low, const Vec3& high, const Vec3& l, const Vec3& h) {
      return (low.array() > l.array()).all() && (high.array() < h.array()).all();
    };
    const char* how = within(low_b, high_b, low_a, high_a)   ? "the second inside the first"
                      : within(low_a, high_a, low_b, high_b) ? "the first inside the second"
                                                             : "beside each other";
    fail("has " + std::to_string(roots.size()) + " parts, the first with face 0" +
         place(corners(0)[0]) + ", the second with face " + std::to_string(first_of_second) +
         place(corners(first_of_second)[0]) + ", " + how +
         "; keep one of them, or join them into one surface");
  }

  // The faces around a vertex must form a single fan, closed or ending at a hole.
  void fans() const {
    std::vector<std::vector<int>> around(surface_.vertices.size());
    for (int f = 0; f < faces(); ++f)
      for (const int v : corners(f)) around[as_index(v)].push_back(f);
    for (std::size_t v = 0; v < around.size(); ++v) {
      // Faces of a fan share their other vertices: sort by these and join.
      const std::vector<int>& fan = around[v];
      std::vector<std::pair<int, int>> spokes;  // the other vertex, the face's index in `fan`
      for (std::size_t i = 0; i < fan.size(); ++i)
        for (const int other : corners(fan[i]))
          if (other != static_cast<int>(v)) spokes.emplace_back(other, static_cast<int>(i));
      std::sort(spokes.begin(), spokes.end());
      Groups groups(fan.size());
      for (std::size_t i = 1; i < spokes.size(); ++i)
        if (spokes[i].first == spokes[i - 1].first)
          groups.join(spokes[i].second, spokes[i - 1].second);
      for (std::size_t i = 1; i < fan.size(); ++i)
        if (groups.of(static_cast<int>(i)) != 0)
          fail("faces " + std::to_string(fan[0]) + " and " + std::to_string(fan[i]) +
               " touch in vertex " + std::to_string(v) + " only" + place(static_cast<int>(v)) +
               "; give each side a vertex of its own and move them apart, or join them");
    }
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
  [[nodiscard]] static std::string edge(const Side& side) {
    return "edge (" + std::to_string(side.low) + ", " + std::to_string(side.high) + ")";
  }
  [[nodiscard]] static std::string counted(std::size_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
  }

  const geometry::Surface& surface_;
  const std::string& name_;
  std::vector<Side> sides_;  // sorted by edge and then by face
};

}  // namespace

void check_closed(const geometry::Surface& surface, const std::string& name) {
  SurfaceChecker checker(surface, name);
  checker.indices();
  checker.positions();
  checker.shapes();
  checker.edges();
  checker.holes();
  checker.parts();
  checker.fans();
  checker.right_side_out();
  checker.crossings();
}

}  // namespace palpate::meshing
