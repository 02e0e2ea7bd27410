// Young's modulus and Poisson's ratio of a spring network, measured on the specimen.
#pragma once

#include <vector>

#include "tissue/supports.h"

namespace palpate::tissue {

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
