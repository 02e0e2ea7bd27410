// Marches of one body by itself.
#include "run/march.h"

namespace palpate::run {

using integrate::State;
using integrate::Vector;

void March::clear() {
  times.clear();
  loads.clear();
  first_load.reset();
  done = 0;
  wrong.reset();
}

void carry_out(March& march) {
  const auto put = [](const tissue::SparseLoad& few, Vector& load) {
    load.setZero();
    for (std::size_t k = 0; k < few.freedoms.size(); ++k) load[few.freedoms[k]] = few.forces[k];
  };
  State& state = *march.state;
  Vector load_before(state.displacement.size());
  Vector load_after(state.displacement.size());
  State before;
  put(march.load(0), load_before);
  for (std::size_t i = 0; i < march.times.size(); ++i) {
    put(march.load(i + 1), load_after);
    before = state;
    if (i == 0 && march.first_load) {
      Vector moving(load_before.size());
      put(*march.first_load, moving);
      march.wrong = march.stepper->step(state, moving, load_after, march.rule);
    } else {
      march.wrong = march.stepper->step(state, load_before, load_after, march.rule);
    }
    if (march.wrong) return;
    state.time = march.times[i];  // a sum of steps would carry their rounding
    march.wrong = march.monitor->step(before, state, load_before, load_after);
    if (march.wrong) return;
    ++march.done;
    load_before.swap(load_after);
  }
  if (march.force_wanted) march.body->force(state.displacement, state.memory, march.force);
}

bool suits_lanes(const scene::Scene& scene) {
  using scenario::Contact;
  if (!scene.specimen) return false;
  const scenario::Scenario& scenario = scene.scenario;
  if (scenario.solver.integrator != scenario::Solver::Integrator::central_difference ||
      !tissue::LaneSprings::can(scene.specimen->network, scene.specimen->law))
    return false;
  if (scenario.uniform()) return true;
  return !scenario.solver.rings && scenario.contact.curvature_on == Contact::CurvatureOn::rest &&
         (scenario.contact.coupling == contact::Coupling::one_way ||
          (scenario.contact.coupling == contact::Coupling::consistent &&
           !scene::inertia_reaches_force(scenario)));
}

March* Course::next() {
  handle_.promise().march = nullptr;
  handle_.resume();
  if (handle_.promise().failure) std::rethrow_exception(handle_.promise().failure);
  return handle_.done() ? nullptr : handle_.promise().march;
}

void carry_out(Course course) {
  while (March* march = course.next()) carry_out(*march);
}

}  // namespace palpate::run
