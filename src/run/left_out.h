// The effects that the model of a scene leaves out.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

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
// tolerance on. The largest is the first.
[[nodiscard]] std::vector<LeftOut> left_out(const scene::Scene& scene);

}  // namespace palpate::run
