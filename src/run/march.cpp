// Carries out the solver steps of one body.
#include "run/march.h"

namespace palpate::run {

using integrate::State;
using integrate::Vector;

void March::clear() {
  times.clear();
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
  Vector load(state.displacement.size());
  put(march.load, load);
  State before;
  for (std::size_t i = 0; i < march.times.size(); ++i) {
    before = state;
    if (i == 0 && march.first_load) {
      Vector moving(load.size());
      put(*march.first_load, moving);
      march.wrong = march.stepper->step(state, moving, load, march.rule);
    } else {
      march.wrong = march.stepper->step(state, load, load, march.rule);
    }
    if (march.wrong) return;
    state.time = march.times[i];  // a sum of steps would accumulate rounding errors
    march.wrong = march.monitor->step(before, state, load, load);
    if (march.wrong) return;
    ++march.done;
  }
  if (march.force_wanted) march.body->force(state.displacement, state.memory, march.force);
}

bool suits_lanes(const scene::Scene& scene) {
  const scenario::Resolved& scenario = scene.scenario;
  return scenario.uniform() &&
         scenario.solver.integrator == scenario::Solver::Integrator::central_difference &&
         scene.specimen->kinematics == tissue::Kinematics::linear &&
         tissue::LaneSprings::can(scene.specimen->network, scene.specimen->law);
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
