// Products of block matrices, and solutions by conjugate gradients against those by factors.
#include "base/symmetric_solver.h"

#include <gtest/gtest.h>

#include <atomic>

#include "base/stop_scope.h"
#include "jittered_block.h"
#include "tissue/supports.h"

namespace palpate {
namespace {

using Vector = Eigen::VectorXd;

struct Body {
  geometry::TetMesh mesh;
  BlockMatrix matrix;
  std::vector<char> held;
};

Body body(const std::array<int, 3>& cells, double nu, tissue::Volume volume) {
  Body result;
  result.mesh = test::jittered_block(cells);
  result.matrix = tissue::stiffness_matrix(
      test::coupled_network(result.mesh, {tissue::Isotropic{2e4, nu}}, volume, 0.05));
  result.held = tissue::held_by_base(result.mesh, tissue::Base::bonded);
  return result;
}

// Numbers without an order, the same on every machine.
Vector some_vector(Eigen::Index size, int seed) {
  Vector vector(size);
  for (Eigen::Index i = 0; i < size; ++i)
    vector[i] = static_cast<double>((1103 * (i + 7 * seed) + 4099 * i * i) % 997) / 997.0 - 0.5;
  return vector;
}

TEST(BlockMatrix, MultipliesAsTheSplitMatrixDoes) {
  for (const auto volume : {tissue::Volume::tetrahedron, tissue::Volume::nodal}) {
    const Body block = body({3, 4, 3}, 0.45, volume);
    EXPECT_EQ(block.matrix.weights().empty(), volume == tissue::Volume::tetrahedron);
    const SplitMatrix split = block.matrix.split(std::vector<char>(block.held.size(), 0));
    const auto size = static_cast<Eigen::Index>(block.held.size());
    Vector lanes(static_cast<Eigen::Index>(block_lanes * block.held.size()));
    for (std::size_t l = 0; l < block_lanes; ++l) {
      const Vector x = some_vector(size, static_cast<int>(l));
      for (std::size_t d = 0; d < block.held.size(); ++d)
        lanes[static_cast<Eigen::Index>(block_lanes * d + l)] = x[static_cast<Eigen::Index>(d)];
    }
    Vector images;
    block.matrix.multiply_lanes(lanes, images);
    for (std::size_t l = 0; l < block_lanes; ++l) {
      const Vector x = some_vector(size, static_cast<int>(l));
      const Vector y = block.matrix * x;
      const Vector expected = split * x;
      EXPECT_LT((y - expected).norm(), 1e-13 * expected.norm());
      for (std::size_t d = 0; d < block.held.size(); ++d)
        EXPECT_NEAR(images[static_cast<Eigen::Index>(block_lanes * d + l)],
                    y[static_cast<Eigen::Index>(d)], 1e-13 * expected.norm());
    }
    Vector diagonal = split.local.diagonal();
    if (split.weights.size() > 0)
      diagonal +=
          (split.shared.transpose() * split.weights.asDiagonal() * split.shared).eval().diagonal();
    EXPECT_LT((block.matrix.diagonal() - diagonal).norm(), 1e-13 * diagonal.norm());
  }
}

TEST(SymmetricSolver, IteratesToTheFactorsSolutionWithinItsStatedError) {
  for (const auto& [nu, volume] :
       {std::pair(0.3, tissue::Volume::tetrahedron), std::pair(0.49, tissue::Volume::nodal)}) {
    const Body block = body({12, 12, 13}, nu, volume);
    const auto size = static_cast<Eigen::Index>(block.held.size());
    ASSERT_GE(size, SymmetricSolver::large);
    Cholesky factors;
    ASSERT_TRUE(factors.factor(block.matrix.split(block.held)));
    constexpr double tolerance = 1e-5;
    SymmetricSolver solver(tolerance);
    ASSERT_TRUE(solver.prepare(block.matrix, block.held));
    // Loads on the whole body, on one node, none, and on supports alone; a fifth in another pass.
    std::vector<Vector> loads{some_vector(size, 1), Vector::Zero(size), Vector::Zero(size),
                              Vector::Zero(size), some_vector(size, 2)};
    loads[1][size - 1] = 1.0;
    for (Eigen::Index d = 0; d < size; ++d)
      if (block.held[static_cast<std::size_t>(d)] != 0) loads[3][d] = 1.0;
    std::vector<Vector> moved(loads.size());
    ASSERT_TRUE(solver.solve(loads, moved));
    EXPECT_GT(solver.error(), 0.0);
    EXPECT_LE(solver.error(), tolerance);
    for (std::size_t k = 0; k < loads.size(); ++k) {
      Vector free = loads[k];
      for (Eigen::Index d = 0; d < size; ++d)
        if (block.held[static_cast<std::size_t>(d)] != 0) free[d] = 0.0;
      const Vector exact = factors.solve(free);
      const Vector wrong = moved[k] - exact;
      EXPECT_LE(std::sqrt(wrong.dot(block.matrix * wrong)),
                tolerance * std::sqrt(exact.dot(block.matrix * exact)))
          << k;
      for (Eigen::Index d = 0; d < size; ++d)
        if (block.held[static_cast<std::size_t>(d)] != 0) {
          EXPECT_EQ(moved[k][d], 0.0);
        }
      // Alone as among others: the same bits.
      Vector alone;
      ASSERT_TRUE(solver.solve(loads[k], alone));
      EXPECT_EQ(alone, moved[k]) << k;
    }
  }
}

// C^-1 P^T K takes P y to y: what the correction gives for the load of its own displacement is that
// displacement again, held where the body is held, and the same for each vector of four.
TEST(CoarseCorrection, KeepsItsOwnDisplacements) {
  for (const auto& [nu, volume] :
       {std::pair(0.3, tissue::Volume::tetrahedron), std::pair(0.45, tissue::Volume::nodal)}) {
    const Body block = body({9, 8, 7}, nu, volume);
    CoarseCorrection coarse;
    ASSERT_TRUE(coarse.prepare(block.matrix, block.held));
    const auto size = static_cast<Eigen::Index>(block_lanes * block.held.size());
    Vector loads = some_vector(size, 0);
    Vector moved = Vector::Zero(size);
    coarse.add(loads, block_lanes, block_lanes, moved);
    block.matrix.multiply_lanes(moved, loads);
    Vector again = Vector::Zero(size);
    coarse.add(loads, block_lanes, block_lanes, again);
    double largest = 0.0;
    for (const double x : moved) largest = std::max(largest, std::abs(x));
    ASSERT_GT(largest, 0.0);
    for (Eigen::Index i = 0; i < moved.size(); ++i) {
      EXPECT_NEAR(again[i], moved[i], 1e-11 * largest);
      if (block.held[static_cast<std::size_t>(i) / block_lanes] != 0) {
        EXPECT_EQ(moved[i], 0.0);
      }
    }
  }
}

TEST(SymmetricSolver, EndsWhereItsScopeIsStopped) {
  const Body block = body({12, 12, 13}, 0.3, tissue::Volume::tetrahedron);
  SymmetricSolver solver;
  ASSERT_TRUE(solver.prepare(block.matrix, block.held));
  const Vector load = some_vector(static_cast<Eigen::Index>(block.held.size()), 1);
  Vector moved;
  std::atomic<bool> stop = false;
  {
    const StopScope scope(stop);
    EXPECT_TRUE(solver.solve(load, moved));
    stop = true;
    {
      const std::atomic<bool> other = false;
      const StopScope inner(other);
      EXPECT_TRUE(solver.solve(load, moved)) << "only the innermost scope counts";
    }
    EXPECT_THROW((void)solver.solve(load, moved), Stopped);
  }
  EXPECT_TRUE(solver.solve(load, moved)) << "without a scope it goes on";
}

TEST(SymmetricSolver, RefusesWhatIsNotPositive) {
  Body block = body({12, 12, 13}, 0.3, tissue::Volume::tetrahedron);
  const auto size = static_cast<Eigen::Index>(block.held.size());
  const Vector load = some_vector(size, 1);
  Vector moved;
  block.matrix *= -1.0;
  SymmetricSolver solver;
  EXPECT_FALSE(solver.prepare(block.matrix, block.held));
  // A positive diagonal, and a negative direction: two nodes that move apart. In their group they
  // move together.
  block.matrix *= -1.0;
  const int last = block.matrix.nodes() - 1;  // at the top
  const BlockMatrix::Block strong =
      10.0 * block.matrix.diagonal().tail<3>().sum() * BlockMatrix::Block::Identity();
  block.matrix.add(last - 1, last, strong);
  ASSERT_TRUE(solver.prepare(block.matrix, block.held));
  EXPECT_FALSE(solver.solve(load, moved));
  // Two nodes that move together.
  block.matrix.add(last - 1, last, -2.0 * strong);
  EXPECT_FALSE(solver.prepare(block.matrix, block.held));
}

TEST(SymmetricSolver, FactorsSmallMatricesAndStatesNoError) {
  const Body block = body({3, 3, 3}, 0.3, tissue::Volume::nodal);
  SymmetricSolver solver;
  EXPECT_FALSE(solver.prepared());
  ASSERT_TRUE(solver.prepare(block.matrix, block.held));
  EXPECT_TRUE(solver.prepared());
  const Vector load = some_vector(static_cast<Eigen::Index>(block.held.size()), 3);
  Vector moved;
  ASSERT_TRUE(solver.solve(load, moved));
  Vector rest = block.matrix * moved - load;
  for (std::size_t d = 0; d < block.held.size(); ++d)
    if (block.held[d] != 0) rest[static_cast<Eigen::Index>(d)] = 0.0;
  EXPECT_LT(rest.norm(), 1e-12 * load.norm());
  EXPECT_EQ(solver.error(), 0.0);
}

}  // namespace
}  // namespace palpate
