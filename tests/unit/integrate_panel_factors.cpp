// Panels solve what they factored, bordered or not, with the same bits in any lanes; and central
// differences by them are what the dense equations of a step give.
#include "integrate/panel_factors.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <bit>
#include <cmath>
#include <cstdint>

#include "integrate/central_difference.h"
#include "one_mass.h"
#include "test_surfaces.h"

namespace palpate {
namespace {

using integrate::PanelFactors;
using test::Dice;
using Vector = Eigen::VectorXd;

// A lattice of `side`^3 points, each joined to its neighbours by a random weight, and a
// little ground: positive definite. Every seventh is joined to nothing.
SplitMatrix lattice(int side, int shared) {
  const int n = side * side * side;
  Dice dice(5);
  std::vector<Eigen::Triplet<double>> entries;
  const auto join = [&](int i, int j) {
    if (i % 7 == 0 || j % 7 == 0) return;
    const double weight = 0.5 + dice.roll();
    for (const int k : {i, j}) entries.emplace_back(k, k, weight);
    entries.emplace_back(i, j, -weight);
    entries.emplace_back(j, i, -weight);
  };
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 0.01 + 0.1 * dice.roll());
    if (i % side + 1 < side) join(i, i + 1);
    if (i / side % side + 1 < side) join(i, i + side);
    if (i + side * side < n) join(i, i + side * side);
  }
  SplitMatrix matrix;
  matrix.local.resize(n, n);
  matrix.local.setFromTriplets(entries.begin(), entries.end());
  std::vector<Eigen::Triplet<double>> rows;
  matrix.weights.resize(shared);
  matrix.shared.resize(shared, n);
  for (int v = 0; v < shared; ++v) {
    matrix.weights[v] = 1.0 + 100.0 * dice.roll();
    for (int k = 0; k < 12; ++k) rows.emplace_back(v, (5 * v + 3 * k) % n, dice.roll() - 0.5);
  }
  matrix.shared.setFromTriplets(rows.begin(), rows.end());
  return matrix;
}

Eigen::MatrixXd dense(const SplitMatrix& matrix) {
  Eigen::MatrixXd all = matrix.local;
  const Eigen::MatrixXd shared = matrix.shared;
  return all + shared.transpose() * matrix.weights.asDiagonal() * shared;
}

Vector scattered(Eigen::Index size) {
  Dice dice(9);
  Vector b(size);
  for (double& component : b) component = dice.roll() - 0.5;
  return b;
}

class PanelFactorsOf : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(PanelFactorsOf, solve_what_they_factored) {
  const auto [side, shared] = GetParam();
  const SplitMatrix matrix = lattice(side, shared);
  const Vector b = scattered(matrix.local.rows());
  const Vector want = dense(matrix).ldlt().solve(b);
  Vector got[2];
  for (const auto lanes : {PanelFactors::Lanes::portable, PanelFactors::Lanes::widest}) {
    PanelFactors factors(lanes);
    ASSERT_TRUE(factors.factor(matrix));
    Vector& x = got[static_cast<int>(lanes)];
    factors.solve(b, x);
    // Rounding of a matrix whose condition is about 1e4.
    EXPECT_LE((x - want).norm(), 1e-11 * want.norm());
    Vector in_place = b;
    factors.solve(in_place, in_place);
    EXPECT_EQ(in_place, x);
  }
  for (Eigen::Index i = 0; i < b.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint64_t>(got[0][i]), std::bit_cast<std::uint64_t>(got[1][i]));
}

INSTANTIATE_TEST_SUITE_P(lattices, PanelFactorsOf,
                         testing::Combine(testing::Values(1, 2, 3, 5, 8), testing::Values(0, 4)));

TEST(PanelFactors, ANewMatrixReplacesTheOldOne) {
  PanelFactors factors;
  ASSERT_TRUE(factors.factor(lattice(4, 3)));
  const SplitMatrix matrix = lattice(3, 0);
  ASSERT_TRUE(factors.factor(matrix));
  const Vector b = scattered(27);
  Vector x;
  factors.solve(b, x);
  EXPECT_LE((dense(matrix) * x - b).norm(), 1e-13 * b.norm());  // rounding of a short sum
}

TEST(PanelFactors, RefuseWhatIsSingularOrNotFinite) {
  PanelFactors factors;
  SplitMatrix matrix = lattice(3, 0);
  matrix.local.coeffRef(7, 7) = 0.0;  // joined to nothing
  EXPECT_FALSE(factors.factor(matrix));
  matrix.local.coeffRef(7, 7) = std::nan("");
  EXPECT_FALSE(factors.factor(matrix));
}

}  // namespace
}  // namespace palpate
