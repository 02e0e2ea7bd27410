// Strain of tetrahedra: linear fields exactly, turns of the body, who feels which node.
#include "tissue/coupled.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>

#include "geometry/cuboid.h"

namespace palpate::tissue {
namespace {

geometry::TetMesh strained_block() {
  return geometry::cuboid({0.06, 0.05, 0.03}, {2, 3, 2}, geometry::CellPattern::mirrored);
}

std::vector<Vec3> field(const geometry::TetMesh& mesh, const Eigen::Matrix3d& gradient) {
  std::vector<Vec3> displacement;
  for (const Vec3& node : mesh.nodes)
    displacement.emplace_back(gradient * node + Vec3(1e-3, -2e-3, 5e-4));
  return displacement;
}

TEST(Strain, of_a_linear_field_is_the_symmetric_part_of_its_gradient) {
  EXPECT_TRUE(rc::check([] {
    Eigen::Matrix3d gradient;
    for (int i = 0; i < 9; ++i) gradient(i / 3, i % 3) = *rc::gen::inRange(-500, 500) * 1e-3;
    const geometry::TetMesh mesh = strained_block();
    const std::vector<Strain> strains = small_strain(mesh, field(mesh, gradient));
    RC_ASSERT(strains.size() == mesh.tetrahedra.size());
    const Eigen::Matrix3d want = 0.5 * (gradient + gradient.transpose());
    const Strain wanted{want(0, 0), want(1, 1), want(2, 2), want(0, 1), want(1, 2), want(0, 2)};
    for (const Strain& strain : strains)
      for (std::size_t i = 0; i < 6; ++i)
        RC_ASSERT(std::abs(strain[i] - wanted[i]) < 1e-13);  // rounding of coordinates over edges
  }));
}

TEST(Strain, of_compression_and_shear_has_its_signs_and_halves) {
  const geometry::TetMesh mesh = strained_block();
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  gradient(2, 2) = -0.1;  // pressed down
  gradient(0, 1) = 0.04;  // u_x grows with y
  const Strain strain = small_strain(mesh, field(mesh, gradient)).front();
  const Strain wanted{0.0, 0.0, -0.1, 0.02, 0.0, 0.0};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(strain[i], wanted[i], 1e-15);  // rounding
}

TEST(Strain, of_a_turn_is_of_second_order) {
  const geometry::TetMesh mesh = strained_block();
  const double angle = 0.02;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
  const Strain strain = small_strain(mesh, field(mesh, turn - Eigen::Matrix3d::Identity())).front();
  EXPECT_NEAR(strain[0], -0.5 * angle * angle, 1e-8);  // the next term is angle^4 / 24
  EXPECT_NEAR(strain[3], 0.0, 1e-15);                  // rounding
}

TEST(Strain, stays_in_the_tetrahedra_around_the_node_that_moves) {
  const geometry::TetMesh mesh = strained_block();
  const int moved = 7;
  std::vector<Vec3> displacement(mesh.nodes.size(), Vec3::Zero());
  displacement[moved] = {0.0, 0.0, -1e-3};
  const std::vector<Strain> strains = small_strain(mesh, displacement);
  for (std::size_t t = 0; t < strains.size(); ++t) {
    const auto& corners = mesh.tetrahedra[t];
    const bool has = std::find(corners.begin(), corners.end(), moved) != corners.end();
    EXPECT_EQ(strains[t] != Strain{}, has) << t;
  }
}

}  // namespace
}  // namespace palpate::tissue
