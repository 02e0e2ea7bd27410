// The layer of spheres: mass, centre of gravity, spacing, outline; and what it presses on a flat.
#include "finger/layer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "contact/hertz.h"
#include "geometry/shapes.h"

namespace palpate::finger {
namespace {

constexpr double finger_radius = 11e-3;
constexpr double finger_density = 1370.0;
const double finger_volume = 4.0 / 3.0 * std::numbers::pi * std::pow(finger_radius, 3);

const geometry::Surface& tip() {
  static const geometry::Surface surface = geometry::fingertip(finger_volume);
  return surface;
}

// Packed when first asked for: every test runs in a process of its own.
const Layer& layer_of(int count) {
  static std::map<int, Layer> layers;
  const auto found = layers.find(count);
  if (found != layers.end()) return found->second;
  return layers.emplace(count, pack(tip(), finger_density, count)).first->second;
}

class EachCount : public testing::TestWithParam<int> {
 protected:
  const Layer& layer_ = layer_of(GetParam());
};

TEST_P(EachCount, keeps_mass_and_centre_of_gravity) {
  const auto n = static_cast<double>(GetParam());
  ASSERT_EQ(layer_.centres.size(), static_cast<std::size_t>(GetParam()));
  EXPECT_NEAR(layer_.mass(), finger_density * finger_volume,
              1e-13 * finger_density * finger_volume);                              // rounding
  EXPECT_NEAR(layer_.radius, finger_radius / std::cbrt(n), 1e-13 * finger_radius);  // rounding
  Vec3 sum = Vec3::Zero();
  for (const Vec3& centre : layer_.centres) sum += centre;
  EXPECT_LT((sum / n).norm(), 1e-15 * finger_radius);  // rounding of a mean
}

TEST_P(EachCount, is_flat_and_its_own_mirror_image) {
  for (const Vec3& centre : layer_.centres) {
    EXPECT_EQ(centre.z(), 0.0);
    const Vec3 image(centre.x(), -centre.y(), 0.0);
    EXPECT_NE(std::find(layer_.centres.begin(), layer_.centres.end(), image), layer_.centres.end());
  }
}

// The smallest distance between two centres, m.
double smallest_spacing(const Layer& layer) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < layer.centres.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, (layer.centres[i] - layer.centres[j]).norm());
  return least;
}

// Measured: 0.54 (3 spheres, which do not fit beside one another) to 0.94 of the radius.
TEST_P(EachCount, keeps_its_distances) {
  const double least = GetParam() == 3 ? 0.54 : GetParam() < 5 ? 0.68 : 0.75;
  EXPECT_GT(smallest_spacing(layer_), least * layer_.radius);
}

// One sphere is wider than the finger; two and more find room.
TEST_P(EachCount, stays_inside_the_outline) {
  if (GetParam() == 1) return;
  const geometry::Enclosed inside = geometry::enclosed(geometry::with_closed_base(tip()));
  double breadth = 0.0;
  for (const Vec3& vertex : tip().vertices) breadth = std::max(breadth, vertex.y());
  const double slack = 1e-3 * layer_.radius;  // what the last shift to the centre of gravity costs
  for (const Vec3& centre : layer_.centres) {
    EXPECT_GT(inside.centroid.x() + centre.x(), layer_.radius - slack);
    EXPECT_LT(inside.centroid.x() + centre.x(), tip().vertices[0].x() - layer_.radius + slack);
    EXPECT_LT(std::abs(centre.y()), breadth - layer_.radius + slack);
  }
}

// n spheres at equal depth press like the one of radius r n^(1/3), times n^(5/6) where only the
// mass is kept.                                             docs/theory.md [calibration]
TEST_P(EachCount, presses_a_flat_as_calibrated) {
  const int n = GetParam();
  const double modulus = 70e3;
  const auto pressed = [&](double depth, Calibration calibration) {
    double sum = 0.0;
    for (std::size_t i = 0; i < layer_.centres.size(); ++i)
      sum += contact::hertz::force(depth + layer_.centres[i].z(), layer_.radius,
                                   modulus * modulus_factor(calibration, n));
    return sum;
  };
  for (const double depth : {0.1e-3, 0.5e-3, 1e-3, 3e-3}) {
    const double one = contact::hertz::force(depth, finger_radius, modulus);
    EXPECT_NEAR(pressed(depth, Calibration::force), one, 1e-12 * one) << depth;  // rounding
    const double by_mass = std::pow(n, 5.0 / 6.0) * one;
    EXPECT_NEAR(pressed(depth, Calibration::mass), by_mass, 1e-12 * by_mass) << depth;
  }
}

INSTANTIATE_TEST_SUITE_P(Counts, EachCount, testing::Range(1, most_spheres + 1));

TEST(Layer, ComesOutTheSameTwice) {
  for (const int n : {2, 13, 40})
    EXPECT_EQ(pack(tip(), finger_density, n).centres, layer_of(n).centres);
}

TEST(Layer, ScalesWithTheFinger) {
  for (const int n : {1, 2, 13, 40}) {
    const Layer large = pack(geometry::fingertip(8.0 * finger_volume), finger_density, n);
    EXPECT_NEAR(large.radius, 2.0 * layer_of(n).radius, 1e-13 * finger_radius);  // rounding
    for (std::size_t i = 0; i < large.centres.size(); ++i)
      // rounding that some 1000 sweeps carry on
      EXPECT_LT((large.centres[i] - 2.0 * layer_of(n).centres[i]).norm(), 1e-6 * finger_radius);
  }
}

TEST(Layer, OneSphereIsTheSphere) {
  const Layer& layer = layer_of(1);
  EXPECT_NEAR(layer.mass(), 7.6383e-3, 1e-6);  // 4/3 pi 0.011^3 m^3 of 1370 kg/m^3
  EXPECT_EQ(layer.centres[0], Vec3::Zero());
  EXPECT_EQ(modulus_factor(Calibration::force, 1), 1.0);
}

// Eq. (5) keeps the mass, not the force: 8^(5/6).
TEST(Layer, EightSpheresPressFiveTimesAsHard) {
  EXPECT_NEAR(1.0 / modulus_factor(Calibration::force, 8), 5.657, 5e-4);  // printed digits
}

TEST(Layer, AClosedFingerGivesTheSame) {
  EXPECT_EQ(pack(geometry::with_closed_base(tip()), finger_density, 7).centres,
            layer_of(7).centres);
}

}  // namespace
}  // namespace palpate::finger
