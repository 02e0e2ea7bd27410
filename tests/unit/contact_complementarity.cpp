// Unilateral points against every possible choice of who touches, and against closed answers.
#include "base/dense.h"
#include "contact/balance.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Core>

namespace palpate::contact {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// A A^T + a little on the diagonal, from whole numbers that rapidcheck can shrink.
Matrix some_compliance(int n) {
  Matrix factor(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) factor(i, j) = *rc::gen::inRange(-5, 6);
  return Matrix(factor * factor.transpose()) + 0.1 * Matrix::Identity(n, n);
}

Vector some_gaps(int n) {
  Vector gaps(n);
  for (int i = 0; i < n; ++i) gaps[i] = *rc::gen::inRange(-10, 11);
  return gaps;
}

// The one set of touching points that neither pull nor leave an overlap, by trying them all.
Vector by_trial(const Matrix& compliance, const Vector& gap) {
  const auto n = static_cast<int>(gap.size());
  for (int set = 0; set < 1 << n; ++set) {
    Matrix system = Matrix::Identity(n, n);
    Vector right = Vector::Zero(n);
    for (int i = 0; i < n; ++i)
      if ((set >> i & 1) != 0) {
        system.row(i) = compliance.row(i);
        right[i] = -gap[i];
      }
    const Vector force = dense::least_squares(system, right);
    const Vector left = gap + compliance * force;
    if (force.minCoeff() >= -1e-9 && left.minCoeff() >= -1e-9) return force;
  }
  ADD_FAILURE() << "no set fits";
  return Vector::Zero(n);
}

RC_GTEST_PROP(PressApart, finds_what_trying_all_sets_finds_from_any_guess, ()) {
  const int n = *rc::gen::inRange(1, 8);
  const Matrix compliance = some_compliance(n);
  const Vector gap = some_gaps(n);
  std::vector<char> pressed(static_cast<std::size_t>(n));
  for (char& one : pressed) one = static_cast<char>(*rc::gen::inRange(0, 2));
  Vector force;
  RC_ASSERT(press_apart(compliance, gap, pressed, force));
  const Vector left = gap + compliance * force;
  const double size = 1e-9 * (1.0 + force.cwiseAbs().maxCoeff());  // rounding, condition up to 1e5
  RC_ASSERT((force - by_trial(compliance, gap)).cwiseAbs().maxCoeff() < 1e3 * size);
  for (int i = 0; i < n; ++i) {
    RC_ASSERT(force[i] >= 0.0);
    RC_ASSERT(left[i] > -1e2 * size);
    RC_ASSERT(pressed[static_cast<std::size_t>(i)] != 0 || force[i] == 0.0);
  }
}

// A row of springs of 1 m/N each under a step of two heights.
TEST(PressApart, springs_that_do_not_know_each_other_take_what_overlaps) {
  Vector gap(4);
  gap << -2.0, 1.0, -0.5, 0.0;
  std::vector<char> pressed(4, 0);
  Vector force;
  ASSERT_TRUE(press_apart(Matrix::Identity(4, 4), gap, pressed, force));
  Vector expected(4);
  expected << 2.0, 0.0, 0.5, 0.0;
  EXPECT_EQ(force, expected);
}

// Two points that sink as one: the deeper overlap alone is pressed, and that closes the other.
TEST(PressApart, a_neighbour_that_is_carried_along_needs_no_force) {
  Matrix compliance(2, 2);
  compliance << 1.0, 0.9, 0.9, 1.0;
  Vector gap(2);
  gap << -1.0, -0.5;
  std::vector<char> pressed(2, 1);
  Vector force;
  ASSERT_TRUE(press_apart(compliance, gap, pressed, force));
  EXPECT_DOUBLE_EQ(force[0], 1.0);
  EXPECT_EQ(force[1], 0.0);
  EXPECT_EQ(pressed[1], 0);
}

TEST(PressApart, what_does_not_resist_is_refused) {
  std::vector<char> pressed(2, 1);
  Vector force;
  Matrix none(2, 2);
  none << 1.0, 2.0, 2.0, 1.0;
  EXPECT_FALSE(press_apart(none, Vector::Constant(2, -1.0), pressed, force));
}

}  // namespace
}  // namespace palpate::contact
