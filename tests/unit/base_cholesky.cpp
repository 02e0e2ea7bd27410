// The sparse factorisation, plain and bordered, against dense ones: answers, and what is refused.
#include "base/cholesky.h"
#include "base/dense.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <numbers>
#include <thread>

namespace palpate {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

SplitMatrix split_matrix(const Matrix& local, const Matrix& shared, const Vector& weights) {
  SplitMatrix matrix;
  matrix.local = local.sparseView();
  matrix.shared = shared.sparseView();
  matrix.weights = weights;
  return matrix;
}

Matrix dense(const SplitMatrix& matrix) {
  const Matrix shared = matrix.shared;
  return Matrix(matrix.local) + shared.transpose() * matrix.weights.asDiagonal() * shared;
}

// A chain of n masses between walls: 2 on the diagonal, -1 beside it.
Matrix chain(int n) {
  Matrix matrix = Matrix::Zero(n, n);
  matrix.diagonal().setConstant(2.0);
  matrix.diagonal(1).setConstant(-1.0);
  matrix.diagonal(-1).setConstant(-1.0);
  return matrix;
}

// The chain without its walls can move as a whole.
Matrix free_chain(int n) {
  Matrix matrix = chain(n);
  matrix(0, 0) = matrix(n - 1, n - 1) = 1.0;
  return matrix;
}

SplitMatrix plain(const Matrix& local) {
  return split_matrix(local, Matrix(0, local.cols()), Vector(0));
}

// Random numbers that rapidcheck can shrink.
Matrix some_matrix(int rows, int columns) {
  Matrix matrix(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) matrix(i, j) = 0.1 * *rc::gen::inRange(-10, 11);
  return matrix;
}

RC_GTEST_PROP(Cholesky, SolvesAsTheDenseMatrixDoes, ()) {
  const int n = *rc::gen::inRange(1, 12);
  const int m = *rc::gen::inRange(0, 5);
  const Matrix factor = some_matrix(n, n);
  Vector weights(m);
  for (double& weight : weights) weight = *rc::gen::inRange(1, 2000);
  const SplitMatrix matrix = split_matrix(factor * factor.transpose() + Matrix::Identity(n, n),
                                          some_matrix(m, n), weights);
  const Vector b = some_matrix(n, 1);
  Cholesky factors;
  RC_ASSERT(factors.factor(matrix));
  const Vector x = factors.solve(b);
  // rounding: weights of 2000, sums of up to 12
  RC_ASSERT((dense(matrix) * x - b).norm() <= 1e-11 * (1.0 + 2000.0 * x.norm()));
  const Vector want = dense::least_squares(dense(matrix), b);
  RC_ASSERT((x - want).norm() <= 1e-10 * (1.0 + want.norm()));  // condition up to 1e5
}

// Weights of both signs: taken as positive definite exactly where the whole matrix is so. They are
// irrational, so that no pivot on the way is zero by accident.
RC_GTEST_PROP(Cholesky, RefusesWhatIsIndefinite, ()) {
  const int n = *rc::gen::inRange(2, 10);
  const int m = *rc::gen::inRange(1, 4);
  Vector weights(m);
  for (double& weight : weights)
    weight = *rc::gen::suchThat(rc::gen::inRange(-40, 41), [](int w) { return w != 0; }) *
             std::numbers::sqrt2 / 10.0;
  const SplitMatrix matrix = split_matrix(chain(n), some_matrix(m, n), weights);
  const double lowest = dense::symmetric_modes(dense(matrix)).values[0];
  RC_PRE(std::abs(lowest) > 1e-9);  // neither rounding nor the refusal of the nearly singular
  Cholesky factors;
  RC_ASSERT(factors.factor(matrix) == (lowest > 0.0));
}

TEST(Cholesky, RefusesAnIndefiniteMatrix) {
  Matrix matrix = chain(6);
  matrix(3, 3) = 0.5;
  ASSERT_LT(dense::symmetric_modes(matrix).values[0], -0.1);
  Cholesky factors;
  EXPECT_FALSE(factors.factor(plain(matrix)));
  // A row of weight 2 on the mass in question mends it, one elsewhere does not.
  Matrix row = Matrix::Zero(1, 6);
  row(0, 3) = 1.0;
  EXPECT_TRUE(factors.factor(split_matrix(matrix, row, Vector::Constant(1, 2.0))));
  row.setZero();
  row(0, 0) = 1.0;
  EXPECT_FALSE(factors.factor(split_matrix(matrix, row, Vector::Constant(1, 2.0))));
  // And a negative weight spoils what is good.
  EXPECT_FALSE(factors.factor(split_matrix(chain(6), row, Vector::Constant(1, -3.0))));
}

// The local part may be indefinite, if only the whole is not.
TEST(Cholesky, JudgesTheWholeAndNotItsLocalPart) {
  const int n = 7;
  const Matrix sum = Matrix::Ones(1, n);
  const Matrix lowered = free_chain(n) - 0.05 * Matrix::Identity(n, n);
  const SplitMatrix held = split_matrix(lowered, sum, Vector::Constant(1, 5.0));
  Cholesky factors;
  ASSERT_TRUE(factors.factor(held));
  const Vector b = Vector::LinSpaced(n, -1.0, 2.0);
  EXPECT_LT((dense(held) * factors.solve(b) - b).norm(), 1e-12);  // rounding times 7 * 5 / 0.05
  EXPECT_FALSE(factors.factor(split_matrix(lowered, sum, Vector::Constant(1, -5.0))));
  EXPECT_FALSE(factors.factor(plain(lowered)));
}

// In floating point a zero pivot comes out as rounding of either sign.
TEST(Cholesky, RefusesSingularMatrices) {
  for (const double scale : {1.0, 1.0 / 3.0, 0.1, 7e9}) {
    for (const int n : {2, 5, 30, 200}) {
      Matrix matrix = Matrix::Zero(n, n);
      for (int i = 0; i + 1 < n; ++i) {  // springs of different stiffness in a row
        const double k = scale / (1.0 + i % 7);
        matrix(i, i) += k;
        matrix(i + 1, i + 1) += k;
        matrix(i, i + 1) -= k;
        matrix(i + 1, i) -= k;
      }
      Cholesky factors;
      EXPECT_FALSE(factors.factor(plain(matrix))) << scale << " " << n;
      // A row that the motion as a whole does not change holds nothing.
      Matrix row = Matrix::Zero(1, n);
      row(0, 0) = 1.0;
      row(0, n - 1) = -1.0;
      EXPECT_FALSE(factors.factor(split_matrix(matrix, row, Vector::Constant(1, scale)))) << n;
      // A wall that is a millionth as stiff does hold them.
      matrix(0, 0) += 1e-6 * scale;
      EXPECT_TRUE(factors.factor(plain(matrix))) << scale << " " << n;
      EXPECT_TRUE(factors.factor(split_matrix(matrix, row, Vector::Constant(1, scale)))) << n;
    }
  }
}

TEST(Cholesky, RefusesWhatIsNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Matrix matrix = chain(4);
    matrix(2, 2) = bad;
    Cholesky factors;
    EXPECT_FALSE(factors.factor(plain(matrix)));
    EXPECT_FALSE(factors.factor(split_matrix(matrix, Matrix::Ones(1, 4), Vector::Ones(1))));
    EXPECT_FALSE(factors.factor(split_matrix(chain(4), bad * Matrix::Ones(1, 4), Vector::Ones(1))));
  }
}

// One object goes from pattern to pattern and from plain to bordered and back.
TEST(Cholesky, ForgetsTheMatrixBefore) {
  Cholesky factors;
  const Vector b = Vector::Ones(5);
  const std::vector<SplitMatrix> matrices{
      plain(chain(5)),
      split_matrix(chain(5), Matrix::Ones(2, 5) + Matrix::Identity(2, 5), Vector::Ones(2)),
      plain(3.0 * chain(5)), split_matrix(chain(5), Matrix::Ones(1, 5), Vector::Constant(1, 40.0)),
      plain(Matrix::Identity(5, 5))};
  for (const SplitMatrix& matrix : matrices) {
    ASSERT_TRUE(factors.factor(matrix));
    EXPECT_LT((dense(matrix) * factors.solve(b) - b).norm(), 1e-12);  // rounding times 5 * 40 / 0.3
  }
}

// A square net of masses on soft ground, wide enough for nested dissection.
SplitMatrix net(int side) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const int here = side * i + j;
      entries.emplace_back(here, here, 4.01);
      for (const int next : {j + 1 < side ? here + 1 : -1, i + 1 < side ? here + side : -1})
        if (next >= 0) {
          entries.emplace_back(here, next, -1.0);
          entries.emplace_back(next, here, -1.0);
        }
    }
  SplitMatrix matrix;
  matrix.local.resize(side * side, side * side);
  matrix.local.setFromTriplets(entries.begin(), entries.end());
  matrix.shared.resize(0, side * side);
  return matrix;
}

TEST(Cholesky, GivesTheSameBitsInSeveralThreads) {
  const SplitMatrix matrix = net(90);
  const Vector b = Vector::Ones(matrix.local.rows());
  const auto solved = [&] {
    Cholesky factors;
    EXPECT_TRUE(factors.factor(matrix));
    return factors.solve(b);
  };
  const Vector alone = solved();
  EXPECT_LT((matrix * alone - b).norm(), 1e-9);  // rounding times 4 / 0.01
  std::vector<Vector> together(6);
  {
    std::vector<std::jthread> threads;
    for (Vector& x : together) threads.emplace_back([&x, &solved] { x = solved(); });
  }
  for (const Vector& x : together) EXPECT_EQ(x, alone);
}

// Into a vector that is given, and into the right side itself; with and without a shared part.
TEST(Cholesky, SolvesInPlace) {
  Matrix rows(2, 4);
  rows << 1, 0, -2, 0.5, 0, 3, 1, 0;
  for (const SplitMatrix& matrix :
       {plain(chain(4)), split_matrix(chain(4), rows, Vector{{2.0, 0.5}})}) {
    Cholesky factors;
    ASSERT_TRUE(factors.factor(matrix));
    const Vector b{{1.0, -2.0, 0.25, 3.0}};
    Vector x;
    factors.solve(b, x);
    EXPECT_LT((dense(matrix) * x - b).norm(), 1e-13);  // rounding
    Vector same = b;
    factors.solve(same, same);
    EXPECT_EQ(same, x);
    EXPECT_EQ(factors.solve(b), x);
  }
}

TEST(SplitMatrix, MultipliesAndScalesAsTheDenseMatrix) {
  Matrix rows(2, 4);
  rows << 1, 0, -2, 0.5, 0, 3, 1, 0;
  SplitMatrix matrix = split_matrix(chain(4), rows, Vector{{2.0, -0.5}});
  const Vector x{{1.0, -2.0, 0.25, 3.0}};
  EXPECT_LT((matrix * x - dense(matrix) * x).norm(), 1e-14);  // rounding
  const Matrix before = dense(matrix);
  matrix *= 1.5;
  EXPECT_LT((dense(matrix) - 1.5 * before).norm(), 1e-14);  // rounding
}

}  // namespace
}  // namespace palpate
