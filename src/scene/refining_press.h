// The press for which a mesh is refined.
#pragma once

#include <string>

#include "scenario/resolved.h"

namespace palpate::scene {

// How a mesh was refined.
struct Refined {
  int start_nodes = 0;
  int rounds = 0;
  double error = 0.0;   // stated, of the force, a fraction of it; docs/theory.md [compliance]
  double wanted = 0.0;  // where refining may stop
};

// Whether the scenario's mesh is refined where its own error in the force comes from.
[[nodiscard]] bool refines(const scenario::Resolved& scenario);

// The reduced scenario by which the mesh of one that refines() is refined: a rigid finger, 10 kPa
// of `tissue.material`, one quasi-static indent to the deepest travel, and the scenario's slides.
[[nodiscard]] scenario::Resolved refining_press(const scenario::Resolved& scenario);

// The numbers on which a refined mesh depends besides those of its start: the moduli's ratios, not
// the modulus. Scenarios with equal texts have the same refined mesh, to the bit.
[[nodiscard]] std::string refining_key(const scenario::Resolved& scenario);

}  // namespace palpate::scene
