// A body that is struck once and left alone: whether its energy grows, at which steps.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scene/scene.h"
#include "study/modes.h"

namespace palpate::study {

// Central differences with the velocity of the step before in the damper, one of the ways to read
// eq. (12) that DESIGN warns of; everything else as integrate::CentralDifference.
class LaggedDifference {
 public:
  LaggedDifference(const integrate::Body& body, double time_step)
      : body_(&body), time_step_(time_step) {}

  // M (u(t + dt) - 2 u(t) + u(t - dt)) / dt^2 + D (u(t) - u(t - dt)) / dt + f(u) = F
  void step(integrate::State& state, const integrate::Vector& load);

 private:
  const integrate::Body* body_;
  double time_step_;
  integrate::Vector force_;
  integrate::Vector damping_;
  integrate::Vector dashpots_;
};

struct FreeMotion {
  // Whose scenario names the integrator; the body is of its specimen, with a viscous law of its
  // own.
  const scene::Scene* scene = nullptr;
  const scene::SpringBody* body = nullptr;
  bool lagged = false;  // the method is LaggedDifference instead
  bool centred = true;  // its damping takes the mean velocity of a step and the one before
  BodyMode mode;        // it is struck in this shape, and a scattered rest of a third of it
  const ContactSpring* contact = nullptr;
  int steps = 400;
  // A motion grows where the greatest energy of its last quarter is above that of its second one by
  // more than this factor: beats of undamped modes swing, damped ones do not.
  double growth = 2.0;
};

enum class Ending {
  bounded,
  grows,        // energy without input
  not_finite,   // numbers have left the finite ones
  cannot_step,  // the method's own equations have no answer
};

struct Moved {
  Ending ending = Ending::bounded;
  int steps = 0;        // done
  double before = 0.0;  // J, the greatest energy of the second quarter
  double after = 0.0;   // J, of the last one; of the last step where it broke off
};

// Moves at this step, s. Breaks off where the energy is `enough` times that of the stroke.
[[nodiscard]] Moved move(const FreeMotion& motion, double time_step, double enough = 1e12);

// What a body of this damping ratio needs, so that a step of half a percent above its limit shows.
void choose_length(FreeMotion& motion, double damping_ratio);

// The step (s) between stable and unstable ones, to `resolution` (relative), from `start` by
// doubling and halving, then by bisection in the logarithm. Nothing where every step up to `most`
// is stable; 0 where none down to 1e-9 of `start` is.
[[nodiscard]] std::optional<double> bisect_limit(const std::function<bool(double)>& stable,
                                                 double start, double most, double resolution);

}  // namespace palpate::study
