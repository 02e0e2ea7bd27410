// Coupled springs against elasticity: beams that lock or do not, and the order at which the error
// of a known solution falls.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "base/cholesky.h"
#include "jittered_block.h"

namespace palpate {
namespace {

using geometry::CellPattern;
using geometry::TetMesh;
using tissue::Isotropic;
using tissue::Network;
using tissue::Vector;
using tissue::Volume;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

// u = curl (psi, psi, psi) in a clamped unit cube, psi = s(x) s(y) s(z), s(t) = sin^2(pi t): no
// displacement on the skin and no change of volume anywhere, so that it solves
// -mu (laplacian of u) = f whatever nu is.
struct Swirl {
  // s and its first three derivatives.
  static std::array<double, 4> wave(double t) {
    const double a = 2.0 * std::numbers::pi;
    return {0.5 - 0.5 * std::cos(a * t), 0.5 * a * std::sin(a * t), 0.5 * a * a * std::cos(a * t),
            -0.5 * a * a * a * std::sin(a * t)};
  }
  // psi differentiated i, j, k times along x, y, z.
  static double psi(const Vec3& x, int i, int j, int k) {
    return wave(x.x())[index(i)] * wave(x.y())[index(j)] * wave(x.z())[index(k)];
  }
  // The gradient of psi, or that of its Laplacian.
  static Vec3 slope(const Vec3& x) { return {psi(x, 1, 0, 0), psi(x, 0, 1, 0), psi(x, 0, 0, 1)}; }
  static Vec3 laplacian_slope(const Vec3& x) {
    return {psi(x, 3, 0, 0) + psi(x, 1, 2, 0) + psi(x, 1, 0, 2),
            psi(x, 2, 1, 0) + psi(x, 0, 3, 0) + psi(x, 0, 1, 2),
            psi(x, 2, 0, 1) + psi(x, 0, 2, 1) + psi(x, 0, 0, 3)};
  }
  static Vec3 curl(const Vec3& slope) {
    return {slope.y() - slope.z(), slope.z() - slope.x(), slope.x() - slope.y()};
  }
};

// The root of the mean squared error of the nodes' displacements over that of the displacements.
double swirl_error(const TetMesh& mesh, double nu, Volume volume) {
  const Isotropic tissue{1.0, nu};
  const Network network = test::coupled_network(mesh, {tissue}, volume, 0.05);
  const std::vector<double> volumes = tissue::node_volumes(mesh, std::array{1.0});
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  for (const auto& face : geometry::boundary_faces(mesh))
    for (const int node : face)
      for (int axis = 0; axis < 3; ++axis) held[index(3 * node + axis)] = 1;
  Vector load = Vector::Zero(3 * network.nodes());
  for (int i = 0; i < network.nodes(); ++i)
    if (held[index(3 * i)] == 0)
      load.segment<3>(3 * i) = -tissue::shear_modulus(tissue) * volumes[index(i)] *
                               Swirl::curl(Swirl::laplacian_slope(mesh.nodes[index(i)]));
  Cholesky factors;
  EXPECT_TRUE(factors.factor(tissue::stiffness_matrix(network).split(held)));
  const Vector moved = factors.solve(load);
  double error = 0.0;
  double size = 0.0;
  for (int i = 0; i < network.nodes(); ++i) {
    const Vec3 want = Swirl::curl(Swirl::slope(mesh.nodes[index(i)]));
    error += volumes[index(i)] * (moved.segment<3>(3 * i) - want).squaredNorm();
    size += volumes[index(i)] * want.squaredNorm();
  }
  return std::sqrt(error / size);
}

// A unit cube of irregular tetrahedra, `cells` along each side.
TetMesh unit_cube(int cells) {
  TetMesh mesh = test::jittered_block({cells, cells, cells});
  for (Vec3& node : mesh.nodes) node *= 100.0 / cells;
  return mesh;
}

TEST(CoupledSprings, ErrorFallsWithTheSquareOfTheCells) {
  const TetMesh coarse = unit_cube(6);
  const TetMesh fine = unit_cube(12);
  const auto order = [&](double nu, Volume volume) {
    return std::log2(swirl_error(coarse, nu, volume) / swirl_error(fine, nu, volume));
  };
  // Linear tetrahedra are of second order; on these meshes the error still falls somewhat faster.
  EXPECT_GT(order(0.0, Volume::tetrahedron), 1.9);
  EXPECT_GT(order(0.3, Volume::nodal), 1.9);
  EXPECT_GT(order(0.49, Volume::nodal), 1.9);
}

// At nu = 0.499 each tetrahedron by itself cannot swirl without a change of volume.
TEST(CoupledSprings, AveragedVolumesDoNotLock) {
  const TetMesh mesh = unit_cube(8);
  EXPECT_GT(swirl_error(mesh, 0.499, Volume::tetrahedron), 0.8);  // hardly moves at all
  EXPECT_LT(swirl_error(mesh, 0.499, Volume::nodal), 0.1);
}

// Cantilever of 12 x 3 x 3 cells of the same orientation under a dead load, which falls on the
// end's nodes as their masses do: mean deflection of the end over Timoshenko's beam,
// F L^3 / (3 E I) + F L / (5/6 G A).
double cantilever(double nu, Volume volume, double own_share) {
  const TetMesh mesh = test::cantilever_mesh();
  const Isotropic tissue{1.0, nu};
  return test::cantilever_over_beam(mesh, test::coupled_network(mesh, {tissue}, volume, own_share),
                                    tissue::shear_modulus(tissue));
}

TEST(CoupledSprings, CantileversOfTheCases) {
  struct Row {
    const char* id;
    double nu;
    Volume volume;
    double want;
  };
  // cases/physics.csv, each with its tolerance of 1e-5
  const Row rows[] = {{"lock-02", 0.3, Volume::nodal, 0.79897915},
                      {"lock-03", 0.49, Volume::tetrahedron, 0.21845861},
                      {"lock-04", 0.49, Volume::nodal, 0.69432626},
                      {"lock-05", 0.499, Volume::tetrahedron, 0.078807959},
                      {"lock-06", 0.499, Volume::nodal, 0.66231655}};
  for (const Row& row : rows)
    EXPECT_NEAR(cantilever(row.nu, row.volume, 0.0), row.want, 1e-5 * row.want) << row.id;
}

// What the tetrahedra keep is counted in mu: it costs as little at nu = 0.4995 as at 0.3.
TEST(CoupledSprings, OwnShareDoesNotLock) {
  for (const double nu : {0.3, 0.49, 0.4995}) {
    const double without = cantilever(nu, Volume::nodal, 0.0);
    const double with = cantilever(nu, Volume::nodal, 0.05);
    EXPECT_LT(with, without);
    EXPECT_GT(with, 0.995 * without) << nu;
  }
}

// A block of 2 x 2 x 1 between bonded plates, `cells` over its height: mean pressure over E and the
// shortening, at nu = 0.499.
double bonded_block(int cells, CellPattern pattern, Volume volume) {
  const TetMesh mesh = geometry::cuboid(Vec3(2, 2, 1), {2 * cells, 2 * cells, cells}, pattern);
  const Network network = test::coupled_network(mesh, {{1.0, 0.499}}, volume, 0.0);
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  Vector moved = Vector::Zero(3 * network.nodes());
  for (const double plate : {0.0, 1.0})
    for (const int node : geometry::nodes_at_height(mesh, plate)) {
      for (int axis = 0; axis < 3; ++axis) held[index(3 * node + axis)] = 1;
      moved[3 * node + 2] = plate;
    }
  Vector force = test::elastic_force(network, tissue::Kinematics::linear, moved);
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] != 0) force[static_cast<Eigen::Index>(d)] = 0.0;
  Cholesky factors;
  EXPECT_TRUE(factors.factor(tissue::stiffness_matrix(network).split(held)));
  moved -= factors.solve(force);
  force = test::elastic_force(network, tissue::Kinematics::linear, moved);
  double pull = 0.0;
  for (const int node : geometry::nodes_at_height(mesh, 1.0)) pull += force[3 * node + 2];
  return pull / 4.0;
}

// Computed independently of this project, to the digits that are given.
TEST(CoupledSprings, BondedBlocks) {
  EXPECT_NEAR(bonded_block(2, CellPattern::kuhn, Volume::tetrahedron), 48.0, 0.5);
  EXPECT_NEAR(bonded_block(4, CellPattern::kuhn, Volume::tetrahedron), 14.0, 0.5);
  EXPECT_NEAR(bonded_block(2, CellPattern::kuhn, Volume::nodal), 10.8, 0.05);
  EXPECT_NEAR(bonded_block(4, CellPattern::kuhn, Volume::nodal), 2.13, 0.005);
  EXPECT_NEAR(bonded_block(2, CellPattern::mirrored, Volume::nodal), 24.0, 0.5);
  EXPECT_NEAR(bonded_block(4, CellPattern::mirrored, Volume::nodal), 2.15, 0.005);
}

}  // namespace
}  // namespace palpate
