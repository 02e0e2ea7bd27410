// The effects that the model of a scene leaves out.
#pragma once

#include <string>
#include <vector>

#include "scene/estimates.h"

namespace palpate::run {

struct LeftOut {
  std::string what;     // "viscosity"
  double change = 0.0;  // of the force (in a uniform test of the strain) by the effect, relative
  std::string when;     // the change in words: "which would add 36 % to the force while pressing"
  std::string remedy;   // an instruction such as "add `key = value`"; empty if there is none
  std::string
      beside;  // what the stated error does not contain: "viscosity"; empty if it contains it
};

// Viscosity and large strains count from a fifth of `solver.tolerance` on, the others from the
// tolerance on. The largest is the first. `estimates` are those of the scene; a
// uniform test does not use them.
[[nodiscard]] std::vector<LeftOut> left_out(const scene::Scene& scene,
                                            const scene::Estimates& estimates);

}  // namespace palpate::run
