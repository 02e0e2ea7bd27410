// Nodes on a lattice; in each cell one walk along its edges for each order of the axes.
#include "geometry/cuboid.h"

#include <cassert>
#include <limits>
#include <string>
#include <utility>

#include "base/error.h"

namespace palpate::geometry {
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

// The walk from the cell's start corner to the opposite one, one axis after the other.
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
    const auto axis = static_cast<std::size_t>(order.axes[i]);
    at[axis] += reflected[axis] ? -1 : 1;
    corner[i + 1] = lattice.node(at);
  }
  if (!positive) std::swap(corner[2], corner[3]);
  return corner;
}

}  // namespace

TetMesh cuboid(const Vec3& size, const Triple& cells, CellPattern pattern) {
  assert(size.minCoeff() > 0.0 && size.allFinite());
  assert(cells[0] >= 1 && cells[1] >= 1 && cells[2] >= 1);
  refuse_too_many(cells);

  TetMesh mesh;
  // i / n first, so that the last node lies exactly at `size`.
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i)
        mesh.nodes.emplace_back(size.x() * (static_cast<double>(i) / cells[0]),
                                size.y() * (static_cast<double>(j) / cells[1]),
                                size.z() * (static_cast<double>(k) / cells[2]));

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
