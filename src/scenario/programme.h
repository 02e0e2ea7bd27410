// How long the programme of a press is.
#pragma once

#include "scenario/scenario.h"

namespace palpate::scenario {

// All steps together, s; none of them ends at a force, nor is a uniform test.
[[nodiscard]] double programme_time(const Scenario& scenario);

}  // namespace palpate::scenario
