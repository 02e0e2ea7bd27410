// Spring stiffness from Young's modulus: two rules for independent springs. Moduli are in Pa, one
// per region of the mesh; results are stiffnesses in N/m, one per sorted edge.
#pragma once

#include <span>
#include <vector>

#include "geometry/tet_mesh.h"
#include "tissue/supports.h"

namespace palpate::tissue {

enum class StiffnessRule { van_gelder, fitted };

// k_e = sum(E_t V_t) / l_e^2 over the tetrahedra at the edge. Van Gelder 1998;
//                                                                       docs/theory.md [van_gelder]
[[nodiscard]] std::vector<double> van_gelder_stiffness(const geometry::TetMesh& mesh,
                                                       std::span<const double> young_modulus);

// Bounded least squares towards isotropy: the k_e, at least a tenth of Van Gelder's, that minimise
//   sum_v || sum_{e at v} 1/2 k_e l_e^2 n n n n  -  V_v C ||^2,
// where C is the isotropic stiffness for E and nu = 1/4, the only ratio that central forces have. A
// weak second term prefers Van Gelder's values where this leaves a choice. The fit is that of one
// tissue: per sorted edge k_e l_e^2 over E, m^3, fitted and by Van Gelder. It is slow and serves
// all tissues on a mesh.
//                                                                       docs/theory.md [fitted]
struct SpringFit {
  std::vector<double> fitted;
  std::vector<double> van_gelder;
};
[[nodiscard]] SpringFit fit_springs(const geometry::TetMesh& mesh);
// With the fit of the same mesh. A spring between tissues gets the mean modulus of the volume
// around it. (A fit across a stiff interface would soften the soft side's springs to make up for
// the stiff side.)
[[nodiscard]] std::vector<double> fitted_stiffness(const geometry::TetMesh& mesh,
                                                   const SpringFit& fit,
                                                   std::span<const double> young_modulus);

// Result of a small static uniaxial compression between platens.
struct Uniaxial {
  double young_modulus = 0.0;  // Pa: stress over strain
  double poisson_ratio = 0.0;  // mean widening of the sides over the axial strain
  double height = 0.0;         // m
  double area = 0.0;           // m^2, of the top face
  Vector displacement;         // m, for a shortening by the whole height (strain 1, linear)
  std::vector<int> top;        // the nodes under the upper platen
  std::vector<double> shares;  // of the platen's force, one per node of `top`; sum 1
};

// `area` (m^2) is that of the flat top at height `top` (m). The upper platen holds the body as
// `platen` says, the lower one as `base` does. Throws MeshError if the network is not rigid.
// docs/theory.md [uniaxial]
[[nodiscard]] Uniaxial uniaxial_test(const Network& network, const geometry::TetMesh& mesh,
                                     Base base, double top, double area,
                                     Base platen = Base::frictionless);

// The same for a body of any shape, under tractions on its whole surface that stretch it uniformly
// along z. Modulus and ratio follow from the mean strain; the other members are left empty. Throws
// MeshError if the network is not rigid.                              docs/theory.md [traction]
[[nodiscard]] Uniaxial traction_test(const Network& network, const geometry::TetMesh& mesh);

}  // namespace palpate::tissue
