// The scenario's integrator at work on a body: one step under loads that are known.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "integrate/central_difference.h"
#include "integrate/implicit.h"
#include "integrate/modal.h"
#include "integrate/semi_implicit_euler.h"
#include "integrate/tr_bdf2.h"
#include "scene/scene.h"

namespace palpate::run {

// Whether a scalar equation inside each linearisation is settled: a change of displacement, m.
inline constexpr double settled_length = 1e-12;
inline constexpr int most_linearisations = 100;

class Stepper {
 public:
  using Method = std::variant<integrate::CentralDifference, integrate::SemiImplicitEuler,
                              integrate::Implicit, integrate::TrBdf2, integrate::Modal>;

  Stepper(const scene::Scene& scene, const scene::SpringBody& body)
      : scene_(&scene), body_(&body) {}

  // The next steps have this size, s. A method that can change its step goes on.
  void set_step(double time_step);

  // From the state under `load_before` to the next one under `load_after` (N). `rule` is how
  // viscous memory passes through a step without inertia. Returns what is wrong where the
  // equations do not settle.
  [[nodiscard]] std::optional<std::string> step(integrate::State& state,
                                                const integrate::Vector& load_before,
                                                const integrate::Vector& load_after,
                                                integrate::MemoryRule rule);

  // After set_step().
  [[nodiscard]] Method& method() { return *method_; }
  [[nodiscard]] double time_step() const { return time_step_; }

  // How often a method has begun afresh: explicit ones do with another step.
  [[nodiscard]] int beginnings() const { return beginnings_; }

 private:
  const scene::Scene* scene_;
  const scene::SpringBody* body_;
  std::optional<Method> method_;
  double time_step_ = 0.0;
  int beginnings_ = 0;
  integrate::Vector load_;          // N, where a step has a middle
  integrate::Vector displacement_;  // m, of linearisations
};

// One implicit step of `method` (Implicit or Modal), or one stage of TrBdf2, under a known load;
// `displacement` is room.
template <class Linearised>
[[nodiscard]] std::optional<std::string> solve_step(
    Linearised& method, const scene::SpringBody& body, integrate::State& state, double time_step,
    integrate::MemoryRule rule, const integrate::Vector& load, integrate::Vector& displacement) {
  displacement = state.displacement;
  method.begin(state, time_step, rule);
  for (int i = 0; i < most_linearisations; ++i) {
    if (!method.linearise(displacement, load)) return "the tangent stiffness is not positive";
    const double change = (method.base() - displacement).cwiseAbs().maxCoeff();
    displacement = method.base();
    if (!std::isfinite(change)) return "the motion has left the finite numbers";
    if (body.linear() || change <= settled_length) {
      method.finish(state, displacement, load);
      return std::nullopt;
    }
  }
  return "the non-linear equations did not settle in 100 iterations";
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

}  // namespace palpate::run
