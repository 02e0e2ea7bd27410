// Neo-Hookean tetrahedra for finite strain: energy, nodal forces and tangent stiffness.
#pragma once

#include <span>
#include <vector>

#include "base/split_matrix.h"
#include "geometry/tet_mesh.h"
#include "tissue/coupled.h"

namespace palpate::tissue {

// The energy is the sum over tetrahedra of V (mu/2 (I1bar - 3) + k/2 (J - 1)^2) and over the nodes
// of each region of V_v (K - k)/2 (J_v - 1)^2, with the isochoric invariant
// I1bar = J^(-2/3) tr F^T F, k = min(K, own_share mu) and the volume J_v averaged around a node as
// in couple(), so that the mesh does not lock.                            docs/theory.md (97)
class NeoHookean {
 public:
  using Vector = Eigen::VectorXd;

  // The tetrahedra must have positive volume; `tissues` has one entry per region of the mesh.
  NeoHookean(const geometry::TetMesh& mesh, std::span<const Isotropic> tissues, double own_share);

  // J, under a displacement (m) with three entries per node; infinite if a tetrahedron is turned
  // inside out.
  [[nodiscard]] double energy(const Vector& displacement);

  // The gradient of the energy, N, at the displacement of the last energy() that was finite.
  void force(Vector& force) const;

  // The second derivative of the energy there, N/m. Rows and columns of `held` degrees of freedom
  // are those of the identity. With `bounded` the stresses' part of every tetrahedron leaves out
  // its negative eigenvalues, so that the matrix is positive definite.
  [[nodiscard]] SplitMatrix stiffness(std::span<const char> held, bool bounded) const;

 private:
  struct Tetrahedron {
    std::array<int, 4> corners{};
    std::array<int, 4> averages{};          // of its corners
    Eigen::Matrix<double, 4, 3> gradients;  // 1/m, of the corners' linear functions
    double volume = 0.0;                    // m^3
    double shear = 0.0, own_bulk = 0.0;     // Pa
    Eigen::Matrix3d stretch, inverse;       // F and F^-T
    double ratio = 1.0;                     // J
  };
  // The volume around a node within one region.
  struct Average {
    double volume = 0.0;  // m^3, of the tetrahedra around the node
    double bulk = 0.0;    // Pa
    double ratio = 1.0;   // J_v
  };
  [[nodiscard]] double pressure(const Tetrahedron& one) const;

  Eigen::Index freedoms_ = 0;
  std::vector<Tetrahedron> tetrahedra_;
  std::vector<Average> averages_;
};

}  // namespace palpate::tissue
