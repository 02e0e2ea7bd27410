// Coupled springs are elasticity: the linear finite element, the patch test, St Venant and
// Kirchhoff's law, forces from energies.
#include "plain_springs.h"
#include "tissue/coupled.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/cholesky.h"
#include "base/index.h"
#include "jittered_block.h"

namespace palpate {
namespace {

using geometry::TetMesh;
using tissue::Isotropic;
using tissue::Kinematics;
using tissue::Network;
using tissue::Vector;
using tissue::Volume;

constexpr Kinematics all_kinematics[] = {Kinematics::linear, Kinematics::nonlinear,
                                         Kinematics::squared};
constexpr Volume all_volumes[] = {Volume::none, Volume::tetrahedron, Volume::nodal};
constexpr double ratios[] = {-0.9, -0.3, 0.0, 0.25, 0.33, 0.45, 0.49, 0.4995};
constexpr double own_share = 0.05;  // of mu

// Bulk modulus, Pa: stress over change of volume under even stretching.
double bulk(const Isotropic& tissue) {
  return test::stress(tissue, Eigen::Matrix3d::Identity()).trace() / 9.0;
}

// The part of it that is averaged around nodes, Pa.
double averaged(const Isotropic& tissue, Volume volume, double own) {
  const double shear = tissue.young_modulus / (2.0 * (1.0 + tissue.poisson_ratio));
  return volume == Volume::nodal ? std::max(0.0, bulk(tissue) - own * shear) : 0.0;
}

// Of the textbook: N_i = a_i + g_i . x from the inverse of the corners' matrix.
struct LinearTetrahedron {
  double volume = 0.0;
  Eigen::Matrix<double, 4, 3> gradients;

  LinearTetrahedron(const TetMesh& mesh, int tetrahedron) {
    Eigen::Matrix4d corners;
    for (int i = 0; i < 4; ++i)
      corners.row(i) << 1.0,
          mesh.nodes[as_index(mesh.tetrahedra[as_index(tetrahedron)][as_index(i)])].transpose();
    volume = corners.determinant() / 6.0;
    gradients = corners.inverse().bottomRows<3>().transpose();
  }

  // xx, yy, zz, xy, yz, zx with the engineer's shears.
  [[nodiscard]] Eigen::Matrix<double, 6, 12> strain() const {
    Eigen::Matrix<double, 6, 12> b = Eigen::Matrix<double, 6, 12>::Zero();
    for (int i = 0; i < 4; ++i) {
      const double x = gradients(i, 0), y = gradients(i, 1), z = gradients(i, 2);
      b.middleCols<3>(3 * i) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, 0, z, y, z, 0, x;
    }
    return b;
  }
};

Eigen::Matrix<double, 6, 6> elasticity(const Isotropic& tissue) {
  Eigen::Matrix<double, 6, 6> c = Eigen::Matrix<double, 6, 6>::Zero();
  const double nu = tissue.poisson_ratio;
  c.topLeftCorner<3, 3>().setConstant(nu);
  c.topLeftCorner<3, 3>().diagonal().setConstant(1.0 - nu);
  c.bottomRightCorner<3, 3>().diagonal().setConstant(0.5 - nu);
  return tissue.young_modulus / ((1.0 + nu) * (1.0 - 2.0 * nu)) * c;
}

using Row = Eigen::Matrix<double, 1, Eigen::Dynamic>;

// The stiffness by elements. What the tetrahedra give up of the bulk modulus acts on the mean of
// tr eps around each node, of every region by itself.
Eigen::MatrixXd by_elements(const TetMesh& mesh, const std::vector<Isotropic>& tissues,
                            Volume volume, double own) {
  const auto size = 3 * static_cast<Eigen::Index>(mesh.nodes.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
  const Eigen::Matrix<double, 6, 1> trace{1, 1, 1, 0, 0, 0};
  struct Around {
    Row change;
    double volume = 0.0;
  };
  std::vector<std::vector<Around>> around(
      tissues.size(), std::vector<Around>(mesh.nodes.size(), {Row::Zero(size), 0.0}));
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) {
    const LinearTetrahedron element(mesh, t);
    const Isotropic& tissue = tissues[as_index(mesh.region(t))];
    const double missing = volume == Volume::none ? bulk(tissue) : averaged(tissue, volume, own);
    const auto b = element.strain();
    const Eigen::Matrix<double, 12, 12> k =
        element.volume * b.transpose() *
        (elasticity(tissue) - missing * trace * trace.transpose()) * b;
    const Eigen::Matrix<double, 1, 12> change = element.volume * trace.transpose() * b;
    for (int i = 0; i < 4; ++i) {
      const int row = mesh.tetrahedra[as_index(t)][as_index(i)];
      Around& here = around[as_index(mesh.region(t))][as_index(row)];
      here.volume += element.volume;
      for (int j = 0; j < 4; ++j) {
        const int column = mesh.tetrahedra[as_index(t)][as_index(j)];
        all.block<3, 3>(3 * row, 3 * column) += k.block<3, 3>(3 * i, 3 * j);
        here.change.segment<3>(3 * column) += change.segment<3>(3 * j);
      }
    }
  }
  if (volume != Volume::nodal) return all;
  for (std::size_t region = 0; region < tissues.size(); ++region)
    for (const Around& here : around[region])
      if (here.volume > 0.0)
        all += averaged(tissues[region], volume, own) / (4.0 * here.volume) *
               here.change.transpose() * here.change;
  return all;
}

TEST(Coupled, AreTheLinearTetrahedron) {
  const TetMesh mesh = test::jittered_block({2, 2, 1});
  for (const double nu : ratios)
    for (const Volume volume : all_volumes) {
      const Isotropic tissue{3e4, nu};
      const Network network = test::coupled_network(mesh, {tissue}, volume, own_share);
      const Eigen::MatrixXd got =
          test::dense(tissue::stiffness_matrix(network).split(test::nothing_held(network)));
      const Eigen::MatrixXd want = by_elements(mesh, {tissue}, volume, own_share);
      // rounding of some ten products, the largest of which cancel near nu = 1/2 and -1
      EXPECT_LT((got - want).cwiseAbs().maxCoeff(), 1e-13 * want.cwiseAbs().maxCoeff())
          << nu << " " << static_cast<int>(volume);
    }
}

TEST(Coupled, AverageEveryRegionByItself) {
  const TetMesh mesh = test::two_regions(test::jittered_block({2, 2, 2}));
  const std::vector<Isotropic> tissues{{3e4, 0.45}, {2e6, 0.3}};
  const Network network = test::coupled_network(mesh, tissues, Volume::nodal, own_share);
  const Eigen::MatrixXd want = by_elements(mesh, tissues, Volume::nodal, own_share);
  const Eigen::MatrixXd got =
      test::dense(tissue::stiffness_matrix(network).split(test::nothing_held(network)));
  EXPECT_LT((got - want).cwiseAbs().maxCoeff(), 1e-13 * want.cwiseAbs().maxCoeff());  // rounding
  // The middle plane has 9 nodes with both regions around them.
  EXPECT_EQ(network.volumes.size(), mesh.nodes.size() + 9);
}

TEST(Coupled, ReplaceWhatSpringsHadOfTheirOwn) {
  const TetMesh mesh = test::jittered_block({1, 1, 1});
  const std::vector<Isotropic> tissues{{3e4, 0.4}};
  Network network = test::coupled_network(mesh, tissues, Volume::nodal, 0.0);
  network.stiffness.assign(network.ends.size(), 17.0);
  tissue::couple(network, mesh, tissues, Volume::tetrahedron, 0.0);
  EXPECT_EQ(network.stiffness, std::vector<double>(network.ends.size(), 0.0));
  EXPECT_EQ(network.coupled.size(), mesh.tetrahedra.size());
  EXPECT_TRUE(network.volumes.empty());
}

// The boundary follows a linear field: so does the inside, and the stress is C eps everywhere.
TEST(Coupled, PassThePatchTest) {
  const TetMesh mesh = test::jittered_block({3, 3, 3});
  const double volume_of_block = geometry::volume(mesh);
  const Eigen::Matrix3d gradient{
      {0.010, 0.004, -0.007}, {0.002, -0.006, 0.003}, {0.001, 0.008, 0.005}};
  const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  const Vector wanted = test::linear_displacement(mesh, gradient);
  for (const double nu : ratios)
    for (const Volume volume : all_volumes) {
      const Isotropic tissue{3e4, nu};
      const Network network = test::coupled_network(mesh, {tissue}, volume, own_share);
      std::vector<char> held = test::nothing_held(network);
      for (const auto& face : geometry::boundary_faces(mesh))
        for (const int node : face)
          for (int axis = 0; axis < 3; ++axis) held[as_index(3 * node + axis)] = 1;
      ASSERT_EQ(std::count(held.begin(), held.end(), 0), 3 * 8);
      Vector prescribed = wanted;
      for (std::size_t d = 0; d < held.size(); ++d)
        if (held[d] == 0) prescribed[static_cast<Eigen::Index>(d)] = 0.0;
      Vector residual = test::elastic_force(network, Kinematics::linear, prescribed);
      for (std::size_t d = 0; d < held.size(); ++d)
        if (held[d] != 0) residual[static_cast<Eigen::Index>(d)] = 0.0;
      Cholesky factors;
      ASSERT_TRUE(factors.factor(tissue::stiffness_matrix(network).split(held)));
      const Vector solved = prescribed - factors.solve(residual);
      // rounding times the matrix's condition: K/mu is 1000 at nu = .4995
      const double worst = 1e-12 * std::max(1.0, bulk(tissue) / tissue.young_modulus);
      EXPECT_LT((solved - wanted).cwiseAbs().maxCoeff(), worst * wanted.cwiseAbs().maxCoeff())
          << nu << " " << static_cast<int>(volume);

      // sum of f x^T / V is the mean stress.
      const Vector force = test::elastic_force(network, Kinematics::linear, solved);
      Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
        mean += force.segment<3>(3 * static_cast<Eigen::Index>(i)) * mesh.nodes[i].transpose() /
                volume_of_block;
      Eigen::Matrix3d want = test::stress(tissue, strain);
      if (volume == Volume::none)
        want -= bulk(tissue) * strain.trace() * Eigen::Matrix3d::Identity();
      EXPECT_LT((mean - want).norm(), worst * want.norm()) << nu << " " << static_cast<int>(volume);
    }
}

// Forces of P = F S, S = C E, E = (F^T F - 1) / 2, per element and node: V P g.
TEST(Coupled, SquaredElongationsAreStVenantAndKirchhoffs) {
  const TetMesh mesh = test::jittered_block({2, 1, 1});
  const Isotropic tissue{3e4, 0.4};
  const Vector moved = test::scattered_displacement(mesh, 2e-3);
  const Network network = test::coupled_network(mesh, {tissue}, Volume::tetrahedron, 0.0);
  Vector want = Vector::Zero(moved.size());
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) {
    const LinearTetrahedron element(mesh, t);
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    for (int i = 0; i < 4; ++i)
      f += moved.segment<3>(3 * mesh.tetrahedra[as_index(t)][as_index(i)]) *
           element.gradients.row(i);
    const Eigen::Matrix3d green = 0.5 * (f.transpose() * f - Eigen::Matrix3d::Identity());
    const Eigen::Matrix3d piola = f * test::stress(tissue, green);
    for (int i = 0; i < 4; ++i)
      want.segment<3>(3 * mesh.tetrahedra[as_index(t)][as_index(i)]) +=
          element.volume * piola * element.gradients.row(i).transpose();
  }
  const Vector got = test::elastic_force(network, Kinematics::squared, moved);
  EXPECT_LT((got - want).cwiseAbs().maxCoeff(), 1e-13 * want.cwiseAbs().maxCoeff());  // rounding
}

TEST(Coupled, TurnsOfTheBodyTurnTheForces) {
  const TetMesh mesh = test::jittered_block({2, 2, 1});
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.0, Vec3(1, -2, 3).normalized()).matrix();
  const Vector moved = test::scattered_displacement(mesh, 1e-3);
  Vector turned(moved.size());
  Vector rigid(moved.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const auto d = 3 * static_cast<Eigen::Index>(i);
    turned.segment<3>(d) = turn * (mesh.nodes[i] + moved.segment<3>(d)) - mesh.nodes[i];
    rigid.segment<3>(d) = turn * mesh.nodes[i] - mesh.nodes[i] + Vec3(0.1, 0.0, -0.2);
  }
  for (const Kinematics kinematics : {Kinematics::nonlinear, Kinematics::squared})
    for (const Volume volume : all_volumes) {
      const Network network = test::coupled_network(mesh, {{3e4, 0.49}}, volume, own_share);
      const Vector force = test::elastic_force(network, kinematics, moved);
      const Vector after = test::elastic_force(network, kinematics, turned);
      const double size = force.cwiseAbs().maxCoeff();
      for (Eigen::Index d = 0; d < moved.size(); d += 3)
        EXPECT_LT((after.segment<3>(d) - turn * force.segment<3>(d)).norm(), 1e-12 * size);
      // rounding of places of 0.1 m over elongations of 1 mm
      EXPECT_LT(test::elastic_force(network, kinematics, rigid).norm(), 1e-10 * size);
    }
}

TEST(Coupled, ForceIsTheSlopeOfTheEnergy) {
  const TetMesh mesh = test::two_regions(test::jittered_block({2, 1, 2}));
  const Vector moved = test::scattered_displacement(mesh, 1e-3);
  for (const Kinematics kinematics : all_kinematics)
    for (const Volume volume : all_volumes) {
      const Network network =
          test::coupled_network(mesh, {{3e4, 0.49}, {1e5, -0.2}}, volume, own_share);
      test::expect_slope_of_energy(network, kinematics, moved);
    }
}

// At rest and where every spring is pulled the tangent is all of the slope. Kuhn cells stretched
// evenly pull at every spring or, across right angles, at none; there the sign is that of rounding.
TEST(Coupled, TangentIsTheSlopeOfTheForce) {
  const TetMesh mesh =
      geometry::cuboid(Vec3(0.02, 0.01, 0.03), {2, 1, 3}, geometry::CellPattern::kuhn);
  const Vector stretched = test::linear_displacement(mesh, 0.05 * Eigen::Matrix3d::Identity());
  const Vector rest = Vector::Zero(stretched.size());
  for (const Kinematics kinematics : all_kinematics)
    for (const Volume volume : all_volumes)
      for (const Vector& place : {rest, stretched}) {
        const Network network = test::coupled_network(mesh, {{3e4, 0.45}}, volume, own_share);
        std::vector<double> elongation(network.ends.size());
        std::vector<double> tension(network.ends.size());
        test::elongations(network, kinematics, place, elongation);
        tissue::tensions(network, elongation, tension);
        const Eigen::MatrixXd tangent =
            test::dense(tissue::tangent(network, kinematics, place, 1.0, tension)
                            .split(test::nothing_held(network)));
        const double h = 1e-7;
        for (Eigen::Index d = 0; d < place.size(); d += 7) {
          Vector more = place;
          Vector less = place;
          more[d] += h;
          less[d] -= h;
          const Vector slope = (test::elastic_force(network, kinematics, more) -
                                test::elastic_force(network, kinematics, less)) /
                               (2.0 * h);
          EXPECT_LT((slope - tangent.col(d)).cwiseAbs().maxCoeff(),
                    1e-7 * tangent.cwiseAbs().maxCoeff());  // differences at 1e-7 m
        }
      }
}

// Squeezed to four fifths, the true slope need not be positive definite; the tangent is.
TEST(Coupled, TangentStaysPositiveDefiniteUnderPressure) {
  const TetMesh mesh = test::jittered_block({2, 2, 2});
  const Vector squeezed = test::linear_displacement(mesh, -0.2 * Eigen::Matrix3d::Identity());
  for (const Volume volume : {Volume::tetrahedron, Volume::nodal}) {
    const Network network = test::coupled_network(mesh, {{3e4, 0.45}}, volume, own_share);
    std::vector<double> elongation(network.ends.size());
    std::vector<double> tension(network.ends.size());
    test::elongations(network, Kinematics::squared, squeezed, elongation);
    tissue::tensions(network, elongation, tension);
    std::vector<char> held = test::nothing_held(network);
    for (const int node : geometry::nodes_at_height(mesh, 0.0))
      for (int axis = 0; axis < 3; ++axis) held[as_index(3 * node + axis)] = 1;
    Cholesky factors;
    EXPECT_TRUE(factors.factor(
        tissue::tangent(network, Kinematics::squared, squeezed, 1.0, tension).split(held)));
  }
}

}  // namespace
}  // namespace palpate
