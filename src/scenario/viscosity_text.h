// A tissue's viscous law in words.
#pragma once

#include <string>

#include "scenario/resolved.h"

namespace palpate::scenario {

// `Kelvin-Voigt, retardation time 0.1 s`; `none` without viscosity.
[[nodiscard]] std::string viscosity_text(const Resolved::Tissue& tissue);

}  // namespace palpate::scenario
