// Spring stiffness from Young's modulus: two rules for independent springs. Moduli are in Pa, one a
// region of the mesh; the answer is one stiffness (N/m) a sorted edge.
#pragma once

#include <span>
#include <vector>

#include "geometry/tet_mesh.h"

namespace palpate::tissue {

enum class StiffnessRule { van_gelder, fitted };

// k_e = sum(E_t V_t) / l_e^2 over the tetrahedra at the edge.         Van Gelder 1998, in space
[[nodiscard]] std::vector<double> van_gelder_stiffness(const geometry::TetMesh& mesh,
                                                       std::span<const double> young_modulus);

// Bounded least squares towards isotropy: k_e, at least a tenth of Van Gelder's, that minimise
//   sum_v || sum_{e at v} 1/2 k_e l_e^2 n n n n  -  V_v C ||^2,
// C the isotropic stiffness of E and nu = 1/4, the only ratio that central forces have; drawn
// weakly to Van Gelder's values where the nodes leave a choice. The fit is that of one tissue; a
// spring between tissues then gets the mean modulus of the volume around it: a fit across a stiff
// interface would take from the soft side's springs what the stiff side has too much.
//                                                                           docs/theory.md (31)
[[nodiscard]] std::vector<double> fitted_stiffness(const geometry::TetMesh& mesh,
                                                   std::span<const double> young_modulus);

// What of that fit the moduli do not change, one a sorted edge, m^3: k_e l_e^2 / E of one tissue,
// and the same by Van Gelder. It takes long, and one serves every tissue on the mesh.
struct SpringFit {
  std::vector<double> fitted;
  std::vector<double> van_gelder;
};
[[nodiscard]] SpringFit fit_springs(const geometry::TetMesh& mesh);
// `fit` is that of the same mesh.
[[nodiscard]] std::vector<double> fitted_stiffness(const geometry::TetMesh& mesh,
                                                   const SpringFit& fit,
                                                   std::span<const double> young_modulus);

[[nodiscard]] std::vector<double> spring_stiffness(StiffnessRule rule,
                                                   const geometry::TetMesh& mesh,
                                                   std::span<const double> young_modulus);

}  // namespace palpate::tissue
