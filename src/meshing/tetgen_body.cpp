// Searches for the surface sampling and the cell volume that give the requested counts.
#include "meshing/tetgen_body.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <limits>
#include <optional>
#include <utility>

#include "base/numerics.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "base/units.h"
#include "geometry/cuboid.h"
#include "meshing/mesh_check.h"
#include "meshing/surface_remeshing.h"
#include "meshing/tetgen.h"

namespace palpate::meshing {
namespace {

using Triple = std::array<int, 3>;

constexpr double good_grid_miss = 0.01;   // stop trying
constexpr double fair_grid_miss = 0.03;   // keep this grid
constexpr double worst_grid_miss = 0.25;  // refuse beyond
constexpr int tries_per_grid = 8;
// A maximum volume of 0.22 h^3 gives edges inside of about the mean of the grid's edges h and
// sqrt(2) h; the body then has about 1.1 times the nodes of a structured mesh with cells of side h.
constexpr double grid_volume_per_cube = 0.22;
constexpr double nodes_per_lattice = 1.1;

// The spacing h (m) for `target` nodes, whose number decreases with h.
double spacing_for(const Vec3& size, int target) {
  const auto excess = [&](double h) {
    return nodes_per_lattice * (size.x() / h + 1.0) * (size.y() / h + 1.0) * (size.z() / h + 1.0) -
           target;
  };
  return numerics::root({size.minCoeff() / (target + 1.0), 2.0 * size.maxCoeff()}, excess).middle();
}

Triple cells_for(const Vec3& size, double spacing) {
  Triple cells;
  for (int axis = 0; axis < 3; ++axis)
    cells[as_index(axis)] = std::max(1, static_cast<int>(std::lround(size[axis] / spacing)));
  return cells;
}

// Tries meshes and keeps the one with the number of nodes nearest to the target.
class GridSearch {
 public:
  GridSearch(const Vec3& size, int target, double time_limit)
      : size_(size), target_(target), time_limit_(time_limit) {}

  [[nodiscard]] double miss() const { return miss_; }
  [[nodiscard]] geometry::TetMesh& best() { return best_; }

  // Up to tries_per_grid meshes on the grid of this spacing (m).
  void on_grid(double spacing) {
    const geometry::Surface surface = geometry::box_surface(size_, cells_for(size_, spacing));
    const int on_surface = static_cast<int>(surface.vertices.size());
    const double wanted = std::max(target_ - on_surface, 0);
    const double cube = spacing * spacing * spacing;
    double volume = grid_volume_per_cube * cube;
    double low = 1e-3 * cube;  // gives too many nodes, or was not tried
    double high = 1e3 * cube;  // gives too few nodes, or was not tried
    for (int tries = 0; tries < tries_per_grid && miss_ > good_grid_miss; ++tries) {
      const int inside = attempt(surface, volume) - on_surface;
      (inside > wanted ? low : high) = volume;
      // The nodes inside are about proportional to 1 / volume; the bracket limits the estimate.
      const double guess = volume * (inside + 0.5) / (wanted + 0.5);
      volume = guess > low && guess < high ? guess : std::sqrt(low * high);
    }
  }

 private:
  // The time limit decides only whether there is a result, not which.
  int attempt(const geometry::Surface& surface, double volume) {
    const double spent = watch_.seconds();
    if (spent >= time_limit_)
      throw MeshError("no mesh with about " + std::to_string(target_) + " nodes was found within " +
                      rounded_text(time_limit_) + " s; ask for fewer nodes or allow more time");
    geometry::TetMesh mesh =
        tetgen_surface(surface, "pYq1.414a" + number_text(volume), time_limit_ - spent);
    const int count = static_cast<int>(mesh.nodes.size());
    const double miss = std::abs(count - target_) / static_cast<double>(target_);
    if (miss < miss_) {
      miss_ = miss;
      best_ = std::move(mesh);
    }
    return count;
  }

  Vec3 size_;  // m
  int target_;
  double time_limit_;  // s
  Stopwatch watch_;
  double miss_ = HUGE_VAL;
  geometry::TetMesh best_;
};

}  // namespace

geometry::TetMesh tetgen_cuboid(const Vec3& size, int target_nodes, double time_limit) {
  if (target_nodes < 8)
    throw MeshError("a box cannot be meshed with " + std::to_string(target_nodes) +
                    " nodes, as it has 8 corners; ask for 8 nodes or more");
  const double spacing = spacing_for(size, target_nodes);
  GridSearch search(size, target_nodes, time_limit);
  // With few nodes the grid determines the count; coarser and finer grids may then fit better.
  for (const double factor : {1.0, 1.12, 0.89, 1.25, 0.8}) {
    search.on_grid(factor * spacing);
    if (search.miss() <= fair_grid_miss) break;
  }
  if (search.miss() > worst_grid_miss)
    throw MeshError("no box mesh near " + std::to_string(target_nodes) +
                    " nodes was found, the nearest has " +
                    std::to_string(search.best().nodes.size()) + "; ask for that many or more");
  check(search.best(), "box by TetGen", size.x() * size.y() * size.z());
  return std::move(search.best());
}

namespace {

constexpr double good_miss = 0.01;   // stop trying
constexpr double fair_miss = 0.03;   // keep this kind of surface
constexpr double worst_miss = 0.25;  // refuse beyond
constexpr int tries_per_body = 8;
// A maximum volume of 0.127 h^3 gives edges of about h; a regular tetrahedron has 0.118 h^3.
constexpr double volume_per_cube = 0.127;
// `A` numbers the regions. The optimisation `o/140O5` halves the number of flat tetrahedra, which
// makes the shortest altitude, and thus the stable step, about twice as long.
constexpr const char* switches = "pAq1.414o/140O5";

double volume_at(double edge_length) {
  return volume_per_cube * edge_length * edge_length * edge_length;
}

double mean_edge(const geometry::Surface& surface) {
  double sum = 0.0;
  for (const auto& triangle : surface.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      sum += (surface.vertices[as_index(triangle[i])] -
              surface.vertices[as_index(triangle[(i + 1) % 3])])
                 .norm();
  return sum / (3.0 * static_cast<double>(surface.triangles.size()));
}

// Replaces TetGen's region numbers by those of the body.
void name_regions(const geometry::Body& body, geometry::TetMesh& mesh) {
  meshing::name_regions(mesh, [&](const Vec3& place) {
    const std::optional<int> found = geometry::region_at(body, place);
    if (!found && std::any_of(body.parts.begin() + 1, body.parts.end(), [&](const auto& part) {
          return geometry::encloses(part.surface, place);
        }))
      throw MeshError("a part of the body lies outside its outer surface; move it inwards");
    return found;
  });
  if (std::ranges::all_of(mesh.regions, [](int r) { return r == 0; })) mesh.regions.clear();
}

double volume_of(const geometry::Body& body) {
  return geometry::enclosed(body.parts.front().surface).volume;
}

geometry::TetMesh checked(const geometry::Body& body, geometry::TetMesh mesh) {
  check(mesh, "body by TetGen", volume_of(body));
  return mesh;
}

// Nodes inside an even mesh, times the largest volume of its tetrahedra, over the volume.
constexpr double nodes_by_volume = 0.4;

// How many nodes TetGen may add before the surface counts as unfit: 20 times those of an even mesh.
std::size_t most_nodes(const geometry::Body& body, const geometry::Surface& facets,
                       double largest) {
  const double even =
      static_cast<double>(facets.vertices.size()) + nodes_by_volume * volume_of(body) / largest;
  return static_cast<std::size_t>(1e4 + 20.0 * even);
}

enum class Triangles { kept, split };  // split by TetGen, which adds nodes on the surfaces

// Relative differences of the counts from the requested ones.
struct Miss {
  double nodes = HUGE_VAL;
  double tetrahedra = 0.0;

  [[nodiscard]] double worst() const { return std::max(std::abs(nodes), std::abs(tetrahedra)); }
};

class Search {
 public:
  Search(const Target& target, double time_limit) : target_(target), time_limit_(time_limit) {
    assert(target.nodes > 0 || target.edge_length > 0.0);
  }

  // Meshes the body with tetrahedra of at most `largest` m^3.
  [[nodiscard]] geometry::TetMesh mesh(const geometry::Body& body, double largest,
                                       Triangles triangles = Triangles::kept) const {
    // The time limit decides only whether there is a result, not which.
    const double spent = watch_.seconds();
    if (spent >= time_limit_)
      throw MeshError("no mesh as fine as wanted was found within " + rounded_text(time_limit_) +
                      " s; ask for fewer nodes or allow more time");
    const geometry::Surface facets = geometry::facets(body);
    const std::size_t most = most_nodes(body, facets, largest);
    geometry::TetMesh mesh =
        tetgen_surface(facets,
                       switches + std::string("a") + number_text(largest) + "S" +
                           std::to_string(most) + (triangles == Triangles::kept ? "Y" : ""),
                       time_limit_ - spent);
    if (mesh.nodes.size() >= facets.vertices.size() + most)
      throw MeshError("TetGen added " + std::to_string(most) +
                      " nodes without an end, as it does where facets meet at sharp angles; smooth "
                      "the surface there");
    name_regions(body, mesh);
    return mesh;
  }

  // Searches for the requested nodes from the volume `largest` (m^3) on; returns what is missing.
  Miss tune(const geometry::Body& body, double largest, Triangles triangles = Triangles::kept) {
    const int fixed = static_cast<int>(geometry::facets(body).vertices.size());
    Miss nearest{over(fixed, target_.nodes), 0.0};
    if (nearest.nodes > fair_miss) {  // a mesh never has fewer nodes
      fewest_ = std::min(fewest_, fixed);
      return nearest;
    }
    nearest = {};
    const double wanted = std::max(target_.nodes - fixed, 0);
    std::pair<std::size_t, std::size_t> before{};  // nodes and tetrahedra of the last try
    bool above = false;                            // some volume gave too many nodes
    bool below = false;                            // or too few
    double low =
        std::min(1e-3 * largest, 0.05 * even_volume(body));  // too many nodes, or not tried
    double high = 1e4 * largest;                             // too few nodes, or not tried
    for (int tries = 0; tries < tries_per_body && high > 1.02 * low; ++tries) {
      geometry::TetMesh found = mesh(body, largest, triangles);
      const int count = static_cast<int>(found.nodes.size());
      const Miss miss{over(count, target_.nodes),
                      target_.tetrahedra == 0
                          ? 0.0
                          : over(static_cast<int>(found.tetrahedra.size()), target_.tetrahedra)};
      const std::pair counts{found.nodes.size(), found.tetrahedra.size()};
      if (std::abs(miss.nodes) < std::abs(nearest.nodes)) nearest = miss;
      if (miss.worst() < miss_) {
        miss_ = miss.worst();
        best_ = {body, std::move(found)};
      }
      if (std::abs(miss.nodes) <= good_miss) break;
      const double inside = count - fixed;
      (inside > wanted ? low : high) = largest;
      (inside > wanted ? above : below) = true;
      // A volume that limits no tetrahedron changes nothing, nor does a smaller one than the
      // surface's triangles allow.
      if (counts == std::exchange(before, counts) && !(above && below)) break;
      // The nodes inside are about proportional to 1 / volume; the bracket limits the estimate.
      const double guess = largest * (inside + 0.5) / (wanted + 0.5);
      largest = guess > low && guess < high ? guess : std::sqrt(low * high);
    }
    return nearest;
  }

  // The largest volume, m^3, of tetrahedra of an even mesh with the requested nodes.
  [[nodiscard]] double even_volume(const geometry::Body& body) const {
    return nodes_by_volume * volume_of(body) / target_.nodes;
  }

  [[nodiscard]] double miss() const { return miss_; }

  // The best of all meshes.
  [[nodiscard]] geometry::TetMesh taken() const {
    if (miss_ <= worst_miss) return checked(best_.body, best_.mesh);
    std::string text = "no mesh near " + std::to_string(target_.nodes) + " nodes";
    if (target_.tetrahedra > 0)
      text += " and " + std::to_string(target_.tetrahedra) + " tetrahedra";
    const std::string remedy = "; ask for about as many, or change the surface";
    if (miss_ == HUGE_VAL)
      throw TooFewNodes(
          text + " was found, as the surfaces alone have " + std::to_string(fewest_) + remedy,
          fewest_);
    throw OtherNodes(text + " was found, the nearest has " +
                     std::to_string(best_.mesh.nodes.size()) + " and " +
                     std::to_string(best_.mesh.tetrahedra.size()) + remedy);
  }

 private:
  struct Found {
    geometry::Body body;
    geometry::TetMesh mesh;
  };

  static double over(int count, int wanted) {
    return (count - wanted) / static_cast<double>(wanted);
  }

  Target target_;
  double time_limit_;  // s
  Stopwatch watch_;
  double miss_ = HUGE_VAL;
  int fewest_ = std::numeric_limits<int>::max();
  Found best_;
};

// A shape with inclusions, sampled at different spacings.
struct Sampling {
  const geometry::Shape& shape;
  std::span<const geometry::Inclusion> inclusions;

  [[nodiscard]] geometry::Body body(double spacing, double inner) const {
    geometry::Body body = geometry::sampled(shape, {spacing, inner * spacing});
    for (const geometry::Inclusion& inclusion : inclusions)
      geometry::add_inclusion(body, inclusion, spacing);
    return body;
  }
};

// For a fixed number of nodes, a finer surface leaves fewer nodes inside and gives fewer
// tetrahedra. The counts jump when rows come or go, so the search ends with nearby spacings.
void tune_both(const Sampling& sampling, double spacing, double inner, Search& search) {
  double fine = 0.4 * spacing;
  double coarse = 2.0 * spacing;
  double best = spacing;
  const auto attempt = [&](double at) {
    const double before = search.miss();
    const Miss miss = search.tune(sampling.body(at, inner), volume_at(at));
    if (search.miss() < before) best = at;
    return miss;
  };
  while (coarse > 1.03 * fine && search.miss() > good_miss) {
    const Miss miss = attempt(spacing);
    const bool too_coarse =
        miss.nodes < -fair_miss || (miss.nodes <= fair_miss && miss.tetrahedra > 0.0);
    (too_coarse ? coarse : fine) = spacing;
    spacing = std::sqrt(fine * coarse);
  }
  if (search.miss() > 3.0 * fair_miss) return;
  const double middle = best;
  for (const double factor : {0.99, 1.01, 0.98, 1.02, 0.97, 1.03, 0.96, 1.04})
    if (search.miss() > fair_miss) (void)attempt(factor * middle);
}

}  // namespace

geometry::TetMesh tetgen_body(const geometry::Body& body, const Target& target, double time_limit) {
  for (const geometry::Part& part : body.parts)
    if (!(geometry::enclosed(part.surface).volume > 0.0))
      throw MeshError("a surface of the body is inside out; turn its triangles round");
  Search search(target, time_limit);
  const geometry::Surface& outer = body.parts.front().surface;
  if (target.nodes == 0) {
    // Triangles much coarser than the tetrahedra would keep TetGen from placing nodes near them;
    // split needles would become a hundred times as many.
    const Triangles triangles =
        spacing_of(outer) > 2.0 * target.edge_length ? Triangles::split : Triangles::kept;
    return checked(body, search.mesh(body, volume_at(target.edge_length), triangles));
  }
  const double edge = mean_edge(outer);
  const Miss miss = search.tune(body, volume_at(edge));
  // Where triangles are split, the size of the surface's triangles does not count.
  if (miss.nodes < -fair_miss)
    search.tune(body, std::min(volume_at(edge), search.even_volume(body)), Triangles::split);
  return search.taken();
}

geometry::TetMesh tetgen_shape(const geometry::Shape& shape,
                               std::span<const geometry::Inclusion> inclusions,
                               const Target& target, double time_limit) {
  const Sampling sampling{shape, inclusions};
  Search search(target, time_limit);
  if (target.nodes == 0) {
    const geometry::Body body = sampling.body(target.edge_length, 1.0);
    return checked(body, search.mesh(body, volume_at(target.edge_length)));
  }
  // The nodes grow as 1 / spacing to a power between 2 (all on the surface) and 3.
  double spacing = std::cbrt(geometry::extent(shape).prod() / target.nodes);
  for (int step = 0; step < 6; ++step) {
    const geometry::TetMesh mesh = search.mesh(sampling.body(spacing, 1.0), volume_at(spacing));
    const double ratio = static_cast<double>(mesh.nodes.size()) / target.nodes;
    if (std::abs(ratio - 1.0) < 0.1) break;
    spacing *= std::pow(ratio, 1.0 / 2.5);
  }
  if (target.tetrahedra == 0) {
    for (const double factor : {1.0, 1.06, 0.95, 1.12, 0.9})
      if (search.miss() > good_miss)
        search.tune(sampling.body(factor * spacing, 1.0), volume_at(factor * spacing));
    return search.taken();
  }
  // Inner surfaces also produce tetrahedra; if there are too many, the inner spacing is increased.
  const bool layered = std::holds_alternative<geometry::LayeredLimb>(shape);
  for (const double inner : layered ? std::vector{1.0, 2.0, 2.5} : std::vector{1.0})
    if (search.miss() > fair_miss) tune_both(sampling, spacing, inner, search);
  return search.taken();
}

namespace {

// Whether the surface is finer than the mesh should be.
bool too_fine(const geometry::Surface& surface, const Target& target) {
  return target.nodes > 0 ? static_cast<int>(surface.vertices.size()) >= target.nodes
                          : spacing_of(surface) < 0.5 * target.edge_length;
}

std::string told(const geometry::Surface& before, std::size_t needles, const Remeshed& after) {
  std::string text = "the " + std::to_string(before.triangles.size()) +
                     " triangles of the surface became " +
                     std::to_string(after.surface.triangles.size()) + " for the mesh";
  if (needles > 0) text += ", because " + std::to_string(needles) + " of them are needles";
  return text + (needles > 0 ? "; " : ", because they are finer than the mesh wanted; ") +
         "the two surfaces are at most " + rounded_text(unit::mm.from_si(after.distance), 2) +
         " mm apart";
}

geometry::Body body_of(geometry::Surface surface, std::span<const geometry::Inclusion> inclusions) {
  const double spacing = spacing_of(surface);
  geometry::Body body;
  body.parts.push_back({std::move(surface), 0});
  for (const geometry::Inclusion& inclusion : inclusions)
    geometry::add_inclusion(body, inclusion, spacing);
  return body;
}

}  // namespace

FileMesh tetgen_file(geometry::Surface surface, std::span<const geometry::Inclusion> inclusions,
                     const Target& target, double time_limit) {
  constexpr double many = 0.1;           // of the triangles
  constexpr double with_needles = 20.0;  // s
  FileMesh made;
  const std::size_t needles = count_needles(surface);
  const double spacing = target.nodes > 0 ? cell_for(surface, target.nodes) : target.edge_length;
  const auto remesh = [&] {
    auto better = remeshed(surface, spacing);
    if (!better) return false;
    made.warning = told(surface, needles, *better);
    surface = std::move(better->surface);
    return true;
  };
  bool full_of_needles = false;  // that stay
  const auto meshed = [&](const Target& wanted) {
    const geometry::Body body = body_of(surface, inclusions);
    if (!full_of_needles) return tetgen_body(body, wanted, time_limit);
    try {
      return tetgen_body(body, wanted, std::min(with_needles, time_limit));
    } catch (const TooFewNodes&) {
      throw;
    } catch (const OtherNodes&) {
      throw;
    } catch (const MeshError&) {
      throw Needles(std::to_string(needles) + " of the " +
                    std::to_string(surface.triangles.size()) +
                    " triangles of the surface are needles, with which TetGen finds no mesh, and "
                    "even ones would miss its details or cut each other; remesh it in the program "
                    "it comes from, with triangles of about equal sides");
    }
  };
  std::exception_ptr failure;
  bool other_nodes = false;
  const auto attempt = [&] {
    // The mesh keeps the surface's vertices, so that it cannot have fewer nodes.
    if (target.nodes > 0 && too_fine(surface, target)) return false;
    try {
      made.mesh = meshed(target);
    } catch (const OtherNodes&) {
      failure = std::current_exception();
      other_nodes = true;
      return false;
    } catch (const Needles&) {
      throw;
    } catch (const MeshError&) {
      if (target.nodes == 0) throw;
      failure = std::current_exception();
      return false;
    }
    return true;
  };
  const bool asked = too_fine(surface, target) || needles > 0;
  // Walls have no room for nodes inside: their surface gets them.
  const auto split = [&] {
    constexpr double share = 0.995;  // within `good_miss`
    const auto wanted = static_cast<std::size_t>(share * target.nodes);
    if (!other_nodes || surface.vertices.size() >= wanted) return false;
    const std::size_t before = surface.triangles.size();
    surface = geometry::with_halved_edges(std::move(surface), wanted);
    made.warning += (made.warning.empty() ? "" : "; ") +
                    std::string("edges of the surface were halved for a mesh of so many nodes: ") +
                    std::to_string(before) + " triangles became " +
                    std::to_string(surface.triangles.size());
    return true;
  };
  if (asked && !remesh())
    full_of_needles =
        static_cast<double>(needles) > many * static_cast<double>(surface.triangles.size());
  if (attempt() || (!asked && remesh() && attempt()) || (split() && attempt())) return made;
  made.mesh = meshed({.edge_length = spacing_of(surface)});
  if (failure && static_cast<int>(made.mesh.nodes.size()) < target.nodes)
    std::rethrow_exception(failure);
  made.warning += (made.warning.empty() ? "" : "; ") + std::string("the mesh has ") +
                  std::to_string(made.mesh.nodes.size()) + " nodes instead of " +
                  std::to_string(target.nodes) + ", because it keeps the surface's vertices";
  return made;
}

}  // namespace palpate::meshing
