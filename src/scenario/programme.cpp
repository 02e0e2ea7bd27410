// Travels over their rates, and times that are given.
#include "scenario/programme.h"

#include <variant>

namespace palpate::scenario {

double programme_time(const Scenario& scenario) {
  double total = 0.0;
  double travel = 0.0;
  for (const Step& step : scenario.steps) {
    if (const auto* indent = std::get_if<Indent>(&step)) {
      total += (indent->to.value - travel) / indent->rate;
      travel = indent->to.value;
    } else if (const auto* retract = std::get_if<Retract>(&step)) {
      total += (travel - retract->to) / retract->rate;
      travel = retract->to;
    } else if (const auto* slide = std::get_if<Slide>(&step)) {
      total += slide->by / slide->rate;
    } else if (const auto* hold = std::get_if<Hold>(&step)) {
      total += hold->time;
    }
  }
  return total;
}

}  // namespace palpate::scenario
