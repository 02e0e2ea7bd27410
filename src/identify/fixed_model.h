// The one model for a whole search: a change of model would make the curve discontinuous.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "identify/unknowns.h"
#include "scenario/resolved.h"

namespace palpate::identify {

struct FixedModel {
  scenario::Case one;  // every `auto` is replaced by the choice made for it
  scenario::Model model = scenario::Model::hertz;
  bool given = false;        // the scenario names the model
  double worst_error = 0.0;  // relative; the largest estimate at the corners and the middle

  // The case at these values of the unknowns (SI, in their order).
  [[nodiscard]] scenario::Case at(std::span<const Unknown> unknowns,
                                  std::span<const double> values) const;
};

// Returns the cheapest model whose estimated error is within `solver.tolerance` at the corners and
// in the middle of the box (more than 5 unknowns: at the ends of each, the others in the middle);
// if there is none, the model with the smallest worst error. Viscosity in the contact, inertia or
// the factor of deep presses is used throughout if any of these points needs it; inertia is
// neglected of the flow between platens. `document` gives messages their place. Throws InputError
// with the problems of the middle if the scenario is invalid at all of these points.
[[nodiscard]] FixedModel fix_model(const scenario::Case& one, const Node& document,
                                   std::span<const Unknown> unknowns);

// Relative change of a specimen's flow by its lowest axial wave, 1 / (omega_1 tau)^2 with omega_1
// of theory.md [damping]. Nothing unless a cuboid of Kelvin-Voigt or SLS tissue is between platens.
[[nodiscard]] std::optional<double> inertia_of_flow(const scenario::Resolved& scenario);

// Estimated relative error of the model that this case names; nothing if there is no estimate.
[[nodiscard]] std::optional<double> predicted_error(const scenario::Case& fixed);

// Relative change of the force at the deepest travel by the factor of deep presses (docs/theory.md
// [deep]); nothing where the case does not use it.
[[nodiscard]] std::optional<double> deep_effect(const scenario::Case& fixed);

}  // namespace palpate::identify
