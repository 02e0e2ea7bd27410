// The multifrontal factorisation against dense algebra.
#include "base/cholesky.h"
#include "base/dense.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <csignal>

namespace palpate {
namespace {

// A lattice of `side`^3 nodes with one to three unknowns each, coupled to their neighbours.
struct Lattice {
  Eigen::SparseMatrix<double> lower;
  std::vector<int> first{0};
};
Lattice lattice(int side) {
  Lattice made;
  const auto node = [&](int i, int j, int k) { return (k * side + j) * side + i; };
  const int nodes = side * side * side;
  for (int n = 0; n < nodes; ++n) made.first.push_back(made.first.back() + 1 + n % 3);
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i)
        for (int c = std::max(0, k - 1); c <= std::min(side - 1, k + 1); ++c)
          for (int b = std::max(0, j - 1); b <= std::min(side - 1, j + 1); ++b)
            for (int a = std::max(0, i - 1); a <= std::min(side - 1, i + 1); ++a) {
              const int p = node(i, j, k);
              const int q = node(a, b, c);
              for (int r = made.first[std::size_t(p)]; r < made.first[std::size_t(p) + 1]; ++r)
                for (int s = made.first[std::size_t(q)]; s < made.first[std::size_t(q) + 1]; ++s)
                  if (r >= s)
                    entries.emplace_back(r, s, r == s ? 60.0 : -1.0 - 0.3 * std::sin(r + s));
            }
  made.lower.resize(made.first.back(), made.first.back());
  made.lower.setFromTriplets(entries.begin(), entries.end());
  return made;
}

TEST(FrontCholesky, SolvesAsDenseAlgebraDoes) {
  const Lattice made = lattice(6);
  FrontCholesky factors;
  factors.analyse(made.lower, made.first);
  ASSERT_TRUE(factors.factor(made.lower));
  const Eigen::MatrixXd all = Eigen::MatrixXd(made.lower).selfadjointView<Eigen::Lower>();
  Eigen::VectorXd b(all.rows());
  for (Eigen::Index i = 0; i < b.size(); ++i) b[i] = std::cos(double(i));
  const Eigen::VectorXd want = dense::least_squares(all, b);
  Eigen::VectorXd x;
  factors.solve(b, x);
  EXPECT_LT((x - want).norm(), 1e-13 * want.norm());  // rounding of 400 unknowns
  factors.solve(b, b);
  EXPECT_EQ(b, x);
}

// METIS, which orders the unknowns, would put a handler back for one signal only.
TEST(FrontCholesky, LeavesTheProgramsSignalsAlone) {
  struct sigaction ours {};
  ours.sa_handler = [](int) {};
  struct sigaction before {};
  ::sigaction(SIGTERM, &ours, &before);
  const Lattice made = lattice(4);
  FrontCholesky().analyse(made.lower, made.first);
  struct sigaction after {};
  ::sigaction(SIGTERM, &before, &after);
  EXPECT_EQ(after.sa_handler, ours.sa_handler);
  EXPECT_EQ(after.sa_flags & static_cast<int>(SA_RESETHAND), 0);
}

TEST(FrontCholesky, RefusesWhatIsNotPositiveDefinite) {
  Lattice made = lattice(3);
  FrontCholesky factors;
  factors.analyse(made.lower, made.first);
  ASSERT_TRUE(factors.factor(made.lower));
  made.lower.coeffRef(20, 20) = -1.0;
  EXPECT_FALSE(factors.factor(made.lower));
  made.lower.coeffRef(20, 20) = std::nan("");
  EXPECT_FALSE(factors.factor(made.lower));
}

TEST(FrontCholesky, TakesDiagonalMatricesAndSingleUnknowns) {
  Eigen::SparseMatrix<double> lower(3, 3);
  for (int i = 0; i < 3; ++i) lower.insert(i, i) = 2.0 + i;
  lower.makeCompressed();
  const std::vector<int> first{0, 1, 2, 3};
  FrontCholesky factors;
  factors.analyse(lower, first);
  ASSERT_TRUE(factors.factor(lower));
  Eigen::VectorXd x;
  factors.solve(Eigen::Vector3d(2.0, 3.0, 4.0), x);
  EXPECT_LT((x - Eigen::Vector3d::Ones()).norm(), 1e-15);
}

}  // namespace
}  // namespace palpate
