// Independent springs with a term against changes of volume: moduli, volumes, isotropy, locking;
// and how near springs come to a tetrahedron without it.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "base/cholesky.h"
#include "base/dense.h"
#include "base/index.h"
#include "jittered_block.h"
#include "plain_springs.h"
#include "tissue/stiffness.h"

namespace palpate {
namespace {

using geometry::CellPattern;
using geometry::TetMesh;
using tissue::Isotropic;
using tissue::Kinematics;
using tissue::Network;
using tissue::Vector;
using tissue::Volume;

constexpr Volume both_volumes[] = {Volume::tetrahedron, Volume::nodal};

Network hybrid(const TetMesh& mesh, const std::vector<double>& stiffness,
               const std::vector<Isotropic>& tissues, Volume volume) {
  Network network =
      tissue::make_network(mesh, std::vector<double>(tissues.size(), 1000.0), stiffness);
  tissue::add_volume(network, mesh, tissues, volume);
  return network;
}

// A row of cases/physics.csv: printed with eight digits, of which half a unit is open, and 1e-9.
void expect_case(double want, double got, const char* id) {
  const double printed = 0.5 * std::pow(10.0, std::floor(std::log10(want)) - 7.0);
  EXPECT_NEAR(got, want, printed + 1e-9 * want) << id;
}

TEST(Volume, ModuliOfThePapersTissues) {
  const auto spring = [](double nu) { return tissue::spring_modulus({1.0, nu}); };
  const auto volume = [](double nu) { return tissue::volume_modulus({1.0, nu}); };
  expect_case(0.93984962, spring(0.33), "mss-17");
  expect_case(0.35382574, volume(0.33), "mss-18");
  expect_case(0.89285714, spring(0.40), "mss-19");
  expect_case(1.0714286, volume(0.40), "mss-20");
  expect_case(0.96153846, spring(0.30), "mss-21");
  expect_case(0.86206897, spring(0.45), "mss-23");
  expect_case(2.7586207, volume(0.45), "mss-24");
  expect_case(0.19230769, volume(0.30), "mss-26");
  for (const double nu : {-0.9, 0.0, 0.25, 0.4995}) {
    const Isotropic tissue{7e3, nu};
    const double mu = tissue::shear_modulus(tissue);
    const double lambda = tissue::bulk_modulus(tissue) - 2.0 / 3.0 * mu;
    EXPECT_NEAR(tissue::volume_modulus(tissue), lambda - mu, 1e-12 * (std::abs(lambda) + mu));
    EXPECT_NEAR(tissue::spring_modulus(tissue), 2.5 * mu, 1e-12 * mu);  // rounding
  }
}

// Even stretching: theta = tr eps for every volume, and together they are the body's.
TEST(Volume, ChangesAsTheBodyDoes) {
  const TetMesh mesh = test::two_regions(test::jittered_block({4, 3, 2}));
  const Eigen::Matrix3d gradient{{0.01, 0.03, 0.0}, {-0.02, 0.02, 0.01}, {0.0, 0.02, -0.005}};
  const std::vector<Isotropic> tissues{{3e4, 0.4}, {1e5, 0.0}};
  const std::vector<double> none(geometry::edges(mesh).size(), 0.0);
  const Network network = hybrid(mesh, none, tissues, Volume::nodal);
  EXPECT_EQ(network.volumes.size(), mesh.nodes.size() + 12);  // 12 nodes touch both regions
  std::vector<double> elongation(network.ends.size());
  const Vector even = test::linear_displacement(mesh, gradient);
  test::elongations(network, Kinematics::linear, even, elongation);
  std::vector<double> modulus;
  for (const Isotropic& tissue : tissues) modulus.push_back(tissue::volume_modulus(tissue));
  double wanted_sum = 0.0;
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t)
    wanted_sum += geometry::signed_volume(mesh, t) * modulus[as_index(mesh.region(t))];
  double sum = 0.0;
  for (const auto& volume : network.volumes) {
    double change = 0.0;
    for (std::size_t k = 0; k < volume.springs.size(); ++k)
      change += volume.dilation[k] * elongation[as_index(volume.springs[k])];
    EXPECT_NEAR(change, gradient.trace(), 1e-13);  // rounding
    sum += volume.stiffness;
  }
  EXPECT_NEAR(sum, wanted_sum, 1e-12 * std::abs(wanted_sum));  // rounding
}

// sum_v V_v theta_v is the flux through the skin, whatever the displacement.
TEST(Volume, AveragesLoseNothing) {
  const TetMesh mesh = test::jittered_block({3, 2, 2});
  const Isotropic tissue{1.0, 0.4};
  const std::vector<double> none(geometry::edges(mesh).size(), 0.0);
  const Vector moved = test::scattered_displacement(mesh, 1e-3);
  double flux = 0.0;
  for (const auto& [a, b, c] : geometry::boundary_faces(mesh)) {
    const Vec3 area = 0.5 * (mesh.nodes[as_index(b)] - mesh.nodes[as_index(a)])
                                .cross(mesh.nodes[as_index(c)] - mesh.nodes[as_index(a)]);
    for (const int node : {a, b, c}) flux += moved.segment<3>(3 * node).dot(area) / 3.0;
  }
  const Network network = hybrid(mesh, none, {tissue}, Volume::nodal);
  std::vector<double> elongation(network.ends.size());
  test::elongations(network, Kinematics::linear, moved, elongation);
  double sum = 0.0;
  for (const auto& volume : network.volumes)
    for (std::size_t k = 0; k < volume.springs.size(); ++k)
      sum += volume.stiffness / tissue::volume_modulus(tissue) * volume.dilation[k] *
             elongation[as_index(volume.springs[k])];
  EXPECT_NEAR(sum, flux, 1e-12 * std::abs(flux));  // rounding
}

TEST(Volume, IsNotMissedAtAQuarter) {
  const TetMesh mesh = test::two_regions(test::jittered_block({2, 2, 1}));
  const std::vector<double> stiffness = tissue::van_gelder_stiffness(mesh, std::array{1e4, 1e4});
  for (const Volume volume : both_volumes) {
    const Network network = hybrid(mesh, stiffness, {{1e4, 0.25}, {1e4, 0.25}}, volume);
    EXPECT_TRUE(network.coupled.empty());
    EXPECT_TRUE(network.volumes.empty());
    EXPECT_EQ(network.stiffness, stiffness);
  }
  EXPECT_TRUE(hybrid(mesh, stiffness, {{1e4, 0.4}, {1e4, 0.4}}, Volume::none).volumes.empty());
}

// In the mirrored lattice the springs are isotropic (cases mss-08, mss-09): with the volume term
// the mean stress of any even strain is C eps of any nu, also below 1/4.
TEST(Volume, MakesTheIsotropicLatticeAnyMatter) {
  const double h = 0.01;  // m
  const TetMesh mesh =
      geometry::cuboid(Vec3(2 * h, 2 * h, 2 * h), {2, 2, 2}, CellPattern::mirrored);
  // Class stiffness (axis .56, face .48, body .48) E h, shared among 6, 4, 6 tetrahedra each.
  const double classes[] = {0.0, 0.56 / 6.0, 0.48 / 4.0, 0.48 / 6.0};
  const auto edges = geometry::edges(mesh);
  const auto counted = tissue::van_gelder_stiffness(mesh, std::array{1.0});
  const Eigen::Matrix3d strain{
      {0.01, 0.004, -0.003}, {0.004, -0.02, 0.006}, {-0.003, 0.006, 0.005}};
  const Vector even = test::linear_displacement(mesh, strain);
  for (const double nu : {-0.5, 0.0, 0.25, 0.33, 0.45, 0.4995})
    for (const Volume volume : both_volumes) {
      const Isotropic tissue{3e4, nu};
      std::vector<double> stiffness(edges.size());
      for (std::size_t e = 0; e < edges.size(); ++e) {
        const double l2 =
            (mesh.nodes[as_index(edges[e][1])] - mesh.nodes[as_index(edges[e][0])]).squaredNorm();
        const double tetrahedra = counted[e] * l2 / (h * h * h / 6.0);
        stiffness[e] = tissue::spring_modulus(tissue) * h * tetrahedra *
                       classes[static_cast<std::size_t>(std::lround(l2 / (h * h)))];
      }
      const Network network = hybrid(mesh, stiffness, {tissue}, volume);
      const Vector force = test::elastic_force(network, Kinematics::linear, even);
      Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
      for (int i = 0; i < network.nodes(); ++i)
        mean += force.segment<3>(3 * i) * mesh.nodes[as_index(i)].transpose();
      mean /= geometry::volume(mesh);
      const Eigen::Matrix3d want = test::stress(tissue, strain);
      EXPECT_LT((mean - want).norm(), 1e-12 * want.norm()) << nu;  // rounding
    }
}

TEST(Volume, ForceIsTheSlopeOfTheEnergy) {
  const TetMesh mesh = test::two_regions(test::jittered_block({2, 1, 2}));
  const Vector moved = test::scattered_displacement(mesh, 1e-3);
  const auto stiffness = tissue::van_gelder_stiffness(mesh, std::array{1e4, 1e5});
  for (const Volume volume : both_volumes)
    for (const Kinematics kinematics :
         {Kinematics::linear, Kinematics::nonlinear, Kinematics::squared}) {
      const Network network = hybrid(mesh, stiffness, {{1e4, 0.49}, {1e5, 0.1}}, volume);
      test::expect_slope_of_energy(network, kinematics, moved);
    }
}

// Below nu = 1/4 the volume term takes from the springs. Somewhat below they still resist; at nu =
// 0 on an irregular mesh they do not, and the factorisation says so.
TEST(Volume, LeavesSpringsDefiniteOnlyNearAQuarter) {
  const TetMesh mesh = test::jittered_block({3, 3, 2});
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  for (const int node : geometry::nodes_at_height(mesh, 0.0))
    for (int axis = 0; axis < 3; ++axis) held[as_index(3 * node + axis)] = 1;
  for (const double nu : {0.0, 0.2}) {
    const Isotropic tissue{1e4, nu};
    const auto stiffness =
        tissue::van_gelder_stiffness(mesh, std::array{tissue::spring_modulus(tissue)});
    for (const Volume volume : both_volumes) {
      const SplitMatrix matrix =
          tissue::stiffness_matrix(hybrid(mesh, stiffness, {tissue}, volume)).split(held);
      const double lowest = dense::symmetric_modes(test::dense(matrix)).values[0];
      EXPECT_EQ(lowest > 0.0, nu > 0.1) << nu << " " << static_cast<int>(volume);
      Cholesky factors;
      EXPECT_EQ(factors.factor(matrix), nu > 0.1) << nu << " " << static_cast<int>(volume);
    }
  }
}

// Regular tetrahedron of edge 1, E = 1, nu = 1/4: the springs nearest to the finite element.
TEST(Volume, OneStiffnessForARegularTetrahedron) {
  TetMesh mesh;
  const double s = 1.0 / std::sqrt(8.0);
  mesh.nodes = {Vec3(s, s, s), Vec3(-s, s, -s), Vec3(s, -s, -s), Vec3(-s, -s, s)};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  ASSERT_NEAR(geometry::signed_volume(mesh, 0), std::sqrt(2.0) / 12.0, 1e-15);  // rounding
  const auto matrix = [](const Network& network) {
    return test::dense(tissue::stiffness_matrix(network).split(test::nothing_held(network)));
  };
  const Eigen::MatrixXd element =
      matrix(test::coupled_network(mesh, {{1.0, 0.25}}, Volume::tetrahedron, 0.0));
  const Eigen::MatrixXd springs =
      matrix(tissue::make_network(mesh, std::array{1.0}, std::vector<double>(6, 1.0)));
  const double best = element.cwiseProduct(springs).sum() / springs.squaredNorm();
  expect_case(0.11313708, best, "mss-14");
  expect_case(0.2, (element - best * springs).norm() / element.norm(), "mss-15");
}

// Cantilever of 12 x 3 x 3 Kuhn cells under a dead load of its end nodes' masses: mean deflection
// of the end over F L^3 / (3 E I) + F L / (5/6 G A).
double cantilever(double nu, Volume volume) {
  const TetMesh mesh = test::cantilever_mesh();
  const Isotropic tissue{1.0, nu};
  const Network network =
      hybrid(mesh, tissue::van_gelder_stiffness(mesh, std::array{tissue::spring_modulus(tissue)}),
             {tissue}, volume);
  return test::cantilever_over_beam(mesh, network, tissue::shear_modulus(tissue));
}

// Computed independently of this project, to the three digits that are given.
TEST(Volume, OfEachTetrahedronLocksAndOfNodesDoesNot) {
  const double ratios[] = {0.3, 0.45, 0.49, 0.499, 0.4999};
  const double locked[] = {0.751, 0.506, 0.267, 0.133, 0.114};
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(cantilever(ratios[i], Volume::tetrahedron), locked[i], 5.1e-4) << ratios[i];
  EXPECT_NEAR(cantilever(0.3, Volume::nodal), 0.779, 5.1e-4);
  EXPECT_NEAR(cantilever(0.4999, Volume::nodal), 0.626, 5.1e-4);
}

}  // namespace
}  // namespace palpate
