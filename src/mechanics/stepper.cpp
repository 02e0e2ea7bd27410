// Creates the scenario's time integrator and calls it.
#include "mechanics/stepper.h"

#include <type_traits>

#include "base/error.h"
#include "scenario/integrators.h"
#include "tissue/stiffness.h"
#include "tissue/supports.h"

namespace palpate::mechanics {
namespace {

// By default, where K is not factored and every mode takes some three solutions by iterations.
constexpr int modes_of_large = 32;

Stepper::Method make_method(const scene::Scene& scene, const scene::SpringBody& body,
                            SymmetricSolver* statics, double time_step) {
  using Integrator = scenario::Solver::Integrator;
  using Inertia = integrate::Implicit::Inertia;
  const scenario::Resolved::Solver& solver = scene.scenario.solver;
  switch (solver.integrator) {
    case Integrator::central_difference:
    case Integrator::semi_implicit_euler:
      return integrate::CentralDifference(body, time_step, solver.start,
                                          scenario::damping_velocity(solver));
    case Integrator::backward_difference:
      return integrate::Implicit(body, Inertia::backward_difference);
    case Integrator::tr_bdf2: return integrate::TrBdf2(body);
    case Integrator::quasi_static: return integrate::Implicit(body, Inertia::none);
    case Integrator::modal: break;
  }
  if (statics == nullptr || !scenario::lowest_modes_serve(scene.scenario))
    return integrate::Modal(body, scene.known_modes);
  prepare(*statics, body);
  const bool large = static_cast<Eigen::Index>(body.held().size()) >= SymmetricSolver::large;
  return integrate::Modal(body,
                          solver.modes.value_or(large ? modes_of_large : scenario::default_modes),
                          *statics, scene.known_modes);
}

}  // namespace

void prepare(SymmetricSolver& statics, const scene::SpringBody& body) {
  if (!statics.prepared() &&
      !statics.prepare(body.stiffness(), {body.held().begin(), body.held().end()}))
    throw MeshError(tissue::not_held);
}

void Stepper::set_step(double time_step) {
  const bool fixed_step = about(scene_->scenario.solver.integrator).explicit_steps;
  if (!method_ || (fixed_step && time_step != time_step_)) {
    method_.emplace(make_method(*scene_, *body_, statics_, time_step));
    ++beginnings_;
  }
  time_step_ = time_step;
}

std::optional<std::string> Stepper::step(integrate::State& state,
                                         const integrate::Vector& load_before,
                                         const integrate::Vector& load_after,
                                         integrate::MemoryRule rule) {
  return std::visit(
      [&](auto& method) -> std::optional<std::string> {
        using Chosen = std::decay_t<decltype(method)>;
        if constexpr (requires { method.step(state, load_before); }) {
          method.step(state, load_before);
          return std::nullopt;
        } else if constexpr (std::is_same_v<Chosen, integrate::TrBdf2>) {
          constexpr double part = integrate::TrBdf2::first_part;
          method.start_under(load_before);
          load_ = load_before + part * (load_after - load_before);
          if (auto wrong =
                  solve_step(method, *body_, state, time_step_, rule, load_, displacement_))
            return wrong;
          return solve_step(method, *body_, state, time_step_, rule, load_after, displacement_);
        } else {
          return solve_step(method, *body_, state, time_step_, rule, load_after, displacement_);
        }
      },
      *method_);
}

}  // namespace palpate::mechanics
