// The scenario's time integrator applied to one body: steps under given loads.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "base/symmetric_solver.h"
#include "integrate/central_difference.h"
#include "integrate/implicit.h"
#include "integrate/modal.h"
#include "mechanics/monitor.h"
#include "scene/scene.h"

namespace palpate::mechanics {

// Newton iterations of non-linear bodies end when no displacement changes by more than this, m.
inline constexpr double settled_length = 1e-12;
inline constexpr int most_linearisations = 100;
inline constexpr const char* not_settled =
    "the non-linear equations did not settle in 100 iterations; take a smaller `solver.time_step`";

class Stepper {
 public:
  using Method = std::variant<integrate::CentralDifference, integrate::Implicit, integrate::TrBdf2,
                              integrate::Modal>;

  // Modal steps keep all modes unless `statics` is given, which must outlive this and then solves
  // with the body's stiffness at rest. Both take a solver that is not prepared yet.
  Stepper(const scene::Scene& scene, const scene::SpringBody& body,
          SymmetricSolver* statics = nullptr)
      : scene_(&scene), body_(&body), statics_(statics) {}

  // Sets the size of the next steps, s. An explicit method starts afresh if the size changes.
  void set_step(double time_step);

  // Advances `state` by one step, with the load (N) `load_before` at its start and `load_after` at
  // its end. `rule` is the rule of [memory] for Implicit and Modal; the other methods ignore it.
  // Returns a sentence if the equations do not converge.
  [[nodiscard]] std::optional<std::string> step(integrate::State& state,
                                                const integrate::Vector& load_before,
                                                const integrate::Vector& load_after,
                                                integrate::MemoryRule rule);

  // After set_step().
  [[nodiscard]] Method& method() { return *method_; }
  [[nodiscard]] double time_step() const { return time_step_; }

  // How often set_step() has made a new method; explicit methods are remade for another step size.
  [[nodiscard]] int beginnings() const { return beginnings_; }

 private:
  const scene::Scene* scene_;
  const scene::SpringBody* body_;
  SymmetricSolver* statics_;
  std::optional<Method> method_;
  double time_step_ = 0.0;
  int beginnings_ = 0;
  integrate::Vector load_;          // N, at the end of the first stage of TR-BDF2
  integrate::Vector displacement_;  // m, of the current linearisation
};

// Prepares `statics`, if it is not prepared yet, for the stiffness of the body at rest. Throws
// MeshError if the supports do not hold the body.
void prepare(SymmetricSolver& statics, const scene::SpringBody& body);

// One step of `method` (Implicit or Modal), or one stage of TrBdf2, that ends under `load` (N).
// `displacement` is a temporary. Returns a sentence if the equations do not converge.
template <class Linearised>
[[nodiscard]] std::optional<std::string> solve_step(
    Linearised& method, const scene::SpringBody& body, integrate::State& state, double time_step,
    integrate::MemoryRule rule, const integrate::Vector& load, integrate::Vector& displacement) {
  displacement = state.displacement;
  method.begin(state, time_step, rule);
  for (int i = 0; i < most_linearisations; ++i) {
    if (!method.linearise(displacement, load)) return not_positive;
    const double change = (method.base() - displacement).cwiseAbs().maxCoeff();
    displacement = method.base();
    if (!std::isfinite(change)) return not_finite;
    if (body.linear() || change <= settled_length) {
      method.finish(state, displacement, load);
      return std::nullopt;
    }
  }
  return not_settled;
}

template <class Linearised>
[[nodiscard]] std::optional<std::string> solve_step(Linearised& method,
                                                    const scene::SpringBody& body,
                                                    integrate::State& state, double time_step,
                                                    integrate::MemoryRule rule,
                                                    const integrate::Vector& load) {
  integrate::Vector displacement;
  return solve_step(method, body, state, time_step, rule, load, displacement);
}

}  // namespace palpate::mechanics
