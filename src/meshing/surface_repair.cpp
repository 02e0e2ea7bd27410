// Runs CGAL in a child process, chooses the part, and tells what was changed.
#include "meshing/surface_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "base/child_process.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "base/vec3.h"
#include "geometry/body.h"
#include "geometry/box.h"
#include "geometry/box_tree.h"
#include "geometry/half_edges.h"
#include "meshing/cgal_library.h"
#include "meshing/cgal_repair.h"
#include "meshing/child_bytes.h"
#include "meshing/mesh_check.h"

namespace palpate::meshing {
namespace {

// In single precision a normal is meaningless below about 1e-7 of the longest edge.
constexpr double needle = 1e-6;

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
      std::ranges::sort(key);
      sorted.emplace_back(key, f);
    }
    std::ranges::sort(sorted);
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
    const auto unused = std::ranges::find(used, 0);
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

  // All parts but the largest are cavities in it, and face inwards.
  void parts() const {
    const std::vector<geometry::SurfacePart> parts = geometry::parts_of(surface_);
    std::vector<double> volumes;
    for (const auto& part : parts) volumes.push_back(geometry::enclosed(part.surface).volume);
    const auto outer = std::ranges::max_element(volumes) - volumes.begin();
    for (int p = 0; p < static_cast<int>(parts.size()); ++p) {
      if (p == outer) continue;
      geometry::Surface others{surface_.vertices, {}};
      for (int f = 0; f < faces(); ++f)
        if (joints_.part[as_index(f)] != p) others.triangles.push_back(corners(f));
      const int face = parts[as_index(p)].triangles.front();
      const int start = corners(face)[0];
      const bool within = geometry::encloses(others, at(start));
      if (within && volumes[as_index(p)] < 0.0) continue;
      fail("has " + std::to_string(parts.size()) + " parts, and the one with face " +
           std::to_string(face) + place(start) +
           (within ? " lies inside the others and faces outwards; turn its faces round if it is a "
                     "cavity, or remove it"
                   : " lies beside the others; keep one of them, or join them into one surface"));
    }
  }

  void right_side_out() const {
    const double volume = geometry::enclosed(surface_).volume;
    if (!(volume > 0.0))
      fail("is inside out (volume " + rounded_text(volume) +
           " m^3); turn all faces round, so that their normals point outwards");
  }

  void crossings() const {
    const auto pairs = cgal_library::self_intersections(surface_);
    if (!pairs.empty())
      fail("faces " + std::to_string(pairs.front()[0]) + " and " +
           std::to_string(pairs.front()[1]) + " cut, touch or overlap each other" +
           place(corners(pairs.front()[0])[0]) +
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
  checker.right_side_out();
  checker.parts();
  checker.crossings();
}

namespace {

using cgal_library::Mending;

constexpr double speck = 1e-3;  // of the volume, below which a part is excluded
constexpr ChildLimits mending_limits{120.0, 8.0 * 1024 * 1024 * 1024};  // s, bytes

// Vertices within a millionth of the size become one: the rounding of files in single precision.
int join_near(geometry::Surface& surface) {
  const auto [low, high] = geometry::box_of(surface.vertices);
  const double near = 1e-6 * (high - low).norm();
  if (!(near > 0.0)) return 0;
  using Key = std::array<long, 3>;
  std::map<Key, std::vector<int>> cells;
  std::vector<int> first(surface.vertices.size());
  int joined = 0;
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    const Vec3& place = surface.vertices[v];
    Key key{};
    for (int axis = 0; axis < 3; ++axis)
      key[as_index(axis)] = static_cast<long>(std::floor((place[axis] - low[axis]) / near));
    int found = -1;
    for (int k = 0; k < 27 && found < 0; ++k) {
      const auto known =
          cells.find({key[0] + k % 3 - 1, key[1] + k / 3 % 3 - 1, key[2] + k / 9 - 1});
      if (known == cells.end()) continue;
      for (const int other : known->second)
        if (found < 0 && (surface.vertices[as_index(other)] - place).norm() <= near) found = other;
    }
    if (found >= 0) ++joined;
    first[v] = found >= 0 ? found : static_cast<int>(v);
    if (found < 0) cells[key].push_back(static_cast<int>(v));
  }
  for (auto& triangle : surface.triangles)
    for (int& corner : triangle) corner = first[as_index(corner)];
  return joined;
}

std::string packed_mending(const Mending& made) {
  std::string bytes;
  append(bytes, made.surface.vertices);
  append(bytes, made.surface.triangles);
  std::vector<double> holes;
  for (const Mending::Hole& hole : made.holes)
    holes.insert(holes.end(), {hole.place.x(), hole.place.y(), hole.place.z(), hole.around,
                               hole.area, hole.closed ? 1.0 : 0.0});
  append(bytes, holes);
  append(bytes,
         std::vector<double>{static_cast<double>(made.doubled), static_cast<double>(made.parted),
                             static_cast<double>(made.fragments), made.area, made.crossing});
  return bytes;
}

Mending unpacked_mending(const std::string& bytes) {
  ChildBytes from(bytes, "CGAL");
  Mending made;
  std::vector<double> holes, numbers;
  from.take(made.surface.vertices);
  from.take(made.surface.triangles);
  from.take(holes);
  from.take(numbers);
  if (!from.done() || numbers.size() != 5) from.refuse();
  for (std::size_t i = 0; i + 5 < holes.size(); i += 6)
    made.holes.push_back(
        {{holes[i], holes[i + 1], holes[i + 2]}, holes[i + 3], holes[i + 4], holes[i + 5] != 0.0});
  made.doubled = static_cast<int>(numbers[0]);
  made.parted = static_cast<int>(numbers[1]);
  made.fragments = static_cast<int>(numbers[2]);
  made.area = numbers[3];
  made.crossing = numbers[4];
  return made;
}

std::string near_text(const Vec3& place) { return " near " + vector_text(place / 1e-3, 3) + " mm"; }

std::string many(int count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

const Mending::Hole& largest_hole(const Mending& made) {
  return *std::ranges::max_element(made.holes,
                                   [](const auto& a, const auto& b) { return a.area < b.area; });
}

double missing(const Mending& made) {
  return std::accumulate(made.holes.begin(), made.holes.end(), 0.0,
                         [](double sum, const auto& hole) { return sum + hole.area; });
}

// What was changed, as a list; empty if nothing was.
std::string changes(const Mending& made, int joined) {
  std::string text;
  const auto add = [&](bool any, const std::string& what) {
    if (any) text += (text.empty() ? "" : ", ") + what;
  };
  add(joined > 0, many(joined, "vertex") + " joined to another in the same place");
  add(made.doubled > 0, many(made.doubled, "doubled or flat triangle") + " removed");
  add(made.parted > 0, many(made.parted, "shared vertex") + " parted");
  add(made.fragments > 0, many(made.fragments, "loose piece") + " removed");
  if (!made.holes.empty()) {
    const Mending::Hole& hole = largest_hole(made);
    add(true, many(static_cast<int>(made.holes.size()), "hole") + " closed with " +
                  percent_text(missing(made) / made.area) + " of the area, the largest " +
                  rounded_text(unit::mm.from_si(hole.around), 3) + " mm around" +
                  near_text(hole.place));
  }
  add(made.crossing > 0.0, "triangles that cut each other replaced, " +
                               percent_text(made.crossing / made.area) + " of the area");
  for (std::size_t at = 0; (at = text.find("vertexs", at)) != std::string::npos;)
    text.replace(at, 7, "vertices");
  return text;
}

// The connected parts by falling volume.
std::vector<geometry::Surface> by_volume(const geometry::Surface& surface) {
  std::vector<geometry::Surface> parts;
  for (geometry::SurfacePart& part : geometry::parts_of(surface))
    parts.push_back(std::move(part.surface));
  std::ranges::stable_sort(parts, [](const auto& a, const auto& b) {
    return std::abs(geometry::enclosed(a).volume) > std::abs(geometry::enclosed(b).volume);
  });
  return parts;
}

void add_part(geometry::Surface& surface, const geometry::Surface& part, bool turned) {
  const int before = static_cast<int>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (std::array<int, 3> triangle : part.triangles) {
    for (int& corner : triangle) corner += before;
    if (turned) std::swap(triangle[1], triangle[2]);
    surface.triangles.push_back(triangle);
  }
}

// Whether a triangle before the first of the second part cuts or touches one of that part.
bool cut_each_other(const geometry::Surface& both, std::size_t second) {
  return std::ranges::any_of(cgal_library::self_intersections(both), [&](const auto& pair) {
    return as_index(pair[0]) < second && as_index(pair[1]) >= second;
  });
}

// The part that is nearest to a place, without specks and where a larger part is not around it.
int nearest_part(const std::vector<geometry::Surface>& parts, const Vec3& place) {
  const double largest = std::abs(geometry::enclosed(parts.front()).volume);
  geometry::Surface outer;
  double least = HUGE_VAL;
  int found = 1;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double volume = geometry::enclosed(parts[i]).volume;
    if (std::abs(volume) < speck * largest) break;
    const geometry::Near near = geometry::BoxTree(parts[i]).nearest(place);
    const auto& corners = parts[i].triangles[as_index(near.triangle)];
    Vec3 there = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      there += near.weights[k] * parts[i].vertices[as_index(corners[as_index(k)])];
    if (near.distance_squared < least && !geometry::encloses(outer, there)) {
      least = near.distance_squared;
      found = static_cast<int>(i) + 1;
    }
    add_part(outer, parts[i], volume < 0.0);
  }
  return found;
}

// "8 % of its volume", or "150 times its volume"
std::string volume_text(double share) {
  return (share < 10.0 ? percent_text(share) + " of" : rounded_text(share, 2) + " times") +
         " its volume";
}

// Leaves one part and, where none is asked for, the cavities in it; tells what there was besides.
std::string choose_part(geometry::Surface& surface, const std::string& name,
                        const RepairOrder& order, std::string& part) {
  const std::optional<int>& wanted = order.part;
  std::vector<geometry::Surface> parts = by_volume(surface);
  const int count = static_cast<int>(parts.size());
  if (wanted && *wanted > count)
    throw MeshError("surface `" + name + "`: has " + many(count, "part") + ", and `part` is " +
                    std::to_string(*wanted) + "; give one of them");
  if (count < 2) return "";
  const int own = wanted              ? *wanted
                  : order.nearest > 0 ? order.nearest
                  : order.pressed     ? nearest_part(parts, *order.pressed)
                                      : 1;
  std::vector<double> volumes;
  for (const geometry::Surface& one : parts) volumes.push_back(geometry::enclosed(one).volume);
  geometry::Surface taken;
  add_part(taken, parts[as_index(own - 1)], volumes[as_index(own - 1)] < 0.0);
  constexpr int most_named = 3;
  int specks = 0, hollows = 0, beside = 0;
  bool touching = false;
  std::string others, cavities;
  for (int i = 1; i <= count; ++i) {
    if (i == own) continue;
    const geometry::Surface& other = parts[as_index(i - 1)];
    const double share = std::abs(volumes[as_index(i - 1)] / volumes[as_index(own - 1)]);
    if (share < speck) {
      ++specks;
      continue;
    }
    // The parts go by falling volume, so that a cavity comes before what lies in it.
    geometry::Surface both = taken;
    add_part(both, other, volumes[as_index(i - 1)] > 0.0);
    const bool cuts = cut_each_other(both, taken.triangles.size());
    const bool cavity = !wanted && !cuts && geometry::encloses(taken, other.vertices.front());
    if (cavity) {
      taken = std::move(both);
      ++hollows;
    }
    if (!cavity && ++beside > most_named) continue;
    std::string& list = cavity ? cavities : others;
    list += (list.empty() ? "" : ", ") + std::string("part ") + std::to_string(i) +
            near_text(geometry::enclosed(other).centroid) + " with " + volume_text(share) +
            (cuts ? ", which cuts or touches it" : "");
    touching = touching || cuts;
  }
  surface = std::move(taken);
  const std::string number = "part " + std::to_string(own) + " of " + std::to_string(count);
  if (beside > 0) part = number;
  const bool near = (order.pressed || order.nearest > 0) && !wanted;
  std::string text = number + " is taken" + (near ? ", the nearest to the finger" : "");
  if (hollows > 0)
    text +=
        std::string(", with ") + (hollows == 1 ? "a cavity" : "cavities") + " in it: " + cavities;
  if (!others.empty()) text += ", without " + others;
  if (beside > most_named) text += ", and " + many(beside - most_named, "smaller part");
  if (specks > 0) text += ", and " + many(specks, "speck") + " excluded";
  if (touching) text += "; join what cuts or touches it to one surface if both are the body";
  return text;
}

}  // namespace

MendedSurface mended_surface(geometry::Surface surface, const std::string& name,
                             const RepairOrder& order) {
  refuse_size(surface.vertices, "surface `" + name + "`", order.unit, "tissue.shape.unit");
  std::string fault;
  try {
    check_closed(surface, name);
    return {.surface = std::move(surface), .sound = true};
  } catch (const MeshError& error) {
    if (!order.repair || surface.vertices.empty() || surface.triangles.empty()) throw;
    fault = error.what();
  }
  for (const Vec3& vertex : surface.vertices)
    if (!vertex.allFinite()) throw MeshError(fault);
  const auto [low, high] = geometry::box_of(surface.vertices);
  for (int axis = 0; axis < 3; ++axis)
    if (low[axis] == high[axis])
      throw MeshError("surface `" + name + "`: is a flat sheet: all its vertices have the same " +
                      "xyz"[axis] + "; give the whole surface of a body, around its inside");
  const int joined = join_near(surface);
  const ChildResult result =
      run_in_child([&] { return packed_mending(cgal_library::mended(surface)); }, mending_limits);
  const auto give_up = [&] { throw MeshError(fault + " (it could not be repaired by itself)"); };
  if (!result.good()) give_up();
  Mending made = unpacked_mending(result.output);
  if (made.surface.triangles.empty() || !(made.area > 0.0)) give_up();
  const auto more = [&](double part) {
    constexpr double limit = 0.5;  // of `repair_up_to`
    const double needed = std::ceil(100.0 * part) / 100.0;
    return ", and up to " + percent_text(order.most_missing) +
           (needed <= limit ? " are mended by themselves; set `repair_up_to = " +
                                  rounded_text(needed) + "` of `tissue.shape` (`--repair-up-to " +
                                  rounded_text(needed) + "` of `palpate convert`), or mend it"
                            : " are mended by themselves; mend it") +
           " in the program it comes from";
  };
  if (!made.holes.empty() && missing(made) > order.most_missing * made.area) {
    const Mending::Hole& hole = largest_hole(made);
    throw MeshError(
        "surface `" + name + "`: is open: " + many(static_cast<int>(made.holes.size()), "hole") +
        " would need " + percent_text(missing(made) / made.area) + " of its area, the largest is " +
        rounded_text(unit::mm.from_si(hole.around), 3) + " mm around" + near_text(hole.place) +
        more(missing(made) / made.area));
  }
  if (made.crossing > order.most_missing * made.area)
    throw MeshError("surface `" + name + "`: triangles with " +
                    percent_text(made.crossing / made.area) +
                    " of its area cut others of the same part" + more(made.crossing / made.area));
  return {.surface = std::move(made.surface),
          .sound = false,
          .changes = changes(made, joined),
          .fault = fault};
}

int near_part(const MendedSurface& mended, const Vec3& place) {
  const std::vector<geometry::Surface> parts = by_volume(mended.surface);
  return parts.size() < 2 ? 0 : nearest_part(parts, place);
}

WholeSurface whole_part(const MendedSurface& mended, const std::string& name,
                        const RepairOrder& order) {
  WholeSurface whole{.surface = mended.surface, .warning = {}};
  const std::string taken = choose_part(whole.surface, name, order, whole.part);
  if (mended.sound) {
    if (!taken.empty()) whole.warning = "of the surface " + name + ", " + taken;
    return whole;
  }
  const std::string& fault = mended.fault;
  try {
    check_closed(whole.surface, name);
  } catch (const MeshError& error) {
    throw MeshError(fault + (error.what() == fault ? "" : " (it could not be repaired by itself)"));
  }
  const std::string& changed = mended.changes;
  whole.warning = "the surface of " + name + " was mended: " +
                  (changed.empty() && taken.empty() ? "all triangles turned outwards" : changed) +
                  (changed.empty() || taken.empty() ? "" : "; ") + taken;
  return whole;
}

WholeSurface whole_surface(geometry::Surface surface, const std::string& name,
                           const RepairOrder& order) {
  return whole_part(mended_surface(std::move(surface), name, order), name, order);
}

}  // namespace palpate::meshing
