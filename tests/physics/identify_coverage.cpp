// Synthetic curves with 1 % noise: the truth is inside the 95 % interval as often as that says, and
// the interval is as wide as the noise makes it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/text.h"
#include "identify_scenes.h"

namespace palpate {
namespace {

using test::IdentifyScene;

// P(X <= k) of n repeats that are each inside with a probability of 0.95.
double at_most(int k, int n) {
  double sum = 0.0;
  for (int i = 0; i <= k; ++i)
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) +
                    i * std::log(0.95) + (n - i) * std::log(0.05));
  return sum;
}

std::string key_of(const IdentifyScene& scene, std::size_t i) {
  return scene.unknowns[i].substr(0, scene.unknowns[i].find('='));
}

// The curve where one unknown is this share above its truth.
identify::Measurement moved_curve(IdentifyScene scene, std::size_t i, double share) {
  const std::string key = key_of(scene, i);
  std::erase_if(scene.truth, [&](const std::string& one) { return one.starts_with(key + "="); });
  const char* unit = key.ends_with("modulus") ? " Pa" : key.ends_with("time") ? " s" : "";
  scene.truth.push_back(key + "=" + number_text((1.0 + share) * scene.true_values[i]) + unit);
  return test::clean_curve(scene);
}

// dy/d(unknown) at each point, by central differences of whole runs; of a contact point those of
// the curve itself.
Eigen::VectorXd slope(const IdentifyScene& scene, const identify::Measurement& clean,
                      std::size_t i) {
  const auto size = static_cast<Eigen::Index>(clean.y.size());
  Eigen::VectorXd dy = Eigen::VectorXd::Zero(size);
  if (key_of(scene, i) == "contact_point") {
    for (std::size_t k = 1; k < clean.y.size(); ++k) {  // at the first touch it is 0
      const std::size_t next = std::min(k + 1, clean.y.size() - 1);
      dy[static_cast<Eigen::Index>(k)] =
          -(clean.y[next] - clean.y[k - 1]) / (clean.x[next] - clean.x[k - 1]);
    }
    return dy;
  }
  constexpr double share = 1e-2;
  const auto high = moved_curve(scene, i, share);
  const auto low = moved_curve(scene, i, -share);
  if (high.x != clean.x || low.x != clean.x) throw std::runtime_error("other points");
  for (std::size_t k = 0; k < clean.y.size(); ++k)
    dy[static_cast<Eigen::Index>(k)] =
        (high.y[k] - low.y[k]) / (2.0 * share * scene.true_values[i]);
  return dy;
}

// The 95 % intervals' widths (SI) where the noise is known: 2 t sigma sqrt((J' J)^-1), with t by
// the first terms of its expansion in the degrees of freedom, z + (z^3 + z) / (4 nu).
struct Expected {
  std::vector<double> widths = {};
  double degrees = 0.0;
};
Expected expected_widths(const IdentifyScene& scene) {
  const identify::Measurement clean = test::clean_curve(scene);
  const std::size_t unknowns = scene.unknowns.size();
  Eigen::MatrixXd slopes(static_cast<Eigen::Index>(clean.y.size()),
                         static_cast<Eigen::Index>(unknowns));
  double largest = 0.0;
  for (const double y : clean.y) largest = std::max(largest, std::abs(y));
  for (std::size_t i = 0; i < unknowns; ++i)
    slopes.col(static_cast<Eigen::Index>(i)) = slope(scene, clean, i);
  const Eigen::MatrixXd covariance = (slopes.transpose() * slopes).inverse();
  Expected expected{.degrees = static_cast<double>(clean.y.size() - unknowns)};
  constexpr double z = 1.959964;
  const double t = z + (z * z * z + z) / (4.0 * expected.degrees);
  for (Eigen::Index i = 0; i < covariance.rows(); ++i)
    expected.widths.push_back(2.0 * t * test::noise_share * largest * std::sqrt(covariance(i, i)));
  return expected;
}

// So few or so many inside happen to a right interval once in a thousand times on either side; the
// noise is the same every time. Few repeats can show gross faults only: hundreds, of every model,
// are in docs/identify.md, by tests/bench/coverage.cpp.
void expect_covered(const char* name, int repeats) {
  const IdentifyScene& scene = test::identify_scene(name);
  const std::vector<test::Covered> covered = test::covered(scene, repeats);
  const Expected expected = expected_widths(scene);
  const auto unknowns = identify::read_unknowns(
      scene.unknowns, scenario::parse(scene.text, "test.toml", {}).cases.front().scenario);
  for (std::size_t i = 0; i < covered.size(); ++i) {
    const int inside = covered[i].inside;
    EXPECT_GT(at_most(inside, repeats), 1e-3)
        << name << ": " << scene.unknowns[i] << ": " << inside;
    if (inside < repeats || repeats > 200) {
      EXPECT_GT(1.0 - at_most(inside - 1, repeats), 1e-3)
          << name << ": " << scene.unknowns[i] << ": " << inside;
    }
    // Four standard errors of a mean of deviations of nu degrees, 1 / sqrt(2 nu) each; and 0.15
    // for what the linearised width excludes, which is a curved model and the widening by
    // residuals that are correlated by chance, [sample_size]: one curve in twenty, and by much, so
    // that few repeats do not show its mean.
    const double width = unknowns[i].shown(expected.widths[i]) - unknowns[i].shown(0.0);
    EXPECT_NEAR(covered[i].width / width, 1.0,
                0.15 + 4.0 / std::sqrt(2.0 * expected.degrees * repeats))
        << name << ": " << scene.unknowns[i];
  }
}

TEST(Coverage, HertzWithItsContactPoint) { expect_covered("hertz", 1000); }
TEST(Coverage, CreepOfASpecimen) { expect_covered("creep", 400); }
TEST(Coverage, RelaxationOfASpecimen) { expect_covered("relaxation", 400); }
TEST(Coverage, Layer) { expect_covered("layer", 12); }
TEST(Coverage, ViscousBranch) { expect_covered("viscous branch", 20); }
TEST(Coverage, FrictionOfASlide) { expect_covered("slide", 600); }
TEST(Coverage, Springs) { expect_covered("mass_spring", 3); }
TEST(Coverage, CoupledSprings) { expect_covered("coupled_springs", 3); }
TEST(Coverage, CreepOfSprings) { expect_covered("creep of springs", 20); }

}  // namespace
}  // namespace palpate
