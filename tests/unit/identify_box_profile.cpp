// Ends of a profile against curves whose squares are known.
#include "identify/box_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate::identify {
namespace {

// y_k = (u_0 + u_0^2) a_k + u_1 b_k at four points, measured at u = (0.4, 0.5).
struct CurvedProblem {
  std::vector<double> a{1.0, 1.0, 1.0, 1.0}, b{1.0, -1.0, 0.5, 0.0};
  std::vector<double> measured, weights{1.0, 1.0, 1.0, 1.0};
  BoxProblem problem;
  BoxMinimum best;

  explicit CurvedProblem(double fails_beyond = 2.0) {
    const auto at = [this](double u0, double u1, std::size_t k) {
      return (u0 + u0 * u0) * a[k] + u1 * b[k];
    };
    for (std::size_t k = 0; k < 4; ++k) measured.push_back(at(0.4, 0.5, k));
    problem.unknowns = 2;
    problem.curve = [at, fails_beyond](std::span<const double> u, std::span<double> values) {
      for (std::size_t k = 0; k < values.size(); ++k) values[k] = at(u[0], u[1], k);
      return u[1] <= fails_beyond;
    };
    problem.measured = measured;
    problem.weights = weights;
    best = evaluate_in_box(problem, std::vector{0.4, 0.5});
  }
};

// With u_0 held, u_1 takes what it can: the squares are (f(u_0) - f(0.4))^2 (|a|^2 - (a
// b)^2/|b|^2).
TEST(BoxProfile, EndsWhereTheSquaresHaveRisen) {
  const CurvedProblem curved;
  const double left = 4.0 - 0.5 * 0.5 / 2.25;
  const double sigma = 0.05;
  const double t = 3.0;
  const double rise = t * sigma / std::sqrt(left);
  const auto end = [&](double sign) {  // of u + u^2 = 0.56 +- rise
    return -0.5 + std::sqrt(0.25 + 0.56 + sign * rise);
  };
  const double slope = 1.8;  // d (u + u^2) / du at 0.4
  const double own = sigma * sigma / left / (slope * slope);
  const double other = -slope * 0.5 / 2.25 * own;  // u_1 moves against u_0
  const dense::Matrix covariance{{own, other}, {other, sigma * sigma}};
  const Profile found = profile(curved.problem, curved.best, 0, covariance, sigma, t);
  ASSERT_TRUE(found.low && found.high);
  EXPECT_NEAR(*found.low, end(-1.0),
              1e-4);  // false position ends within 1 % of t, and interpolates
  EXPECT_NEAR(*found.high, end(1.0), 1e-4);
  EXPECT_TRUE(std::is_sorted(found.points.begin(), found.points.end(),
                             [](const auto& one, const auto& next) { return one.u < next.u; }));
  const auto near = [&](double u) {
    return std::any_of(found.points.begin(), found.points.end(),
                       [&](const auto& point) { return std::abs(point.u - u) < 0.01; });
  };
  for (const double u : {0.4, 0.5 * (0.4 + *found.low), 0.5 * (0.4 + *found.high)})
    EXPECT_TRUE(near(u)) << u;  // the best fit, and a point half way to either end
  // The same without a guess, and where the guess cannot be evaluated.
  const dense::Matrix none = dense::Matrix::Zero(2, 2);
  EXPECT_NEAR(*profile(curved.problem, curved.best, 0, none, sigma, t).high, end(1.0), 1e-4);
  const CurvedProblem failing(0.52);
  const dense::Matrix far{{own, 10.0 * own}, {10.0 * own, sigma * sigma}};
  EXPECT_NEAR(*profile(failing.problem, failing.best, 0, far, sigma, t).high, end(1.0), 1e-4);
}

TEST(BoxProfile, IsOpenAtTheEdgeOfTheBox) {
  const CurvedProblem curved;
  const dense::Matrix covariance = 0.25 * dense::Matrix::Identity(2, 2);
  const Profile found = profile(curved.problem, curved.best, 0, covariance, 1.0, 2.0);
  EXPECT_FALSE(found.low);  // the root rises to 1.1 at 0, and to 2.8 at 1
  EXPECT_TRUE(found.high);
  const Profile whole = profile_over_box(curved.problem, curved.best, 0);
  ASSERT_EQ(whole.points.size(), 10U);  // nine and the best fit
  EXPECT_EQ(whole.points.front().u, 0.0);
  EXPECT_EQ(whole.points.back().u, 1.0);
  EXPECT_TRUE(std::is_sorted(whole.points.begin(), whole.points.end(),
                             [](const auto& one, const auto& next) { return one.u < next.u; }));
}

}  // namespace
}  // namespace palpate::identify
