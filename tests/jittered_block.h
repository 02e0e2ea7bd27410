// A block of irregular tetrahedra, and what tests of spring networks say often.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "base/block_matrix.h"
#include "base/cholesky.h"
#include "geometry/cuboid.h"
#include "plain_springs.h"
#include "test_surfaces.h"
#include "tissue/coupled.h"
#include "tissue/network.h"
#include "tissue/stiffness.h"

namespace palpate::test {

// Kuhn cells of 10 mm whose nodes are moved by up to a sixth of a cell; the block's faces stay flat
// and its edges straight.
inline geometry::TetMesh jittered_block(const std::array<int, 3>& cells) {
  constexpr double cell = 0.01;  // m
  const Vec3 size(cell * cells[0], cell * cells[1], cell * cells[2]);
  geometry::TetMesh mesh = geometry::cuboid(size, cells, geometry::CellPattern::kuhn);
  Dice dice(7);
  for (Vec3& node : mesh.nodes)
    for (int axis = 0; axis < 3; ++axis) {
      const double move = cell / 3.0 * (dice.roll() - 0.5);
      const bool inside = node[axis] > 0.1 * cell && node[axis] < size[axis] - 0.1 * cell;
      if (inside) node[axis] += move;
    }
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    EXPECT_GT(geometry::signed_volume(mesh, static_cast<int>(t)), 0.0);
  return mesh;
}

// The tetrahedra in the half of the block where x is large are region 1.
inline geometry::TetMesh two_regions(geometry::TetMesh mesh) {
  double length = 0.0;
  for (const Vec3& node : mesh.nodes) length = std::max(length, node.x());
  for (const auto& corners : mesh.tetrahedra) {
    double mean = 0.0;
    for (const int node : corners) mean += 0.25 * mesh.nodes[static_cast<std::size_t>(node)].x();
    mesh.regions.push_back(mean > 0.5 * length ? 1 : 0);
  }
  return mesh;
}

inline tissue::Network coupled_network(const geometry::TetMesh& mesh,
                                       const std::vector<tissue::Isotropic>& tissues,
                                       tissue::Volume volume, double own_share) {
  tissue::Network network =
      tissue::make_network(mesh, std::vector<double>(tissues.size(), 1000.0), {});
  tissue::couple(network, mesh, tissues, volume, own_share);
  return network;
}

// A displacement without symmetry, of about `size` (m), that is not linear in place.
inline tissue::Vector scattered_displacement(const geometry::TetMesh& mesh, double size) {
  tissue::Vector displacement(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  Dice dice(11);
  for (double& component : displacement) component = 2.0 * size * (dice.roll() - 0.5);
  return displacement;
}

// u = H x at every node.
inline tissue::Vector linear_displacement(const geometry::TetMesh& mesh,
                                          const Eigen::Matrix3d& gradient) {
  tissue::Vector displacement(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    displacement.segment<3>(3 * static_cast<Eigen::Index>(i)) = gradient * mesh.nodes[i];
  return displacement;
}

// The forces (N) that hold a displacement of elastic springs.
inline tissue::Vector elastic_force(const tissue::Network& network, tissue::Kinematics kinematics,
                                    const tissue::Vector& displacement) {
  std::vector<double> elongation(network.ends.size());
  std::vector<double> tension(network.ends.size());
  test::elongations(network, kinematics, displacement, elongation);
  tissue::tensions(network, elongation, tension);
  tissue::Vector force;
  test::gather_forces(network, kinematics, displacement, tension, force);
  return force;
}

inline double elastic_energy(const tissue::Network& network, tissue::Kinematics kinematics,
                             const tissue::Vector& displacement) {
  std::vector<double> elongation(network.ends.size());
  test::elongations(network, kinematics, displacement, elongation);
  return 0.5 * test::work(network, elongation, elongation);
}

inline Eigen::MatrixXd dense(const SplitMatrix& matrix) {
  Eigen::MatrixXd all = matrix.local;
  if (matrix.weights.size() > 0) {
    const Eigen::MatrixXd shared = matrix.shared;
    all += shared.transpose() * matrix.weights.asDiagonal() * shared;
  }
  return all;
}

inline std::vector<char> nothing_held(const tissue::Network& network) {
  return std::vector<char>(3 * network.rest.size(), 0);
}

// C eps of isotropic matter, Pa, from the textbook's E and nu.
inline Eigen::Matrix3d stress(const tissue::Isotropic& tissue, const Eigen::Matrix3d& strain) {
  const double nu = tissue.poisson_ratio;
  const double factor = tissue.young_modulus / ((1.0 + nu) * (1.0 - 2.0 * nu));
  return factor * ((1.0 - 2.0 * nu) * strain + nu * strain.trace() * Eigen::Matrix3d::Identity());
}

// Force = -d(energy)/dx at a displacement, by central differences.
inline void expect_slope_of_energy(const tissue::Network& network, tissue::Kinematics kinematics,
                                   const tissue::Vector& moved) {
  const tissue::Vector force = elastic_force(network, kinematics, moved);
  const double step = 1e-7;  // m: truncation (1e-7 / 1e-2)^2, rounding 1e-16 E / 1e-7 m
  for (Eigen::Index d = 0; d < moved.size(); d += 5) {
    tissue::Vector more = moved;
    tissue::Vector less = moved;
    more[d] += step;
    less[d] -= step;
    const double slope =
        (elastic_energy(network, kinematics, more) - elastic_energy(network, kinematics, less)) /
        (2.0 * step);
    EXPECT_NEAR(slope, force[d], 1e-7 * force.cwiseAbs().maxCoeff());
  }
}

// 12 x 3 x 3 Kuhn cells of 1 m, held at x = 0.
inline geometry::TetMesh cantilever_mesh() {
  return geometry::cuboid(Vec3(12, 3, 3), {12, 3, 3}, geometry::CellPattern::kuhn);
}

// The mean deflection of the cantilever's end under a newton there, shared by mass, over that of a
// beam with E = 1 Pa: F L^3 / (3 E I) + F L / (5/6 G A).
inline double cantilever_over_beam(const geometry::TetMesh& mesh, const tissue::Network& network,
                                   double shear_modulus) {
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  tissue::Vector load = tissue::Vector::Zero(3 * network.nodes());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (mesh.nodes[i].x() < 0.5)
      for (std::size_t axis = 0; axis < 3; ++axis) held[3 * i + axis] = 1;
    if (mesh.nodes[i].x() > 11.5) load[3 * static_cast<Eigen::Index>(i) + 2] = network.node_mass[i];
  }
  load /= load.sum();
  Cholesky factors;
  EXPECT_TRUE(factors.factor(tissue::stiffness_matrix(network).split(held)));
  const tissue::Vector moved = factors.solve(load);
  double mean = 0.0;
  for (Eigen::Index d = 2; d < load.size(); d += 3)
    if (load[d] > 0.0) mean += moved[d] / 16.0;
  return mean / (12.0 * 12.0 * 12.0 / (3.0 * 6.75) + 12.0 / (5.0 / 6.0 * 9.0 * shear_modulus));
}

}  // namespace palpate::test
