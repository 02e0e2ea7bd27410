// Balls on blocks in equilibrium: Hertz's force, closed forms of uniform states, incompressibility.
#include "solid/press.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/hertz.h"
#include "geometry/cuboid.h"

namespace palpate::solid {
namespace {

// A quarter of a block of side 2 x `half` and height `half`, bonded at its base, with elements of
// `size` under the ball.
Body block(double half, std::array<int, 3> cells, double ratio, const tissue::Isotropic& tissue) {
  Body body;
  body.mesh = quadratic(geometry::cuboid({half, half, half}, cells, geometry::CellPattern::mirrored,
                                         {ratio, Vec3(0.0, 0.0, half)}));
  body.tissues = {tissue};
  body.held.assign(3 * body.mesh.nodes.size(), 0);
  for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n) {
    const Vec3& x = body.mesh.nodes[n];
    for (std::size_t i = 0; i < 3; ++i)
      if (x.z() < 1e-9 || (i < 2 && x[static_cast<Eigen::Index>(i)] < 1e-9))
        body.held[3 * n + i] = 1;
  }
  for (const OuterFace& face : body.mesh.boundary)
    if (std::all_of(face.nodes.begin(), face.nodes.end(),
                    [&](int n) { return body.mesh.nodes[std::size_t(n)].z() > half - 1e-9; }))
      body.met.push_back(face);
  body.copies = 4;
  body.mirrored = {true, true};
  double least = half;
  for (const auto& node : body.mesh.nodes)
    if (node.x() > 1e-9) least = std::min(least, 2.0 * node.x());
  body.size = least;
  body.travel = 1e-3;
  return body;
}

// What the penalty lets through is taken out to first order: F ~ depth^1.5.
double corrected(const Answer& answer, double depth) {
  return answer.normal() * (1.0 + 1.5 * answer.lost / depth);
}

TEST(SolidPress, HasHertzsForceOnALargeBlock) {
  const tissue::Isotropic tissue{10e3, 0.3};
  const double radius = 10e-3, depth = 0.05e-3, half = 15e-3;  // a = 0.71 mm
  Body body = block(half, {9, 9, 9}, 20.0, tissue);
  body.travel = depth;
  Press press(std::move(body));
  press.set_finger({Indenter::sphere(Vec3(0.0, 0.0, half + radius), radius)});
  press.begin(Vec3::Zero());
  const auto found = press.go(Vec3(0.0, 0.0, -depth));
  ASSERT_TRUE(found);
  const double modulus = tissue.young_modulus / (1.0 - 0.09);
  const double hertz = 4.0 / 3.0 * modulus * std::sqrt(radius) * std::pow(depth, 1.5);
  // An exact layer of this thickness has 1.043, the block with its sides 1.039 by linear
  // elasticity; two elements per contact radius are 1 to 2 % high.
  EXPECT_NEAR(corrected(*found, depth) / hertz, 1.039, 0.025);
  EXPECT_EQ(found->touching, 1);
  EXPECT_NEAR(std::sqrt(found->area / M_PI) / std::sqrt(radius * depth), 1.0,
              0.15);  // points are a third of an element apart
  EXPECT_EQ(found->force.x(), 0.0);
}

// An equilibrium is the same by any way, by long steps or with a last one of almost nothing.
TEST(SolidPress, ForcesDoNotDependOnTheWay) {
  const double radius = 10e-3, depth = 1e-3, half = 15e-3;
  const auto force_by = [&](std::initializer_list<double> way) {
    Press press(block(half, {6, 6, 6}, 4.0, {10e3, 0.45}));
    press.set_finger({Indenter::sphere(Vec3(0.0, 0.0, half + radius), radius)});
    press.begin(Vec3::Zero());
    double force = 0.0;
    for (const double share : way) {
      const auto found = press.go(Vec3(0.0, 0.0, -share * depth));
      if (!found) return std::nan("");
      force = found->normal();
    }
    return force;
  };
  const double want = force_by({0.25, 0.5, 1.0});
  for (const auto& way : {std::initializer_list<double>{1.0},
                          {0.4, 0.9999, 1.0},
                          {0.5, 0.8, 1.0},
                          {0.25, 0.5, 1.0, 0.9998, 1.0}})
    EXPECT_NEAR(force_by(way), want, 2e-4 * want);
}

// A cup as wide as flat on a free block: uniaxial compression, in closed form.
TEST(SolidPress, CompressesABlockAsTheLawSays) {
  const tissue::Isotropic tissue{10e3, 0.4};
  Body body = block(10e-3, {2, 2, 2}, 1.0, tissue);
  for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n) {
    const Vec3& x = body.mesh.nodes[n];
    for (std::size_t i = 0; i < 3; ++i)
      body.held[3 * n + i] = x[static_cast<Eigen::Index>(i)] < 1e-9 ? 1 : 0;
  }
  Press press(std::move(body));
  const double flat = 1e3;  // m
  press.set_finger({{.pole = Vec3(0.0, 0.0, 10e-3), .curvature = {-1.0 / flat, -1.0 / flat}}});
  press.begin(Vec3::Zero());
  const double depth = 3e-3;
  const auto found = press.go(Vec3(0.0, 0.0, -depth));
  ASSERT_TRUE(found);
  // sigma_across = 0: mu J^(-5/3) (m^2 - I/3) + kappa (J - 1) = 0, solved for m by bisection.
  const double along = 1.0 - (depth - found->lost) / 10e-3;
  const double mu = tissue::shear_modulus(tissue), kappa = tissue::bulk_modulus(tissue);
  const auto stress = [&](double m, bool across) {
    const double j = along * m * m;
    const double mean = (along * along + 2.0 * m * m) / 3.0;
    return mu * std::pow(j, -5.0 / 3.0) * ((across ? m * m : along * along) - mean) +
           kappa * (j - 1.0);
  };
  double low = 1.0, high = 2.0;
  for (int i = 0; i < 60; ++i) {
    const double m = 0.5 * (low + high);
    (stress(m, true) < 0.0 ? low : high) = m;
  }
  const double want = -stress(low, false) * low * low * 4.0 * 1e-4;  // on 2 x 2 cm
  EXPECT_NEAR(found->normal(), want, 1e-4 * want);  // the penalty's depth is uneven at the rims
}

// Each of Newton's steps had its own before; where they lead to is that of
// ForcesDoNotDependOnTheWay.
TEST(SolidPress, OneFactorisationServesSeveralSteps) {
  Press press(block(15e-3, {6, 6, 6}, 4.0, {10e3, 0.45}));
  press.set_finger({Indenter::sphere(Vec3(0.0, 0.0, 25e-3), 10e-3)});
  press.begin(Vec3::Zero());
  ASSERT_TRUE(press.go(Vec3(0.0, 0.0, -1e-3)));
  EXPECT_LE(press.factorisations(), 1);
}

// Between nu = 0.499 and 0.4999 the force changes by little, and Newton's steps do not stall.
TEST(SolidPress, StandsIncompressibility) {
  double force[2];
  int i = 0;
  for (const double nu : {0.499, 0.4999}) {
    Press press(block(15e-3, {5, 5, 5}, 6.0, {10e3, nu}));
    press.set_finger({Indenter::sphere(Vec3(0.0, 0.0, 25e-3), 10e-3)});
    press.begin(Vec3::Zero());
    const double depth = 1e-3;
    const auto found = press.go(Vec3(0.0, 0.0, -depth));
    ASSERT_TRUE(found) << nu;
    EXPECT_LT(press.factorisations(), 20) << nu;
    force[i++] = corrected(*found, depth);
  }
  EXPECT_NEAR(force[1] / force[0], 1.0, 0.004);
  // Hertz's force for nu = 1/2, raised by a base at 15 mm under a = 3.2 mm, lowered by the sides.
  const double hertz = 16.0 / 9.0 * 10e3 * std::sqrt(10e-3) * std::pow(1e-3, 1.5);
  EXPECT_GT(force[1], 1.1 * hertz);
  EXPECT_LT(force[1], 1.4 * hertz);
}

}  // namespace
}  // namespace palpate::solid
