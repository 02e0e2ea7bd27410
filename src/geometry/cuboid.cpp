// Places nodes on a structured mesh, and cuts each cell into one tetrahedron for each order of the
// axes.
#include "geometry/cuboid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/numerics.h"

namespace palpate::geometry {

Surface box_surface(const Vec3& size, const std::array<int, 3>& cells) {
  Surface surface;
  std::map<std::array<int, 3>, int> numbers;  // of the structured mesh points in use
  const auto number = [&](const std::array<int, 3>& at) {
    const auto [entry, fresh] = numbers.try_emplace(at, static_cast<int>(surface.vertices.size()));
    if (fresh)
      surface.vertices.emplace_back(size.x() * (static_cast<double>(at[0]) / cells[0]),
                                    size.y() * (static_cast<double>(at[1]) / cells[1]),
                                    size.z() * (static_cast<double>(at[2]) / cells[2]));
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool far : {false, true}) {
      // (u, v, axis) is right-handed: u, then v is counter-clockwise seen from the far side.
      const std::size_t u = (axis + 1) % 3;
      const std::size_t v = (axis + 2) % 3;
      for (int i = 0; i < cells[u]; ++i)
        for (int j = 0; j < cells[v]; ++j) {
          std::array<int, 4> ring{};  // the square's corners, counter-clockwise from outside
          for (std::size_t c = 0; c < 4; ++c) {
            std::array<int, 3> at{};
            at[axis] = far ? cells[axis] : 0;
            at[u] = i + (c == 1 || c == 2 ? 1 : 0);
            at[v] = j + (c >= 2 ? 1 : 0);
            ring[far ? c : 3 - c] = number(at);
          }
          const std::size_t start = as_index(i + j) % 2;
          const auto corner = [&](std::size_t c) { return ring[(start + c) % 4]; };
          surface.triangles.push_back({corner(0), corner(1), corner(2)});
          surface.triangles.push_back({corner(0), corner(2), corner(3)});
        }
    }
  return surface;
}

namespace {

using Triple = std::array<int, 3>;

struct AxisOrder {
  Triple axes;
  bool even;  // an even permutation: its path tetrahedron is positively oriented
};

constexpr std::array<AxisOrder, 6> axis_orders{{{{0, 1, 2}, true},
                                                {{0, 2, 1}, false},
                                                {{1, 0, 2}, false},
                                                {{1, 2, 0}, true},
                                                {{2, 0, 1}, true},
                                                {{2, 1, 0}, false}}};

struct Lattice {
  Triple cells;

  [[nodiscard]] int node(const Triple& at) const {
    return at[0] + (cells[0] + 1) * (at[1] + (cells[1] + 1) * at[2]);
  }
};

void refuse_too_many(const Triple& cells) {
  const double count = 6.0 * cells[0] * cells[1] * cells[2];
  if (count <= std::numeric_limits<int>::max()) return;
  throw MeshError("a box of " + std::to_string(cells[0]) + " x " + std::to_string(cells[1]) +
                  " x " + std::to_string(cells[2]) +
                  " cells has more tetrahedra than can be numbered; ask for fewer cells");
}

constexpr double endless = std::numeric_limits<double>::infinity();

// The q above 1 with q^count = target. It is computed by multiplications, because pow() is not and
// the nodes' positions affect every result.
double root(int count, double target) {
  const auto excess = [&](double q) {
    double power = 1.0;
    for (int i = 0; i < count && power < 2.0 * target; ++i) power *= q;
    return power - target;
  };
  return numerics::root({1.0, target}, excess).high;
}

// The ends of `count` cells that cover a `length` (m) together, from the finest end on. Cells with
// lengths proportional to sqrt(1 + d^2 / core^2) at the distance d end at d_i = core sinh(i theta):
//   d_i = length (q^i - q^-i) / (q^count - q^-count),  (q^count - q^-count) / 2 = length / core
//                                                                          docs/theory.md [cells]
std::vector<double> growing(double length, int count, double core) {
  const double steepness = length / core;
  const double target = steepness + std::sqrt(1.0 + steepness * steepness);
  const double q = root(count, target);
  std::vector<double> ends;
  double power = 1.0;
  for (int i = 1; i < count; ++i) {
    power *= q;
    ends.push_back(length * ((power - 1.0 / power) / (target - 1.0 / target)));
  }
  ends.push_back(length);
  return ends;
}

// The cell borders along an axis of length `size` (m), from 0.
std::vector<double> borders(double size, int cells, double core, double finest) {
  std::vector<double> all{0.0};
  if (core == endless) {
    // i / n is computed first, so that the last node is exactly at `size`.
    for (int i = 1; i <= cells; ++i) all.push_back(size * (static_cast<double>(i) / cells));
    return all;
  }
  // The cells are divided between both sides of `finest` in proportion to the integral of 1 /
  // sqrt(1 + d^2 / core^2). Only a whole number depends on the logarithms. If a side is too short
  // for a cell, the other side starts at its end.
  const double density = std::asinh(finest / core);
  const double share = density / (density + std::asinh((size - finest) / core));
  const int count = static_cast<int>(std::lround(share * cells));
  if (count == 0) finest = 0.0;
  if (count == cells) finest = size;
  if (count > 0) {
    const std::vector<double> down = growing(finest, count, core);
    for (int i = count - 2; i >= 0; --i) all.push_back(finest - down[as_index(i)]);
    all.push_back(finest);
  }
  if (count < cells) {
    for (const double up : growing(size - finest, cells - count, core)) all.push_back(finest + up);
    all.back() = size;
  }
  return all;
}

// Moves the nearest inner border to every level.
void end_at(std::span<const double> levels, std::vector<double>& borders) {
  if (levels.size() + 2 > borders.size())
    throw MeshError("a box of " + std::to_string(borders.size() - 1) +
                    " cells in height cannot have cell borders at " +
                    std::to_string(levels.size()) + " given heights; ask for more cells");
  std::size_t next = 1;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::size_t last = borders.size() - 1 - (levels.size() - i);
    std::size_t nearest = next;
    for (std::size_t j = next; j <= last; ++j)
      if (std::abs(borders[j] - levels[i]) < std::abs(borders[nearest] - levels[i])) nearest = j;
    borders[nearest] = levels[i];
    next = nearest + 1;
  }
}

// The path along the cell's edges from its start corner to the opposite one, one axis at a time.
std::array<int, 4> path_tetrahedron(const Lattice& lattice, const Triple& cell,
                                    const std::array<bool, 3>& reflected, const AxisOrder& order) {
  Triple at = cell;
  bool positive = order.even;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (reflected[axis]) {
      ++at[axis];
      positive = !positive;
    }
  std::array<int, 4> corner{lattice.node(at), 0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = as_index(order.axes[i]);
    at[axis] += reflected[axis] ? -1 : 1;
    corner[i + 1] = lattice.node(at);
  }
  if (!positive) std::swap(corner[2], corner[3]);
  return corner;
}

}  // namespace

TetMesh cuboid(const Vec3& size, const Triple& cells, CellPattern pattern, const Grading& grading,
               std::span<const double> levels) {
  assert(size.minCoeff() > 0.0 && size.allFinite());
  assert(cells[0] >= 1 && cells[1] >= 1 && cells[2] >= 1);
  refuse_too_many(cells);

  assert(grading.ratio >= 1.0);
  const Vec3 finest = grading.finest.cwiseMax(0.0).cwiseMin(size);
  const double farthest = finest.cwiseMax(size - finest).maxCoeff();
  // sqrt(1 + d^2 / core^2) equals the ratio at the farthest end.
  const double core = grading.ratio == 1.0
                          ? endless
                          : farthest / std::sqrt((grading.ratio - 1.0) * (grading.ratio + 1.0));
  std::array<std::vector<double>, 3> places;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    places[axis] = borders(size[a], cells[axis], core, finest[a]);
  }
  end_at(levels, places[2]);
  TetMesh mesh;
  for (const double z : places[2])
    for (const double y : places[1])
      for (const double x : places[0]) mesh.nodes.emplace_back(x, y, z);

  const Lattice lattice{cells};
  const bool mirrored = pattern == CellPattern::mirrored;
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) {
        const std::array<bool, 3> reflected{mirrored && i % 2 == 1, mirrored && j % 2 == 1,
                                            mirrored && k % 2 == 1};
        for (const AxisOrder& order : axis_orders)
          mesh.tetrahedra.push_back(path_tetrahedron(lattice, {i, j, k}, reflected, order));
      }
  return mesh;
}

}  // namespace palpate::geometry
