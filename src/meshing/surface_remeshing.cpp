// Runs CGAL in a child process, checks what it returns, and tries shorter edges until all is well.
#include "meshing/surface_remeshing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/child_process.h"
#include "base/error.h"
#include "base/numerics.h"
#include "geometry/box.h"
#include "geometry/box_tree.h"
#include "meshing/cgal_library.h"
#include "meshing/cgal_repair.h"
#include "meshing/child_bytes.h"
#include "meshing/surface_repair.h"

namespace palpate::meshing {
namespace {

using geometry::Surface;

constexpr ChildLimits remeshing_limits{120.0,
                                       8.0 * 1024 * 1024 * 1024};  // s, bytes: far above any need
constexpr double crease_degrees = 40.0;                            // as for normals and curvatures
constexpr double most_volume = 0.005;                              // relative change
constexpr double needle_altitude = 1.0 / 15.0;                     // altitude over longest edge
constexpr double shorter = 0.75;                                   // the next spacing to try
constexpr double least_growth = 1.5;                               // of triangles by that
constexpr double shorter_there = 0.5;                              // the same of some vertices
constexpr double finer = 1.0 / 8.0;  // edges with which tries begin, of the spacing
constexpr std::size_t fine = 15000;  // triangles with which they begin of needles, about

// A surface that is so many times as far as others serves where none is nearer with at most half of
// the triangles, or a sixth of a large number: noise of a scan as large as the distance took 13 000
// of 34 000.                                                                          decision 434
constexpr double looser = 4.0;
constexpr std::size_t few_of = 2;
constexpr std::size_t few_of_large = 6;

// Even triangles are inscribed in round surfaces; at this part of the spacing that takes a sixth of
// the volume that it would take at the spacing itself.
constexpr double even_part = 0.4;

// At an edge of less than five degrees even triangles of any size are longer than the body is
// thick, and cut each other. Measured on wedges: 10 degrees take two tries, 6 take five, 4 have no
// end. Surfaces with such an edge are meshed as they are, but for large ones, whose triangles
// become shorter where they would cross, and those of many triangles with needles.
constexpr double folded_cosine = -0.9962;  // of the two normals
constexpr std::size_t large = 20000;       // triangles
constexpr std::size_t few = 2000;          // the same

std::string packed(const Surface& surface) {
  std::string bytes;
  append(bytes, surface.vertices);
  append(bytes, surface.triangles);
  return bytes;
}

Surface unpacked_surface(const std::string& bytes) {
  ChildBytes from(bytes, "CGAL");
  Surface surface;
  from.take(surface.vertices);
  from.take(surface.triangles);
  if (!from.done()) from.refuse();
  return surface;
}

double longest_edge(const Surface& surface, const std::array<int, 3>& triangle) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    longest = std::max(longest, (surface.vertices[as_index(triangle[i])] -
                                 surface.vertices[as_index(triangle[(i + 1) % 3])])
                                    .norm());
  return longest;
}

// The largest of the vertices of `from`, and of its triangles' centres and middles of edges, from
// the surface in the tree, m. Adds those that are farther than allowed to `far`, up to `count` of
// them; then it looks no further.
double add_distance(const Surface& from, const geometry::BoxTree& to, double limit,
                    const Nearer& nearer, std::size_t count, std::vector<Vec3>& far) {
  double largest = 0.0;
  const auto look = [&](const Vec3& point) {
    if (far.size() == count) return;
    const double distance = std::sqrt(to.nearest(point).distance_squared);
    largest = std::max(largest, distance);
    const bool near = std::ranges::any_of(
        nearer.places, [&](const Vec3& place) { return (point - place).norm() < nearer.radius; });
    if (distance > (near ? std::min(limit, nearer.distance) : limit)) far.push_back(point);
  };
  for (const Vec3& vertex : from.vertices) look(vertex);
  for (const auto& [a, b, c] : from.triangles) {
    const Vec3& p = from.vertices[as_index(a)];
    const Vec3& q = from.vertices[as_index(b)];
    const Vec3& r = from.vertices[as_index(c)];
    look((p + q + r) / 3.0);
    if (a < b) look(0.5 * (p + q));
    if (b < c) look(0.5 * (q + r));
    if (c < a) look(0.5 * (r + p));
  }
  return largest;
}

// Flat sides of the original stay flat to the last bit: the base of a specimen is known by that.
// Collapsed edges of a rim end a little above or below its plane.
void flatten_sides(const Surface& original, double spacing, Surface& surface) {
  const geometry::Box box = geometry::box_of(original.vertices);
  const double flat = 1e-9 * box.diagonal();
  const double close = 0.05 * spacing;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const double side : {box.low[axis], box.high[axis]}) {
      double area = 0.0;
      for (std::size_t t = 0; t < original.triangles.size(); ++t) {
        const auto& corners = original.triangles[t];
        if (std::all_of(corners.begin(), corners.end(), [&](int vertex) {
              return std::abs(original.vertices[as_index(vertex)][axis] - side) <= flat;
            }))
          area += 0.5 * geometry::twice_area(original, static_cast<int>(t)).norm();
      }
      if (area < spacing * spacing) continue;
      for (Vec3& vertex : surface.vertices)
        if (std::abs(vertex[axis] - side) <= close) vertex[axis] = side;
    }
}

// Edges of about `spacing`, m, at the vertices of `surface`, which is in the tree.
class Attempt {
 public:
  Attempt(const Surface& surface, const geometry::BoxTree& tree, double spacing)
      : surface_(surface), tree_(tree), spacing_(surface.vertices.size(), spacing) {}

  [[nodiscard]] double longest() const { return std::ranges::max(spacing_); }

  // Even triangles that are collapsed, all to the first spacing.
  [[nodiscard]] std::optional<Surface> even() {
    if (!begin()) return std::nullopt;
    return in_child([&] {
      const double edge = spacing_.front();
      const Surface even = cgal_library::even(begun_, even_part * edge, crease_degrees);
      return without_crossings(
          cgal_library::collapsed(even, std::vector(even.vertices.size(), edge)));
    });
  }

  // Even triangles with edges of about `edge`, m.
  [[nodiscard]] static std::optional<Surface> even(const Surface& surface, double edge) {
    return in_child(
        [&] { return without_crossings(cgal_library::even(surface, edge, crease_degrees)); });
  }

  [[nodiscard]] std::optional<Surface> collapsed() {
    if (!begin()) return std::nullopt;
    std::vector<double> spacing;
    for (const std::size_t vertex : nearest_) spacing.push_back(spacing_[vertex]);
    return collapsed(begun_, spacing);
  }

  // Replaces the few triangles of a try that cross.
  [[nodiscard]] static std::optional<Surface> uncrossed(const Surface& surface) {
    return in_child([&] { return cgal_library::uncrossed(surface); });
  }

  void restore(double spacing) { std::ranges::fill(spacing_, spacing); }

  // Takes shorter edges up to one edge from these places, or from others as near to them.
  void shorten(std::span<const Vec3> places) {
    std::vector<char> marks(spacing_.size(), 0);
    std::vector<geometry::Near> found;
    for (const Vec3& place : places) {
      const std::size_t nearest = nearest_vertex(place);
      if (marks[nearest] != 0) continue;
      tree_.within(surface_.vertices[nearest], spacing_[nearest], found);
      for (const geometry::Near& near : found)
        for (const int corner : surface_.triangles[as_index(near.triangle)])
          marks[as_index(corner)] = 1;
    }
    for (std::size_t v = 0; v < spacing_.size(); ++v)
      if (marks[v] != 0) spacing_[v] *= shorter_there;
  }

  void shorten() {
    for (double& edge : spacing_) edge *= shorter;
  }

 private:
  // Edges of a large surface are collapsed once to a finer one, from which all tries begin whose
  // edges are twice as long or more; a smaller one begins as it is.
  [[nodiscard]] bool begin() {
    bool begun = !begun_.triangles.empty();
    for (std::size_t v = 0; begun && v < begun_with_.size(); ++v)
      begun = spacing_[v] >= 2.0 * begun_with_[v];
    if (begun) return true;
    nearest_.clear();
    if (surface_.triangles.size() < large) {
      begun_ = surface_;
      for (std::size_t v = 0; v < surface_.vertices.size(); ++v) nearest_.push_back(v);
      return true;
    }
    begun_with_ = spacing_;
    for (double& edge : begun_with_) edge *= finer;
    auto found = collapsed(surface_, begun_with_);
    if (!found) return false;
    begun_ = std::move(*found);
    for (const Vec3& vertex : begun_.vertices) nearest_.push_back(nearest_vertex(vertex));
    return true;
  }

  // A few that cross are replaced.
  [[nodiscard]] static Surface without_crossings(const Surface& surface) {
    return cgal_library::self_intersections(surface).empty() ? surface
                                                             : cgal_library::uncrossed(surface);
  }

  template <class Make>
  [[nodiscard]] static std::optional<Surface> in_child(const Make& make) {
    const ChildResult result = run_in_child([&] { return packed(make()); }, remeshing_limits);
    if (!result.good()) return std::nullopt;
    Surface made = unpacked_surface(result.output);
    if (made.triangles.empty()) return std::nullopt;
    return made;
  }

  [[nodiscard]] static std::optional<Surface> collapsed(const Surface& from,
                                                        std::span<const double> spacing) {
    return in_child([&] { return cgal_library::collapsed(from, spacing); });
  }

  [[nodiscard]] std::size_t nearest_vertex(const Vec3& place) const {
    const geometry::Near near = tree_.nearest(place);
    Eigen::Index corner = 0;
    near.weights.maxCoeff(&corner);
    return as_index(surface_.triangles[as_index(near.triangle)][static_cast<std::size_t>(corner)]);
  }

  const Surface& surface_;
  const geometry::BoxTree& tree_;
  std::vector<double> spacing_;       // m, per vertex
  Surface begun_;                     // that tries begin with
  std::vector<double> begun_with_;    // m, per vertex of `surface_`, if that is large
  std::vector<std::size_t> nearest_;  // per vertex of `begun_`
};

bool has_sharp_edge(const Surface& surface) {
  const geometry::Neighbours neighbours(surface);
  const auto normal = [&](int t) { return geometry::twice_area(surface, t).normalized(); };
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t)
    for (const int other : neighbours.across(t))
      if (other > t && normal(t).dot(normal(other)) < folded_cosine) return true;
  return false;
}

// Adds the middles of triangles that cross.
void add_crossings(const Surface& surface, std::vector<Vec3>& places) {
  for (const auto& pair : cgal_library::self_intersections(surface))
    for (const int t : pair) {
      Vec3 sum = Vec3::Zero();
      for (const int v : surface.triangles[as_index(t)]) sum += surface.vertices[as_index(v)];
      places.push_back(sum / 3.0);
    }
}

// The edge length (m) of so many even triangles.
double edge_of(const Surface& surface, std::size_t triangles) {
  return std::sqrt(geometry::area(surface) / (0.433 * static_cast<double>(triangles)));
}

bool closed(const Surface& surface) {
  try {
    check_closed(surface, "remeshed");
  } catch (const MeshError&) {
    return false;
  }
  return true;
}

}  // namespace

std::size_t count_needles(const Surface& surface) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const double longest = longest_edge(surface, surface.triangles[t]);
    if (geometry::twice_area(surface, static_cast<int>(t)).norm() <
        needle_altitude * longest * longest)
      ++count;
  }
  return count;
}

double spacing_of(const Surface& surface) { return edge_of(surface, surface.triangles.size()); }

double cell_for(const Surface& surface, int nodes) {
  // Nodes on the surface have 0.866 h^2 each, and nodes inside, half an edge below it, 0.7 h^3.
  const double area = geometry::area(surface);
  const double volume = geometry::enclosed(surface).volume;
  const double most = std::cbrt(volume) + std::sqrt(area);
  const auto excess = [&](double h) {
    const double inside = std::max(0.0, volume - 0.5 * h * area);
    return area / (0.866 * h * h) + inside / (0.7 * h * h * h) - nodes;
  };
  return numerics::root({1e-6 * most, most}, excess).high;
}

double remeshing_limit(const Surface& surface, double spacing) {
  return std::min(0.125 * spacing, 0.005 * geometry::box_of(surface.vertices).diagonal());
}

std::optional<Remeshed> remeshed(const Surface& surface, double spacing, const Nearer& nearer) {
  const std::size_t given = surface.triangles.size();
  const bool sharp = has_sharp_edge(surface);
  const bool uneven = count_needles(surface) > 0 && (!sharp || (given >= few && given < large));
  if (sharp && !uneven && given < large) return std::nullopt;
  const bool at_once = uneven && sharp;  // as far as it may be elsewhere, everywhere
  const double part = at_once ? looser : 1.0;
  const Nearer around = at_once ? Nearer{} : nearer;
  const double limit = remeshing_limit(surface, spacing);
  const double volume = geometry::enclosed(surface).volume;
  const geometry::BoxTree original(surface);
  Attempt attempt(surface, original, spacing);
  std::optional<Surface> first;  // edges of the spacing that was asked for
  bool over = false;             // shorter spacings would have too many triangles
  const auto found_in = [&](Attempt& attempt, int tries, bool by_place, std::size_t most,
                            double farthest) -> std::optional<Remeshed> {
    for (int i = 0; i < tries && !over; ++i) {
      std::vector<Vec3> wrong;
      std::optional<Surface> made = uneven && !by_place ? attempt.even()
                                    : by_place && i == 0 && first
                                        ? std::exchange(first, std::nullopt)
                                        : attempt.collapsed();
      if (made) {
        if (i == 0 && !by_place && !uneven) first = made;
        flatten_sides(surface, attempt.longest(), *made);
        const std::size_t count = made->triangles.size();
        over = count >= most;
        if (over) break;
        double distance = 0.0;
        const auto measure = [&] {
          const std::size_t places = by_place ? SIZE_MAX : 1;
          distance = add_distance(*made, original, farthest, around, places, wrong);
          distance = std::max(distance, add_distance(surface, geometry::BoxTree(*made), farthest,
                                                     around, places, wrong));
        };
        measure();
        if (by_place && wrong.empty() && !cgal_library::self_intersections(*made).empty())
          if (auto mended = Attempt::uncrossed(*made)) {
            made = std::move(mended);
            measure();
          }
        if (by_place) add_crossings(*made, wrong);
        if (wrong.empty() && (by_place || at_once || count_needles(*made) == 0) &&
            std::abs(geometry::enclosed(*made).volume / volume - 1.0) <= part * most_volume &&
            closed(*made))
          return Remeshed{std::move(*made), distance};
        // The next try would take longer than all before.
        over = !by_place && least_growth * static_cast<double>(count) >= static_cast<double>(most);
      }
      if (by_place && !wrong.empty())
        attempt.shorten(wrong);
      else
        attempt.shorten();
    }
    return std::nullopt;
  };
  const auto by_places = [&](const Surface& from) -> std::optional<Remeshed> {
    constexpr int most_tries = 16;
    const geometry::BoxTree tree(from);
    Attempt by_place(from, tree, spacing);
    over = false;
    const std::size_t some = given / (given < large ? few_of : few_of_large);
    if (auto found = found_in(by_place, most_tries, true, some, limit)) return found;
    over = false;
    by_place.restore(spacing);
    return found_in(by_place, most_tries, true, given, looser * limit);
  };
  if (sharp && !uneven) return by_places(surface);
  constexpr int even_tries = 3;
  const std::size_t most = uneven ? std::max(2 * given, few) : given;
  if (auto found = found_in(attempt, even_tries, false, most, part * limit)) return found;
  if (over) return std::nullopt;
  // Below half of what was asked for, a surface with thin limbs has many more triangles than it
  // needs where it has none.
  if (!at_once) {
    if (auto found = by_places(surface)) return found;
    // Long needles stay long where they are collapsed, their even triangles do not.
    if (uneven)
      if (const auto even = Attempt::even(surface, edge_of(surface, fine)))
        if (auto found = by_places(*even)) return found;
  }
  over = false;
  attempt.restore(spacing);
  for (int i = 0; i < even_tries; ++i) attempt.shorten();
  return found_in(attempt, 5, false, most, part * limit);
}

}  // namespace palpate::meshing
