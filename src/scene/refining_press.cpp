// The press that decides where a mesh is refined.
#include "scene/refining_press.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "scenario/integrators.h"
#include "scene/estimates.h"
#include "scene/scene.h"

namespace palpate::scene {

using Scenario = scenario::Resolved;

bool refines(const Scenario& scenario) {
  return scenario.meshed() && scenario::refinement(scenario.tissue.mesh).refine &&
         !scenario.uniform() && scenario.contact.coupling == contact::Coupling::consistent;
}

Scenario refining_press(const Scenario& scenario) {
  constexpr double modulus = 1e4;  // Pa
  Scenario press = scenario;
  const Finger finger = make_finger(scenario);
  double deepest = deepest_travel(scenario, finger.whole);
  const bool to_force = std::ranges::any_of(scenario.steps, [](const scenario::Step& step) {
    const auto* indent = std::get_if<scenario::Indent>(&step);
    return indent != nullptr && indent->to.second;
  });
  // The depth at a force depends on the modulus. It is rounded up, so that a sweep of moduli shares
  // a few meshes.
  if (to_force)
    deepest = finger.whole.radius *
              std::exp2(std::ceil(2.0 * std::log2(deepest / finger.whole.radius)) / 2.0);
  press.steps = {scenario::Indent{.to = {deepest, false}}};
  for (const scenario::Step& step : scenario.steps)
    if (const auto* slide = std::get_if<scenario::Slide>(&step))
      press.steps.emplace_back(scenario::Slide{.by = slide->by, .direction = slide->direction});
  const double scale = scenario.tissue.young_modulus;
  for (auto& region : press.regions)
    region.young_modulus = modulus * (region.young_modulus / scale);
  press.tissue.young_modulus = modulus;
  press.tissue.viscosity = tissue::Viscosity::none;
  press.tissue.law = {};
  press.finger.elastic.reset();
  if (press.finger.calibration == finger::Calibration::force) press.finger.spheres = 1;
  press.contact.viscosity = scenario::Contact::Viscosity::none;
  press.contact.depth = scenario::Contact::Depth::hertz;
  press.contact.friction = 0.0;
  press.solver.model = scenario::strongest.of;
  press.solver.volume = tissue::Volume::nodal;
  press.solver.integrator = scenario::Solver::Integrator::quasi_static;
  press.solver.kinematics = scenario::Solver::Kinematics::linear;
  press.solver.rings.reset();
  press.solver.time_step.reset();
  press.solver.substeps.reset();
  press.output = {};
  return press;
}

std::string refining_key(const Scenario& scenario) {
  const Scenario press = refining_press(scenario);
  std::string key = "refined";
  const auto add = [&](double number) { key += " " + number_text(number); };
  add(press.tissue.poisson_ratio);
  for (const auto& region : press.regions) {
    add(region.young_modulus);
    add(region.poisson_ratio);
  }
  add(press.tissue.base == tissue::Base::bonded ? 1.0 : 0.0);
  add(press.tissue.base_height.value_or(-1.0));
  add(press.finger.radius);
  add(press.finger.spheres);
  add(press.finger.density);
  add(press.finger.x.value_or(-1.0));
  add(press.finger.y.value_or(-1.0));
  add(press.solver.tolerance);
  add(longest_for_waves(scenario));
  add(scenario.solver.integrator == scenario::Solver::Integrator::modal &&
              !scenario::lowest_modes_serve(scenario)
          ? 1.0
          : 0.0);
  for (const scenario::Step& step : press.steps) {
    if (const auto* indent = std::get_if<scenario::Indent>(&step)) add(indent->to.value);
    if (const auto* slide = std::get_if<scenario::Slide>(&step)) {
      add(slide->by);
      add(slide->direction);
    }
  }
  return key;
}

}  // namespace palpate::scene
