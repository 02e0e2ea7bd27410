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
#include "geometry/half_edges.h"
#include "meshing/cgal_repair.h"
#include "meshing/child_bytes.h"
#include "meshing/surface_check.h"

namespace palpate::meshing {
namespace {

using cgal_library::Mending;

constexpr double most_missing = 0.02;  // of the area, that holes or crossing triangles may have
constexpr double speck = 1e-3;         // of the volume, below which a part is left out
constexpr ChildLimits mending_limits{120.0, 8.0 * 1024 * 1024 * 1024};  // s, bytes

// Vertices within a millionth of the size become one: the rounding of files in single precision.
int join_near(geometry::Surface& surface) {
  Vec3 low = surface.vertices.front();
  Vec3 high = low;
  for (const Vec3& vertex : surface.vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
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
  const auto list = [&](const auto& items) {
    const std::size_t count = items.size();
    append(bytes, &count, 1);
    append(bytes, items.data(), count);
  };
  std::vector<double> coordinates;
  for (const Vec3& vertex : made.surface.vertices)
    coordinates.insert(coordinates.end(), {vertex.x(), vertex.y(), vertex.z()});
  list(coordinates);
  list(made.surface.triangles);
  std::vector<double> holes;
  for (const Mending::Hole& hole : made.holes)
    holes.insert(holes.end(), {hole.place.x(), hole.place.y(), hole.place.z(), hole.around,
                               hole.area, hole.closed ? 1.0 : 0.0});
  list(holes);
  list(std::vector<double>{static_cast<double>(made.doubled), static_cast<double>(made.parted),
                           static_cast<double>(made.fragments), made.area, made.crossing});
  return bytes;
}

Mending unpacked_mending(const std::string& bytes) {
  ChildBytes from(bytes, "CGAL");
  const auto list = [&](auto& items) {
    std::size_t count = 0;
    from.take(&count, 1);
    from.take(items, count);
  };
  Mending made;
  std::vector<double> coordinates, holes, numbers;
  list(coordinates);
  list(made.surface.triangles);
  list(holes);
  list(numbers);
  if (!from.done() || numbers.size() != 5 || coordinates.size() % 3 != 0) from.refuse();
  for (std::size_t i = 0; i < coordinates.size(); i += 3)
    made.surface.vertices.emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
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

std::string near_text(const Vec3& place) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
    text += (axis == 0 ? "" : ", ") + rounded_text(unit::mm.from_si(place[axis]), 3);
  return " near (" + text + ") mm";
}

std::string many(int count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

const Mending::Hole& largest_hole(const Mending& made) {
  return *std::max_element(made.holes.begin(), made.holes.end(),
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
std::vector<geometry::Surface> parts_of(const geometry::Surface& surface) {
  const geometry::Joints joints = geometry::joints(surface);
  std::vector<geometry::Surface> parts(joints.first_triangles.size());
  std::vector<int> number(surface.vertices.size(), -1);
  for (std::size_t t = 0; t < surface.triangles.size() && !joints.refused; ++t) {
    geometry::Surface& part = parts[as_index(joints.part[t])];
    std::array<int, 3> corners = surface.triangles[t];
    for (int& corner : corners) {
      int& own = number[as_index(corner)];
      if (own < 0) {
        own = static_cast<int>(part.vertices.size());
        part.vertices.push_back(surface.vertices[as_index(corner)]);
      }
      corner = own;
    }
    part.triangles.push_back(corners);
  }
  std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) {
    return std::abs(geometry::enclosed(a).volume) > std::abs(geometry::enclosed(b).volume);
  });
  return parts;
}

// Whether the box of one surface lies in that of another.
bool lies_within(const geometry::Surface& inner, const geometry::Surface& outer) {
  const auto box = [](const geometry::Surface& surface) {
    std::pair<Vec3, Vec3> found{surface.vertices.front(), surface.vertices.front()};
    for (const Vec3& vertex : surface.vertices) {
      found.first = found.first.cwiseMin(vertex);
      found.second = found.second.cwiseMax(vertex);
    }
    return found;
  };
  const auto [low, high] = box(inner);
  const auto [lowest, highest] = box(outer);
  return (low.array() > lowest.array()).all() && (high.array() < highest.array()).all();
}

// Leaves one part; tells which others there were.
std::string choose_part(geometry::Surface& surface, const std::string& name,
                        const std::optional<int>& wanted) {
  std::vector<geometry::Surface> parts = parts_of(surface);
  const int count = static_cast<int>(parts.size());
  if (wanted && *wanted > count)
    throw MeshError("surface `" + name + "`: has " + many(count, "part") + ", and `part` is " +
                    std::to_string(*wanted) + "; give one of them");
  if (count < 2) return "";
  const int own = wanted.value_or(1);
  const double volume = std::abs(geometry::enclosed(parts[as_index(own - 1)]).volume);
  int specks = 0;
  std::string others;
  for (int i = 1; i <= count; ++i) {
    if (i == own) continue;
    const geometry::Surface& other = parts[as_index(i - 1)];
    const double share = std::abs(geometry::enclosed(other).volume) / volume;
    if (share < speck) {
      ++specks;
      continue;
    }
    const std::string which = "part " + std::to_string(i);
    if (!wanted && lies_within(other, parts[as_index(own - 1)]))
      throw MeshError(
          "surface `" + name + "`: " + which + near_text(other.vertices.front()) +
          " lies inside part " + std::to_string(own) + ", as a cavity with " + percent_text(share) +
          " of its volume, and hollow bodies from surfaces are not meshed; give `part = " +
          std::to_string(own) + "` to have it filled, or a mesh of tetrahedra");
    others += (others.empty() ? "" : ", ") + which + near_text(other.vertices.front()) + " with " +
              percent_text(share) + " of its volume";
  }
  surface = std::move(parts[as_index(own - 1)]);
  std::string text = "part " + std::to_string(own) + " of " + std::to_string(count) + " is taken";
  if (!others.empty()) text += ", without " + others;
  if (specks > 0) text += ", and " + many(specks, "speck") + " left out";
  return text;
}

}  // namespace

WholeSurface whole_surface(geometry::Surface surface, const std::string& name,
                           const RepairOrder& order) {
  std::string fault;
  try {
    check_closed(surface, name);
    if (order.part.value_or(1) > 1) (void)choose_part(surface, name, order.part);
    return {std::move(surface), ""};
  } catch (const MeshError& error) {
    if (!order.repair || surface.vertices.empty() || surface.triangles.empty()) throw;
    fault = error.what();
  }
  for (const Vec3& vertex : surface.vertices)
    if (!vertex.allFinite()) throw MeshError(fault);
  WholeSurface whole;
  const int joined = join_near(surface);
  const ChildResult result =
      run_in_child([&] { return packed_mending(cgal_library::mended(surface)); }, mending_limits);
  const auto give_up = [&] { throw MeshError(fault + " (it could not be repaired by itself)"); };
  if (!result.good()) give_up();
  Mending made = unpacked_mending(result.output);
  if (made.surface.triangles.empty() || !(made.area > 0.0)) give_up();
  if (!made.holes.empty() && missing(made) > most_missing * made.area) {
    const Mending::Hole& hole = largest_hole(made);
    throw MeshError(
        "surface `" + name + "`: is open: " + many(static_cast<int>(made.holes.size()), "hole") +
        " would need " + percent_text(missing(made) / made.area) + " of its area, the largest is " +
        rounded_text(unit::mm.from_si(hole.around), 3) + " mm around" + near_text(hole.place) +
        ", and up to 2 % are closed by themselves; close it "
        "in the program it comes from");
  }
  if (made.crossing > most_missing * made.area)
    throw MeshError(fault + " (triangles with " + percent_text(made.crossing / made.area) +
                    " of the area cut others, and up to 2 % are replaced by themselves)");
  whole.surface = std::move(made.surface);
  const std::string taken = choose_part(whole.surface, name, order.part);
  try {
    check_closed(whole.surface, name);
  } catch (const MeshError& error) {
    throw MeshError(fault + (error.what() == fault ? "" : " (it could not be repaired by itself)"));
  }
  const std::string changed = changes(made, joined);
  whole.remark = "the surface of " + name + " was mended: " +
                 (changed.empty() && taken.empty() ? "all triangles turned outwards" : changed) +
                 (changed.empty() || taken.empty() ? "" : "; ") + taken;
  return whole;
}

}  // namespace palpate::meshing
