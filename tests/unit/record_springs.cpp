// Spring stiffness and the stability limit on the paper's cube: groups mss and dt.
#include <gtest/gtest.h>

#include <cmath>

#include "cases.h"
#include "geometry/cuboid.h"
#include "material/tissue_table.h"
#include "tissue/network.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using geometry::CellPattern;
using test::expect_case;

// The paper's cube at 10 mm cells.
geometry::TetMesh cube() {
  return geometry::cuboid(Vec3(0.03, 0.04, 0.06), {3, 4, 6}, CellPattern::kuhn);
}

std::vector<char> on_its_base(const geometry::TetMesh& mesh) {
  return tissue::held_by_base(mesh, tissue::Base::bonded);
}

double limit(const std::string& name) {
  const auto tissue = material::find(name, "", {}).tissue;
  const auto mesh = cube();
  const auto network = tissue::make_network(
      mesh, std::array{tissue.density.value},
      tissue::van_gelder_stiffness(mesh, std::array{tissue.young_modulus.value}));
  return 2.0 / std::sqrt(tissue::largest_frequency_squared(network, on_its_base(mesh)));
}

TEST(StableStep, PaperCube) {
  expect_case("dt-08", limit("skin"));
  expect_case("dt-10", limit("muscle"));
  expect_case("dt-12", limit("bone"));
  expect_case("dt-13", limit("ligament"));
  expect_case("dt-15", limit("upper_leg"));
}

TEST(StableStep, SmallestCellsForThePapersSteps) {
  // The limit grows with the cell: cell = dt / limit(10 mm) * 10 mm.
  expect_case("dt-11", 0.05 / limit("muscle") * 0.01);
  expect_case("dt-14", 0.01 / limit("ligament") * 0.01);
  expect_case("dt-16", 0.05 / limit("upper_leg") * 0.01);
}

TEST(StableStep, MatrixFreeBoundIsSafe) {
  const auto mesh = cube();
  const auto network = tissue::make_network(mesh, std::array{1000.0},
                                            tissue::van_gelder_stiffness(mesh, std::array{1000.0}));
  // c = 1 m/s, so that dt c / h = dt / 0.01 m
  const double safe = tissue::safe_frequency_squared(network);
  expect_case("dt-07", 2.0 / std::sqrt(safe) / 0.01);
  EXPECT_GT(safe, tissue::largest_frequency_squared(network,
                                                    std::vector<char>(3 * mesh.nodes.size(), 0)));
}

// Row sums of |M^-1 K|.
TEST(StableStep, GershgorinOfTheMatrix) {
  const auto mesh = cube();
  const auto network = tissue::make_network(mesh, std::array{1000.0},
                                            tissue::van_gelder_stiffness(mesh, std::array{1000.0}));
  const auto held = std::vector<char>(3 * mesh.nodes.size(), 0);
  const Eigen::MatrixXd matrix = tissue::stiffness_matrix(network).split(held).local;
  double bound = 0.0;
  for (Eigen::Index d = 0; d < matrix.rows(); ++d)
    bound = std::max(
        bound, matrix.row(d).cwiseAbs().sum() / network.node_mass[static_cast<std::size_t>(d / 3)]);
  expect_case("dt-06", 2.0 / std::sqrt(bound) / 0.01);
}

tissue::Uniaxial measured(const geometry::TetMesh& mesh, const std::vector<double>& stiffness,
                          const Vec3& size) {
  const auto network = tissue::make_network(mesh, std::array{1000.0}, stiffness);
  return tissue::uniaxial_test(network, mesh, tissue::Base::frictionless, size.z(),
                               size.x() * size.y());
}

// Cases mss-10 and mss-12 press a 4x4x6 block that rests on three planes of symmetry: the eighth of
// a free block of 8x8x12.
TEST(Stiffness, MirroredBlockByVanGelder) {
  const Vec3 size(0.08, 0.08, 0.12);
  const auto mesh = geometry::cuboid(size, {8, 8, 12}, CellPattern::mirrored);
  expect_case(
      "mss-12",
      measured(mesh, tissue::van_gelder_stiffness(mesh, std::array{1.0}), size).young_modulus);
}

// Class stiffness (axis .56, face .48, body .48) E h, times the tetrahedra at the edge over the
// mean of its class in the lattice: 6, 4, 6.
TEST(Stiffness, MirroredBlockByClasses) {
  const Vec3 size(0.08, 0.08, 0.12);
  const double h = 0.01;
  const auto mesh = geometry::cuboid(size, {8, 8, 12}, CellPattern::mirrored);
  const double classes[] = {0.0, 0.56, 0.48, 0.48};  // by the squared length in cells
  const double mean[] = {0.0, 6.0, 4.0, 6.0};
  // Van Gelder's k counts the tetrahedra, each of volume h^3 / 6: k l^2 = E n h^3 / 6.
  std::vector<double> stiffness = tissue::van_gelder_stiffness(mesh, std::array{1.0});
  const auto edges = geometry::edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double l2 = (mesh.nodes[static_cast<std::size_t>(edges[e][1])] -
                       mesh.nodes[static_cast<std::size_t>(edges[e][0])])
                          .squaredNorm();
    const double count = stiffness[e] * l2 / (h * h * h / 6.0);
    const auto kind = static_cast<std::size_t>(std::lround(l2 / (h * h)));
    stiffness[e] = classes[kind] * h * count / mean[kind];
  }
  expect_case("mss-10", measured(mesh, stiffness, size).young_modulus);
}

TEST(Stiffness, FittedIsNeverNegativeAndNearIsotropic) {
  const Vec3 size(0.06, 0.06, 0.03);
  const auto mesh = geometry::cuboid(size, {6, 6, 4}, CellPattern::mirrored);
  const auto fitted = tissue::fitted_stiffness(mesh, tissue::fit_springs(mesh), std::array{1.0});
  for (const double k : fitted) EXPECT_GE(k, 0.0);
  const auto plain = measured(mesh, tissue::van_gelder_stiffness(mesh, std::array{1.0}), size);
  const auto better = measured(mesh, fitted, size);
  // Towards E = 1 and nu = 1/4, the only ratio that central forces have.
  EXPECT_LT(std::abs(better.young_modulus - 1.0), std::abs(plain.young_modulus - 1.0));
  EXPECT_LT(std::abs(better.poisson_ratio - 0.25), std::abs(plain.poisson_ratio - 0.25));
}

TEST(Stiffness, VanGelderHasTheVoigtMeanModulus) {
  // sum k l^2 = 6 E V: the mean over directions is right whatever the mesh.
  const auto mesh = cube();
  const auto stiffness = tissue::van_gelder_stiffness(mesh, std::array{3.0});
  const auto network = tissue::make_network(mesh, std::array{1000.0}, stiffness);
  double sum = 0.0;
  for (std::size_t e = 0; e < stiffness.size(); ++e)
    sum += stiffness[e] * network.rest_length[e] * network.rest_length[e];
  EXPECT_NEAR(sum, 6.0 * 3.0 * 0.03 * 0.04 * 0.06, 1e-15);  // rounding of 679 terms
}

}  // namespace
}  // namespace palpate
