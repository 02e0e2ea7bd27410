// Meshes a box with TetGen, and searches for the cell volume that gives the requested nodes.
//
// The surface is a grid that TetGen may not split (`Y`). Otherwise TetGen halves whole edges of the
// box, and the nodes jump by a third between similar volumes (888 to 1217 on 15 x 20 x 30 mm).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/numerics.h"
#include "base/text.h"
#include "geometry/box_surface.h"
#include "meshing/mesh_check.h"
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
      : size_(size), target_(target), time_limit_(time_limit), start_(Clock::now()) {}

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
  using Clock = std::chrono::steady_clock;

  // The time limit decides only whether there is a result, not which.
  int attempt(const geometry::Surface& surface, double volume) {
    const double spent = std::chrono::duration<double>(Clock::now() - start_).count();
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
  Clock::time_point start_;
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

}  // namespace palpate::meshing
