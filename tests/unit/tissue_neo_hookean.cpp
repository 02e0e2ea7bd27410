// Neo-Hookean tetrahedra: derivatives, uniform states, volumes.
#include "tissue/neo_hookean.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/cuboid.h"

namespace palpate::tissue {
namespace {

using Vector = NeoHookean::Vector;

constexpr double own_share = 0.05;

geometry::TetMesh block() {
  return geometry::cuboid({0.02, 0.015, 0.01}, {2, 2, 2}, geometry::CellPattern::mirrored);
}

// A smooth displacement that bends and stretches by tens of percent.
Vector bent(const geometry::TetMesh& mesh) {
  Vector moved(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Vec3& x = mesh.nodes[n];
    moved.segment<3>(3 * static_cast<Eigen::Index>(n)) =
        Vec3(0.2 * x.x() + 9.0 * x.y() * x.z(), 0.1 * x.z() - 5.0 * x.x() * x.x(),
             -0.25 * x.z() + 0.15 * x.x());
  }
  return moved;
}

TEST(NeoHookean, ForceIsTheGradientOfTheEnergyAndStiffnessThatOfTheForce) {
  const geometry::TetMesh mesh = block();
  const Isotropic tissue{50e3, 0.47};
  NeoHookean solid(mesh, {&tissue, 1}, own_share);
  const Vector at = bent(mesh);
  const double energy = solid.energy(at);
  ASSERT_TRUE(std::isfinite(energy));
  Vector force, before, after;
  solid.force(force);
  const std::vector<char> held(static_cast<std::size_t>(at.size()), 0);
  const SplitMatrix stiffness = solid.stiffness(held, false);
  Vector along(at.size());
  for (Eigen::Index d = 0; d < at.size(); ++d) along[d] = std::sin(1.0 + 2.3 * double(d));
  along.normalize();
  const double step = 1e-7;
  const double more = solid.energy(at + step * along);
  solid.force(after);
  const double less = solid.energy(at - step * along);
  solid.force(before);
  EXPECT_NEAR((more - less) / (2.0 * step), force.dot(along), 1e-6 * force.norm());
  const Vector wanted = (after - before) / (2.0 * step);
  EXPECT_LT((stiffness * along - wanted).norm(), 1e-6 * wanted.norm());
}

// At rest the matrix is that of linear elasticity: 1/2 u K u = 1/2 V strain : C strain.
TEST(NeoHookean, IsLinearElasticityAtRest) {
  const geometry::TetMesh mesh = block();
  const Isotropic tissue{50e3, 0.4};
  NeoHookean solid(mesh, {&tissue, 1}, own_share);
  const auto size = 3 * static_cast<Eigen::Index>(mesh.nodes.size());
  EXPECT_NEAR(solid.energy(Vector::Zero(size)), 0.0, 1e-20);
  const std::vector<char> held(static_cast<std::size_t>(size), 0);
  for (const bool bounded : {false, true}) {
    const SplitMatrix stiffness = solid.stiffness(held, bounded);
    Eigen::Matrix3d strain;
    strain << 0.010, 0.002, -0.003, 0.002, -0.006, 0.001, -0.003, 0.001, 0.004;
    Vector moved(size);
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      moved.segment<3>(3 * static_cast<Eigen::Index>(n)) = strain * mesh.nodes[n];
    const double shear = shear_modulus(tissue), bulk = bulk_modulus(tissue);
    const double trace = strain.trace();
    const double density =
        shear * (strain.squaredNorm() - trace * trace / 3.0) + 0.5 * bulk * trace * trace;  // J/m^3
    const double energy = density * geometry::volume(mesh);
    EXPECT_NEAR(0.5 * moved.dot(stiffness * moved), energy, 1e-9 * energy) << bounded;
  }
}

// Stretched evenly by L along z and by M across: the energy per volume in closed form.
TEST(NeoHookean, EvenStretchHasItsEnergy) {
  const geometry::TetMesh mesh = block();
  const Isotropic tissue{50e3, 0.45};
  NeoHookean solid(mesh, {&tissue, 1}, own_share);
  const double long_stretch = 0.6, across = 1.25;
  Vector moved(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    moved.segment<3>(3 * static_cast<Eigen::Index>(n)) =
        mesh.nodes[n].cwiseProduct(Vec3(across - 1.0, across - 1.0, long_stretch - 1.0));
  const double j = long_stretch * across * across;
  const double invariant = (long_stretch * long_stretch + 2.0 * across * across) / std::cbrt(j * j);
  const double want = geometry::volume(mesh) * (0.5 * shear_modulus(tissue) * (invariant - 3.0) +
                                                0.5 * bulk_modulus(tissue) * (j - 1.0) * (j - 1.0));
  EXPECT_NEAR(solid.energy(moved), want, 1e-10 * want);
}

TEST(NeoHookean, InsideOutHasNoEnergy) {
  const geometry::TetMesh mesh = block();
  const Isotropic tissue{50e3, 0.45};
  NeoHookean solid(mesh, {&tissue, 1}, own_share);
  Vector moved = Vector::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  moved[2] = 0.02;  // the first corner beyond the opposite face
  EXPECT_EQ(solid.energy(moved), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace palpate::tissue
