// Travels over their rates, and times that are given.
#include "scenario/programme.h"

#include <cmath>
#include <numbers>
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

std::vector<std::array<double, 2>> finger_places(const Scenario& scenario, const Cuboid& box) {
  double x = scenario.finger.x.value_or(0.5 * box.size[0]);
  double y = scenario.finger.y.value_or(0.5 * box.size[1]);
  std::vector<std::array<double, 2>> places{{x, y}};
  for (const Step& step : scenario.steps) {
    const auto* slide = std::get_if<Slide>(&step);
    if (slide == nullptr) continue;
    const double angle = slide->direction * std::numbers::pi / 180.0;
    x += slide->by * std::cos(angle);
    y += slide->by * std::sin(angle);
    places.push_back({x, y});
  }
  return places;
}

}  // namespace palpate::scenario
