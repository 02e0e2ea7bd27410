// One rung of the ladder for a whole search: another one halfway would make the curve jump.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "fit/unknowns.h"
#include "scenario/family.h"

namespace palpate::fit {

struct FixedRung {
  scenario::Scenario scenario;  // with an answer in the place of every `auto`
  bool given = false;           // the scenario named the model
  double worst_error = 0.0;     // of those predicted at the corners and the middle of the box
};

// The cheapest rung whose predicted error is within the tolerance everywhere that is asked: at the
// corners and in the middle of the box; else the one that is nearest to it. What any of them needs
// (viscosity in the contact, inertia, the factor of deep presses) is taken into account
// everywhere. `document` is the scenario's, for messages. Throws InputError where no place of the
// box makes a valid scenario, with what is wrong in its middle.
[[nodiscard]] FixedRung fix_rung(const scenario::Scenario& scenario, const Node& document,
                                 std::span<const Unknown> unknowns);

// What the specimen's lowest wave changes of its flow, a ratio; nothing of scenarios that do not
// flow between platens, or whose shape is no box.
[[nodiscard]] std::optional<double> inertia_of_flow(const scenario::Scenario& scenario);

// The error that the ladder predicts for the fixed rung of this scenario, a ratio; nothing where it
// does not know one.
[[nodiscard]] std::optional<double> predicted_error(const scenario::Scenario& fixed);

}  // namespace palpate::fit
