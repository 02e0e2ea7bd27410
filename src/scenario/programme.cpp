// Durations of steps from travels and rates, and positions of the finger after slides.
#include "scenario/programme.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"

namespace palpate::scenario {

namespace {

// The duration of a step, s. `travel` (m) is that at the start of the step, and is updated.
double duration(const Step& step, double& travel) {
  if (const auto* indent = std::get_if<Indent>(&step)) {
    if (indent->to.second) return 0.0;
    return (indent->to.value - std::exchange(travel, indent->to.value)) / indent->rate;
  }
  if (const auto* retract = std::get_if<Retract>(&step))
    return (std::exchange(travel, retract->to) - retract->to) / retract->rate;
  if (const auto* hold = std::get_if<Hold>(&step)) return hold->time;
  if (const auto* slide = std::get_if<Slide>(&step)) return slide->by / slide->rate;
  if (const auto* creep = std::get_if<Creep>(&step)) return creep->load_time + creep->recovery_time;
  if (const auto* relax = std::get_if<Relax>(&step)) return relax->time;
  const auto& compress = std::get<Compress>(step);
  return compress.ramp_time() + compress.hold_time;
}

}  // namespace

std::optional<Vec3> direction_of(const std::string& text) {
  const bool back = text.starts_with('-');
  const std::string axis = text.substr(back || text.starts_with('+') ? 1 : 0);
  for (int k = 0; k < 3; ++k)
    if (axis == std::string(1, "xyz"[k])) return (back ? -1.0 : 1.0) * Vec3::Unit(k);
  Vec3 vector = Vec3::Zero();
  int count = 0;
  for (const std::string& word : split(text, ' ')) {
    if (word.empty()) continue;
    const auto number = whole_number(word);
    if (!number || count == 3) return std::nullopt;
    vector[count++] = *number;
  }
  const double length = vector.norm();
  if (count < 3 || !(length > 0.0) || !std::isfinite(length)) return std::nullopt;
  return vector / length;
}

double programme_time(const PlainScenario& scenario) {
  double total = 0.0;
  double travel = 0.0;
  for (const Step& step : scenario.steps) total += duration(step, travel);
  return total;
}

std::vector<std::array<double, 2>> finger_places(const Resolved& scenario, const Cuboid& box) {
  double x = scenario.finger.x.value_or(0.5 * box.size[0]);
  double y = scenario.finger.y.value_or(0.5 * box.size[1]);
  std::vector<std::array<double, 2>> places{{x, y}};
  for (const Step& step : scenario.steps) {
    const auto* slide = std::get_if<Slide>(&step);
    if (slide == nullptr) continue;
    const Vec3 way = slide->way();
    x += way.x();
    y += way.y();
    places.push_back({x, y});
  }
  return places;
}

bool compresses(const PlainScenario& scenario) {
  return !scenario.steps.empty() && std::holds_alternative<Compress>(scenario.steps.front());
}

tissue::Base upper_platen(const PlainScenario& scenario) {
  return compresses(scenario) ? std::get<Compress>(scenario.steps.front()).platen
                              : tissue::Base::frictionless;
}

std::optional<std::string> compression_problem(const Scenario& scenario, const Compress& compress) {
  const std::string is = "`compress` is computed ";
  if (scenario.solver.integrator && *scenario.solver.integrator != Solver::Integrator::quasi_static)
    return is + "without inertia; leave `solver.integrator` out";
  if (scenario.solver.kinematics == Solver::Kinematics::nonlinear)
    return is + "for small strain; leave `solver.kinematics` out";
  if (scenario.tissue.viscosity == tissue::Viscosity::nodal_drag)
    return is + "without nodal drag; write another `tissue.viscosity`";
  if (compress.platen != upper_platen(scenario) ||
      (compress.platen == tissue::Base::bonded &&
       !std::ranges::all_of(scenario.steps, [](const Step& step) {
         return std::holds_alternative<Compress>(step);
       })))
    return "all steps of a scenario have one upper platen; put steps with another `platen` into "
           "another scenario";
  return std::nullopt;
}

}  // namespace palpate::scenario
