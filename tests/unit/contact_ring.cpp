// The ring that `consistent` reads: exact for what it fits, continuous, and its half-space.
#include "contact/ring.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "contact/half_space.h"
#include "geometry/cuboid.h"
#include "test_surfaces.h"

namespace palpate {
namespace {

using contact::Patch;
using contact::Reading;
using contact::RingReader;
using contact::Spread;
using contact::Spreader;
using geometry::SmoothSurface;

struct Block {
  SmoothSurface smooth;
  RingReader ring{smooth};
  Spreader spreader{smooth};
  geometry::BoxTree tree{smooth.surface()};

  explicit Block(std::array<int, 3> cells = {7, 6, 4})
      : smooth(geometry::skin(
                   geometry::cuboid(Vec3(0.06, 0.06, 0.03), cells, geometry::CellPattern::mirrored))
                   .surface) {}

  [[nodiscard]] Patch patch(double x, double y, double radius) const {
    const auto foot = smooth.foot({x, y, 0.04}, tree.nearest({x, y, 0.04}));
    Patch patch;
    patch.at = foot.at;
    patch.position = foot.position;
    patch.normal = foot.normal;
    patch.axis = Vec3::UnitX();
    patch.a = patch.b = radius;
    return patch;
  }
  // What the ring reads around a patch that carries the load alone.
  Reading read(const Patch& patch) {
    Spread load;
    spreader.spread(patch, load);
    std::vector<double> shares(smooth.surface().vertices.size(), 0.0);
    for (std::size_t k = 0; k < load.vertices.size(); ++k)
      shares[static_cast<std::size_t>(load.vertices[k])] = load.shares[k];
    Reading reading;
    ring.read(patch, shares, 0.0, reading);
    return reading;
  }
};

TEST(Ring, ReadsWhatItFitsAsItself) {
  Block block({12, 12, 6});
  for (const double radius : {0.0, 2e-3, 6e-3, 0.012}) {
    const Patch patch = block.patch(0.0313, 0.0282, radius);
    const Reading reading = block.read(patch);
    double constant = 0.0;
    double slope = 0.0;
    for (std::size_t k = 0; k < reading.vertices.size(); ++k) {
      const double r2 =
          (block.smooth.surface().vertices[static_cast<std::size_t>(reading.vertices[k])] -
           patch.position)
              .squaredNorm();
      constant += reading.weights[k];
      slope += reading.weights[k] * r2;
    }
    // c0 of 1 is 1, but for what the ridge of a thousandth takes where the r^2 stand close
    // together.
    EXPECT_NEAR(constant, 1.0, 0.02) << radius;
    // c0 of r^2 is 0 in the same sense, against squares of 1e-4 m^2.
    EXPECT_NEAR(slope, 0.0, 0.03 * (radius + 0.005) * (radius + 0.005)) << radius;
  }
}

TEST(Ring, DoesNotReadLoadedOrHiddenVertices) {
  Block block({12, 12, 6});
  const Patch patch = block.patch(0.0313, 0.0282, 6e-3);
  Spread load;
  block.spreader.spread(patch, load);
  const Reading reading = block.read(patch);
  ASSERT_FALSE(reading.vertices.empty());
  for (const int vertex : reading.vertices) {
    for (std::size_t k = 0; k < load.vertices.size(); ++k) {
      if (load.shares[k] >= 0.01) {
        EXPECT_NE(vertex, load.vertices[k]);
      }
    }
    EXPECT_EQ(block.smooth.surface().vertices[static_cast<std::size_t>(vertex)].z(), 0.03);
  }
}

TEST(Ring, SpacingIsThatOfThePressedSide) {
  // 5 mm squares on the top, cut in two: 2 triangles of 12.5 mm^2 each, l = sqrt(4 A / sqrt(3)).
  const Block block({12, 12, 1});
  EXPECT_NEAR(block.ring.spacing(block.patch(0.03, 0.03, 0.0)),
              std::sqrt(4.0 * 12.5e-6 / std::sqrt(3.0)), 1e-15);
}

// What the ring says of a smooth field must not jump as the patch grows or moves over vertices.
TEST(Ring, ReadingIsContinuous) {
  Block block;
  const auto field = [&](const Reading& reading) {
    double sum = 0.0;
    for (std::size_t k = 0; k < reading.vertices.size(); ++k) {
      const Vec3& x =
          block.smooth.surface().vertices[static_cast<std::size_t>(reading.vertices[k])];
      sum += reading.weights[k] / (1.0 + (x - Vec3(0.03, 0.03, 0.03)).norm() / 0.02);
    }
    return sum;
  };
  double before = field(block.read(block.patch(0.0313, 0.0282, 1e-4)));
  for (double radius = 1e-4; radius < 0.012; radius += 1e-5) {
    const double now = field(block.read(block.patch(0.0313, 0.0282, radius)));
    EXPECT_NEAR(now / before, 1.0, 0.01) << radius;  // 10 um against a spacing of 9 mm
    before = now;
  }
  before = field(block.read(block.patch(0.02, 0.0282, 3e-3)));
  for (double x = 0.02; x < 0.0599; x += 1e-5) {
    const double now = field(block.read(block.patch(x, 0.0282, 3e-3)));
    EXPECT_NEAR(now / before, 1.0, 0.01) << x;
    before = now;
  }
}

TEST(Ring, HalfSpaceIsTheSumOfPointLoads) {
  Block block({12, 12, 6});
  const Patch patch = block.patch(0.0313, 0.0282, 2e-3);
  Spread load;
  block.spreader.spread(patch, load);
  constexpr double modulus = 8e4;
  const double spacing = block.ring.spacing(patch);
  for (std::size_t v = 0; v < block.smooth.surface().vertices.size(); ++v) {
    const double r = (block.smooth.surface().vertices[v] - patch.position).norm();
    double got = 0.0;
    for (std::size_t j = 0; j < load.vertices.size(); ++j)
      got += load.shares[j] *
             block.ring.half_space(static_cast<int>(v), load.vertices[j], modulus, spacing);
    EXPECT_TRUE(std::isfinite(got));
    if (r < 0.03) continue;
    // Far off the patch is a point; its nodes of up to 6 mm away add their squares over 2 r^2.
    EXPECT_NEAR(got * 3.14159265358979324 * modulus * r, 1.0, 0.02);
  }
}

TEST(HalfSpace, SinksAsHertzSays) {
  // 3 F / (4 a E') under the centre and half of it at the rim, where the sphere is h and h / 2
  // deep.
  constexpr double force = 0.7, a = 3e-3, modulus = 8e4;
  EXPECT_NEAR(contact::half_space_sinking(0.0, force, a, modulus),
              3.0 * force / (4.0 * a * modulus), 1e-12);
  EXPECT_NEAR(contact::half_space_sinking(a, force, a, modulus), 3.0 * force / (8.0 * a * modulus),
              1e-12);
  // No jump at the rim, and a point load far away.
  EXPECT_NEAR(contact::half_space_sinking(a * (1.0 + 1e-9), force, a, modulus) /
                  contact::half_space_sinking(a, force, a, modulus),
              1.0, 1e-8);
  EXPECT_NEAR(contact::half_space_sinking(100.0 * a, force, a, modulus) /
                  contact::half_space_sinking(100.0 * a, force, 0.0, modulus),
              1.0, 1e-4);  // 1 + a^2 / (10 r^2)
}

}  // namespace
}  // namespace palpate
