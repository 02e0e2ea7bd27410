// How much each simplification changes the force of a press, in numbers that cost nothing.
#pragma once

#include "scene/scene.h"

namespace palpate::scene {

// All of them relative to the force, at the programme's deepest travel and fastest rate. What they
// rest on, and what they were measured against: docs/theory.md (68), docs/accuracy.md.
struct Estimates {
  double travel = 0.0;           // m, the deepest
  double rate = 0.0;             // m/s, the fastest
  double contact_radius = 0.0;   // m, Hertz's at that travel
  double tissue_share = 1.0;     // lambda_2 / (lambda_1 + lambda_2)
  double chi = 0.0;              // sqrt(R h) / H, H down to the base
  double thickness = 0.0;        // the finite thickness adds this
  double sides = 0.0;            // free sides near the contact take this
  double curved_body = 0.0;      // a curved body of finite size: a bound for what its size changes
  double deep = 0.0;             // |F / F_Hertz - 1| of a deep press into neo-Hookean tissue
  double viscous = 0.0;          // the tissue's viscosity adds this
  double inertia = 0.0;          // the waves that it sends away add this
  double curvature_ratio = 1.0;  // (1/R + kappa_1) / (1/R + kappa_2)
};

// Of a scenario with a finger, whose properties are filled in.
[[nodiscard]] Estimates estimate(const scenario::Scenario& scenario);

// Nodes that the scenario's mesh will have, as far as it says.
[[nodiscard]] double expected_nodes(const scenario::Scenario& scenario);

}  // namespace palpate::scene
