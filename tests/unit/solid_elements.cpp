// Neo-Hookean quadratic tetrahedra: derivatives, uniform states, rotations, incompressibility.
#include "solid/elements.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "geometry/cuboid.h"
#include "solid/press.h"

namespace palpate::solid {
namespace {

using tissue::Isotropic;

geometry::TetMesh block(const std::array<int, 3>& cells = {2, 2, 2}) {
  return geometry::cuboid({0.02, 0.015, 0.01}, cells, geometry::CellPattern::mirrored);
}

// Its middles are moved off the straight edges, so that elements are curved.
Mesh curved_block() {
  return quadratic(block(), [n = 0](const auto& corners) mutable {
    return std::optional(Vec3(
        Vec3(0.0, 0.0, 2e-4 * std::sin(++n)) +
        0.5 * (block().nodes[std::size_t(corners[0])] + block().nodes[std::size_t(corners[1])])));
  });
}

std::vector<char> free_of(const Mesh& mesh) { return std::vector<char>(3 * mesh.nodes.size(), 0); }

// A displacement that is linear in the place: (stretch - 1) x.
Vector stretched(const Mesh& mesh, const Eigen::Matrix3d& stretch) {
  Vector u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    u.segment<3>(3 * static_cast<Eigen::Index>(n)) =
        (stretch - Eigen::Matrix3d::Identity()) * mesh.nodes[n];
  return u;
}

Vector bent(const Mesh& mesh) {
  Vector u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Vec3& x = mesh.nodes[n];
    u.segment<3>(3 * static_cast<Eigen::Index>(n)) =
        Vec3(0.2 * x.x() + 9.0 * x.y() * x.z(), 0.1 * x.z() - 5.0 * x.x() * x.x(),
             -0.2 * x.z() + 0.15 * x.x());
  }
  return u;
}

Vector wave(Eigen::Index size) {
  Vector along(size);
  for (Eigen::Index d = 0; d < size; ++d) along[d] = std::sin(1.0 + 2.3 * double(d));
  return along.normalized();
}

class Poisson : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Ratios, Poisson, testing::Values(0.1, 0.45, 0.47, 0.4999));

// With the pressures of the state itself the stiffness is the derivative of the force.
TEST_P(Poisson, ForceIsTheGradientOfTheEnergyAndStiffnessThatOfTheForce) {
  const Mesh mesh = curved_block();
  const Isotropic tissue{50e3, GetParam()};
  Elements solid(mesh, {&tissue, 1}, free_of(mesh));
  const Vector at = bent(mesh);
  solid.advance(at, Vector::Zero(at.size()), 1.0);
  Vector force, before, after;
  Eigen::SparseMatrix<double> stiffness, other;
  EXPECT_GT(solid.assemble(at, force, stiffness), 0.3);
  const Vector along = wave(at.size());
  const double step = 1e-7;
  const double slope =
      (solid.energy(at + step * along) - solid.energy(at - step * along)) / (2.0 * step);
  EXPECT_NEAR(slope, force.dot(along), 1e-6 * force.norm());
  solid.assemble(at + step * along, after, other);
  solid.assemble(at - step * along, before, other);
  const Vector want = (after - before) / (2.0 * step);
  const Vector product = stiffness.selfadjointView<Eigen::Lower>() * along;
  EXPECT_LT((product - want).norm(), 1e-6 * want.norm());
}

// The patch test: a uniform strain leaves no force at nodes inside, whatever the elements' shapes.
TEST_P(Poisson, UniformStrainNeedsNoForceInside) {
  geometry::TetMesh moved = block({2, 2, 2});
  moved.nodes[13] += Vec3(1e-3, -1e-3, 5e-4);  // the middle one
  const Mesh mesh = quadratic(moved);
  const Isotropic tissue{50e3, GetParam()};
  Elements solid(mesh, {&tissue, 1}, free_of(mesh));
  Eigen::Matrix3d stretch;
  stretch << 1.2, 0.1, -0.05, 0.0, 0.9, 0.2, 0.1, -0.1, 0.95;
  Vector force;
  Eigen::SparseMatrix<double> stiffness;
  solid.assemble(stretched(mesh, stretch), force, stiffness);
  const double largest = force.cwiseAbs().maxCoeff();
  std::vector<char> outer(mesh.nodes.size(), 0);
  for (const OuterFace& face : mesh.boundary)
    for (const int node : face.nodes) outer[std::size_t(node)] = 1;
  int inside = 0;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (outer[n] != 0) continue;
    ++inside;
    EXPECT_LT(force.segment<3>(3 * static_cast<Eigen::Index>(n)).norm(), 1e-11 * largest);
  }
  EXPECT_GT(inside, 20);
}

TEST_P(Poisson, RotationsNeedNoForce) {
  const Mesh mesh = curved_block();
  const Isotropic tissue{50e3, GetParam()};
  Elements solid(mesh, {&tissue, 1}, free_of(mesh));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vec3(1.0, -2.0, 0.5).normalized()).matrix();
  Vector force;
  Eigen::SparseMatrix<double> stiffness;
  EXPECT_NEAR(solid.assemble(stretched(mesh, turn), force, stiffness), 1.0, 1e-12);
  const double modulus = tissue::bulk_modulus(tissue) + tissue.young_modulus;
  EXPECT_LT(force.cwiseAbs().maxCoeff(), 1e-12 * modulus * 1e-4);  // of a stress on 1 cm^2
}

// Stretched by L along z and by M across: the energy per volume in closed form.
TEST_P(Poisson, EvenStretchHasItsEnergy) {
  const Mesh mesh = quadratic(block());
  const Isotropic tissue{50e3, GetParam()};
  Elements solid(mesh, {&tissue, 1}, free_of(mesh));
  const double along = 0.6, across = 1.25;
  const double j = along * across * across;
  const double invariant = (along * along + 2.0 * across * across) / std::cbrt(j * j);
  const double want = 0.02 * 0.015 * 0.01 *
                      (0.5 * tissue::shear_modulus(tissue) * (invariant - 3.0) +
                       0.5 * tissue::bulk_modulus(tissue) * (j - 1.0) * (j - 1.0));
  EXPECT_NEAR(solid.energy(stretched(mesh, Vec3(across, across, along).asDiagonal())), want,
              1e-10 * want);
}

// At rest the matrix is that of linear elasticity: 1/2 u K u = V (mu dev:dev + kappa/2 tr^2).
TEST_P(Poisson, IsLinearElasticityAtRest) {
  const Mesh mesh = quadratic(block());
  const Isotropic tissue{50e3, GetParam()};
  Elements solid(mesh, {&tissue, 1}, free_of(mesh));
  Vector force;
  Eigen::SparseMatrix<double> stiffness;
  solid.assemble(Vector::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size())), force, stiffness);
  EXPECT_EQ(force.norm(), 0.0);
  Eigen::Matrix3d strain;
  strain << 0.010, 0.002, -0.003, 0.002, -0.006, 0.001, -0.003, 0.001, 0.004;
  const Vector u = stretched(mesh, Eigen::Matrix3d::Identity() + strain);
  const double trace = strain.trace();
  const double want = 0.02 * 0.015 * 0.01 *
                      (tissue::shear_modulus(tissue) * (strain.squaredNorm() - trace * trace / 3) +
                       0.5 * tissue::bulk_modulus(tissue) * trace * trace);
  const Vector product = stiffness.selfadjointView<Eigen::Lower>() * u;
  EXPECT_NEAR(0.5 * u.dot(product), want, 1e-9 * want);
}

TEST(SolidContact, ForceIsTheGradientOfTheEnergyAndStiffnessThatOfTheForceOfFlats) {
  const Mesh mesh = curved_block();
  const Isotropic tissue{50e3, 0.4};
  Elements solid(mesh, {&tissue, 1}, free_of(mesh));
  const Contact contact(solid, mesh.boundary, 1e8);
  const std::vector<Indenter> balls{Indenter::sphere(Vec3(0.008, 0.007, 0.0185), 0.009),
                                    {.pole = Vec3(0.012, 0.007, 0.0102),
                                     .curvature = {-1.0 / 0.0102, -1.0 / 0.0102},
                                     .share = 0.7}};
  const Vector at = 0.1 * bent(mesh);
  Eigen::SparseMatrix<double> stiffness, other;
  Vector none, before, after;
  std::vector<Met> met;
  solid.assemble(at, none, stiffness);
  std::span<const Indenter> fingers = balls;
  const auto add = [&](const Vector& u, Vector& force, Eigen::SparseMatrix<double>& matrix) {
    force.setZero(u.size());
    matrix = stiffness;
    matrix *= 0.0;
    contact.add(u, fingers, {}, force, matrix, met);
  };
  Vector force;
  add(at, force, other);
  EXPECT_GT(met[0].area, 1e-5);
  EXPECT_GT(met[1].area, 1e-5);
  EXPECT_LT((met[0].force + met[1].force +
             [&] {
               Vec3 sum = Vec3::Zero();
               for (Eigen::Index d = 0; d < force.size(); d += 3) sum += force.segment<3>(d);
               return sum;
             }())
                .norm(),
            1e-12 * met[0].force.norm());
  const Vector along = wave(at.size());
  const double step = 1e-9;
  const double slope =
      (contact.energy(at + step * along, balls) - contact.energy(at - step * along, balls)) /
      (2.0 * step);
  EXPECT_NEAR(slope, force.dot(along), 1e-6 * force.norm());
  // The part of the stiffness that is excluded has the indenters' curvature as a factor.
  const std::vector<Indenter> flats{{.pole = Vec3(0.008, 0.007, 0.0095)},
                                    {.pole = Vec3(0.012, 0.007, 0.0097), .share = 0.7}};
  fingers = flats;
  add(at, force, other);
  EXPECT_GT(met[0].area, 1e-5);
  EXPECT_GT(met[1].area, 1e-5);
  const Vector product = other.selfadjointView<Eigen::Lower>() * along;
  Eigen::SparseMatrix<double> unused;
  add(at + step * along, after, unused);
  add(at - step * along, before, unused);
  const Vector want = (after - before) / (2.0 * step);
  EXPECT_LT((product - want).norm(), 1e-5 * want.norm());
}

}  // namespace
}  // namespace palpate::solid
