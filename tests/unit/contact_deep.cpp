// A sphere deep in a half-space: the fitted factors, their range, and Sneddon's closed form.
#include "contact/deep.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "contact/hertz.h"

namespace palpate::contact {
namespace {

constexpr double radius = 0.011, modulus = 78902.5;  // m, Pa

double factor(double poisson_ratio, double x) {
  const auto law = deep_law(poisson_ratio);
  EXPECT_TRUE(law.has_value()) << poisson_ratio;
  const auto found = law.value_or(DeepLaw{}).force_factor(x);
  EXPECT_TRUE(found.has_value()) << x;
  return found.value_or(0.0);
}

// Half a unit of the eighth printed digit is the value's own; the finite elements are good to the
// tolerance of 0.3 % that the rows of neo-Hookean spheres state.
void expect_case(const std::string& id, double got, double value, double rel_tol) {
  EXPECT_NEAR(got, value, rel_tol * value + 5e-9) << id;
}

TEST(DeepCases, NeoHookeanSphere) {
  expect_case("large-01", factor(0.27, 0.1), 1.0217802, 0.003);
  expect_case("large-03", factor(0.27, 0.5), 1.0297139, 0.003);
  expect_case("large-04", factor(0.33, 0.1), 1.0114491, 0.003);
  expect_case("large-08", factor(0.40, 0.3), 0.98321556, 0.003);
  expect_case("large-12", factor(0.45, 0.5), 0.93662035, 0.003);
  expect_case("large-13", factor(0.49, 0.1), 0.97304673, 0.003);
  expect_case("large-15", factor(0.49, 0.5), 0.90849821, 0.003);
  expect_case("large-16", factor(0.4995, 0.1), 0.96972309, 0.003);
  expect_case("large-18", factor(0.4995, 0.5), 0.90123217, 0.003);
  // The rows are the fit itself before p and q were rounded to four digits: 0.00005 of each.
  EXPECT_NEAR(factor(0.27, 0.5), 1.0297139, 0.5e-4 * (std::sqrt(0.5) + 0.5));
  EXPECT_NEAR(factor(0.45, 0.5), 0.93662035, 0.5e-4 * (std::sqrt(0.5) + 0.5));
}

// The finite elements' own values, printed to three digits: the fit is good to 0.1 %.
TEST(DeepCases, FiniteElements) {
  constexpr std::array ratios{0.27, 0.33, 0.40, 0.45, 0.49, 0.4995};
  constexpr std::array shallow{1.022, 1.012, 0.998, 0.985, 0.973, 0.970};
  constexpr std::array middle{1.029, 1.009, 0.984, 0.961, 0.939, 0.934};
  constexpr std::array deep{1.029, 1.002, 0.966, 0.936, 0.908, 0.901};
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    EXPECT_NEAR(factor(ratios[i], 0.1), shallow[i], 1.5e-3);
    EXPECT_NEAR(factor(ratios[i], 0.3), middle[i], 1.5e-3);
    EXPECT_NEAR(factor(ratios[i], 0.5), deep[i], 1.5e-3);
  }
}

// The published 1 - 0.15 x holds near nu = 1/2 alone; below 1/3 it has the wrong sign.
TEST(DeepCases, PublishedFactor) {
  const auto published = [](double x) { return 1.0 - 0.15 * x; };
  expect_case("large-20", published(0.3), 0.955, 1e-9);
  for (const double x : {0.1, 0.3, 0.5})
    EXPECT_NEAR(published(x) / factor(0.4995, x), 1.0, 0.028);  // at most 2.7 %
  EXPECT_GT(factor(0.33, 0.1), 1.0);
}

TEST(DeepLaw, IsSmoothBetweenItsRatios) {
  constexpr std::array ratios{0.27, 0.33, 0.40, 0.45, 0.49, 0.4995};
  constexpr std::array p{0.0906, 0.0628, 0.0261, -0.0098, -0.0495, -0.0602};
  constexpr std::array q{-0.0687, -0.0841, -0.1036, -0.1129, -0.1130, -0.1124};
  const auto polynomial = [&](const std::array<double, 6>& values, double nu) {  // Lagrange's
    double sum = 0.0;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      double term = values[i];
      for (std::size_t j = 0; j < ratios.size(); ++j)
        if (j != i) term *= (nu - ratios[j]) / (ratios[i] - ratios[j]);
      sum += term;
    }
    return sum;
  };
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    EXPECT_NEAR(deep_law(ratios[i])->p, p[i], 1e-15);  // rounding
    EXPECT_NEAR(deep_law(ratios[i])->q, q[i], 1e-15);
  }
  // Another smooth curve through the six differs by less than a tenth of the stated error.
  for (double nu = 0.27; nu <= 0.5; nu += 0.002) {
    const DeepLaw law = deep_law(nu).value();
    for (const double x : {0.05, 0.2, 0.5}) {
      const double other = 1.0 + polynomial(p, nu) * std::sqrt(x) + polynomial(q, nu) * x;
      EXPECT_NEAR(law.force_factor(x).value(), other, 0.1 * DeepLaw::error) << nu << " " << x;
    }
  }
  // Slopes meet at the inner ratios: a kink of piecewise straight lines would be 4 to 15 %.
  for (std::size_t i = 1; i + 1 < ratios.size(); ++i) {
    constexpr double step = 1e-5;
    const double here = deep_law(ratios[i])->p;
    const double left = (here - deep_law(ratios[i] - step)->p) / step;
    const double right = (deep_law(ratios[i] + step)->p - here) / step;
    EXPECT_NEAR(left / right, 1.0, 1e-3) << ratios[i];  // the bend over one step
  }
  double before = 1.0;
  for (double nu = 0.27; nu <= 0.5; nu += 0.001) {  // softer against Hertz as nu grows
    const double here = factor(nu, 0.3);
    EXPECT_LT(here, before + 0.03);
    before = here;
  }
}

TEST(DeepLaw, IsEmptyWhereNothingWasComputed) {
  for (const double nu : {-0.5, 0.0, 0.2699, 0.5001, std::nan("")})
    EXPECT_FALSE(deep_law(nu).has_value()) << nu;
  const DeepLaw law = deep_law(0.5).value();
  for (const double x : {0.5001, 2.0, std::nan("")}) {
    EXPECT_FALSE(law.force_factor(x).has_value()) << x;
    EXPECT_FALSE(law.stiffness_factor(x).has_value()) << x;
  }
  EXPECT_TRUE(law.force_factor(0.5).has_value());
  for (const double x : {0.0, -1.0}) {
    EXPECT_EQ(law.force_factor(x).value(), 1.0);
    EXPECT_EQ(law.stiffness_factor(x).value(), 1.0);
  }
  // The spline runs on from 0.4995 to 0.5 by no more than its slope there, 1.1 and 0.1.
  EXPECT_NEAR(law.p, -0.0602, 1.2 * 5e-4);
  EXPECT_NEAR(law.q, -0.1124, 0.1 * 5e-4);
}

TEST(DeepLaw, StiffnessIsTheForcesSlope) {
  for (const double nu : {0.27, 0.36, 0.5}) {
    const DeepLaw law = deep_law(nu).value();
    const auto force = [&](double h) {
      return hertz::force(h, radius, modulus) * law.force_factor(h / radius).value();
    };
    for (const double x : {1e-4, 0.02, 0.2, 0.45}) {
      const double h = x * radius, step = 1e-4 * h;
      const double slope = (force(h + step) - force(h - step)) / (2.0 * step);
      // Central difference: 1e-8 / 24 of the force's third derivative times h^2.
      EXPECT_NEAR(hertz::stiffness(h, radius, modulus) * law.stiffness_factor(x).value(), slope,
                  1e-8 * slope);
    }
  }
}

TEST(Sneddon, CaseByTheSeries) {
  const double h = 0.3 * radius;
  const double got = sneddon_sphere(h, radius, modulus).force / hertz::force(h, radius, modulus);
  expect_case("large-19", got, 0.96991415, 1e-6);
}

TEST(Sneddon, SolvesItsTwoEquations) {
  for (const double x : {1e-12, 1e-6, 1e-3, 0.0099, 0.0101, 0.1, 0.5, 1.0, 3.0, 10.0}) {
    const auto [a, force] = sneddon_sphere(x * radius, radius, modulus);
    ASSERT_GT(a, 0.0);
    ASSERT_LT(a, radius);
    const double log = std::log((radius + a) / (radius - a));
    // log1p-like loss of digits: a/R for small contacts, R - a for wide ones.
    const double t = a / radius;
    const double loss = 1e-15 / t + 1e-15 / (1.0 - t);
    EXPECT_NEAR(0.5 * a * log / radius, x, (loss + 1e-14) * x) << x;
    // The closed form loses 1/x digits to cancelling terms.
    if (x < 1e-4) continue;
    const double closed = modulus * (0.5 * (a * a + radius * radius) * log - a * radius);
    EXPECT_NEAR(force, closed, (10.0 * loss + 1e-14 / (x * std::sqrt(x))) * closed) << x;
  }
}

TEST(Sneddon, IsHertzWhereShallow) {
  for (const double x : {1e-12, 1e-6, 1e-3}) {
    const double h = x * radius;
    const double hertzian = hertz::force(h, radius, modulus);
    EXPECT_NEAR(sneddon_sphere(h, radius, modulus).force / hertzian, 1.0 - 0.1 * x,
                0.002 * x * x + 4e-16);
    EXPECT_NEAR(
        sneddon_sphere(h, radius, modulus).contact_radius / hertz::contact_radius(h, radius), 1.0,
        0.2 * x + 1e-15);  // 1 - x/6
  }
  // The series hands over to the closed form without a step.
  const double below = sneddon_sphere(0.01 * radius, radius, modulus).force;
  const double above = sneddon_sphere(0.01 * radius * (1.0 + 1e-14), radius, modulus).force;
  EXPECT_NEAR(above / below, 1.0, 1e-12);  // what cancels at x = 0.01
  EXPECT_EQ(sneddon_sphere(0.0, radius, modulus).force, 0.0);
  EXPECT_EQ(sneddon_sphere(-1.0, radius, modulus).contact_radius, 0.0);
}

}  // namespace
}  // namespace palpate::contact
