// The free motion of a body after one stroke: whether its energy grows, at a given time step.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scene/scene.h"
#include "stability/modes.h"

namespace palpate::stability {

// Central differences whose damping force uses the velocity of the previous step; otherwise the
// same as integrate::CentralDifference.                  `lagged` in docs/theory.md [semi_implicit]
class LaggedDifference {
 public:
  LaggedDifference(const integrate::Body& body, double time_step)
      : body_(&body), time_step_(time_step) {}

  // M (u(t + dt) - 2 u(t) + u(t - dt)) / dt^2 + D (u(t) - u(t - dt)) / dt + f(u) = F
  void step(integrate::State& state, const integrate::Vector& load);

 private:
  const integrate::Body* body_;
  double time_step_;
  integrate::Vector damping_;
  integrate::Vector dashpots_;
};

struct FreeMotion {
  const scene::Scene* scene = nullptr;      // its scenario names the integrator
  const scene::SpringBody* body = nullptr;  // the scene's specimen with another viscous law
  bool lagged = false;                      // LaggedDifference instead of the integrator
  bool centred = true;  // the damping force uses the mean velocity of two successive steps
  BodyMode mode;        // shape of the stroke; an irregular part of 0.3 of its size is added
  const ContactSpring* contact = nullptr;
  int steps = 400;
  // The motion counts as growing if the largest energy of its last quarter exceeds that of its
  // second quarter by more than this factor. Undamped modes beat, so that 1 would be too small.
  double growth = 2.0;
};

enum class Ending {
  bounded,
  grows,        // energy grows without input
  not_finite,   // a number is infinite or NaN
  cannot_step,  // the method's equations have no solution
};

struct Moved {
  Ending ending = Ending::bounded;
  int steps = 0;        // carried out
  double before = 0.0;  // J, largest energy of the second quarter
  double after = 0.0;   // J, of the last quarter; if the motion was stopped, of the last step
};

// Computes the motion with this time step, s. Stops if the energy is `enough` times the first.
[[nodiscard]] Moved move(const FreeMotion& motion, double time_step, double enough = 1e12);

// Sets `steps` and `growth` so that a time step 0.25 % above the limit is seen to be unstable.
void choose_length(FreeMotion& motion, double damping_ratio);

// The limit between stable and unstable time steps, s, with the relative error `resolution`: from
// `start` by doubling or halving, then by bisection. Nothing if every step up to
// `most` is stable; 0 if no step down to 1e-9 of `start` is.
[[nodiscard]] std::optional<double> bisect_limit(const std::function<bool(double)>& stable,
                                                 double start, double most, double resolution);

}  // namespace palpate::stability
