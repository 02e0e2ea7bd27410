// The modulus and the Poisson's ratio that a network really has, measured on the specimen.
#pragma once

#include <vector>

#include "tissue/supports.h"

namespace palpate::tissue {

// A small uniaxial compression between platens, solved in statics.
struct Uniaxial {
  double young_modulus = 0.0;  // Pa: stress over strain
  double poisson_ratio = 0.0;  // mean widening of the sides over the shortening
  double height = 0.0;         // m
  double area = 0.0;           // m^2, of the top face
  Vector displacement;         // m, for a shortening of 1 (strain 1, linear)
  std::vector<int> top;        // the nodes under the upper platen
  std::vector<double> shares;  // of the platen's force on each of them; sum 1
};

// `area` in m^2 of the flat top at height `top` (m). The upper platen is frictionless, the lower
// one as `base` says. Throws MeshError where the network has a mechanism (is not rigid).
[[nodiscard]] Uniaxial uniaxial_test(const Network& network, const geometry::TetMesh& mesh,
                                     Base base, double top, double area);

// The same of a body of any shape, under the tractions on its whole skin that stretch it evenly
// along z; modulus and ratio follow from the mean strain, the rest of the answer is left empty.
// Throws as above.                                                          docs/theory.md (46)
[[nodiscard]] Uniaxial traction_test(const Network& network, const geometry::TetMesh& mesh);

}  // namespace palpate::tissue
