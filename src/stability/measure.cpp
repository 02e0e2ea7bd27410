// Bisection for methods with a limit; trials at growing steps for the others.
#include "stability/measure.h"

#include <algorithm>

#include "base/text.h"

namespace palpate::stability {
namespace {

Failure failure_of(Ending ending) {
  switch (ending) {
    case Ending::bounded: break;
    case Ending::grows: return Failure::divergence;
    case Ending::not_finite: return Failure::non_finite;
    case Ending::cannot_step: return Failure::non_finite;
  }
  return Failure::none;
}

constexpr double resolution = 1e-3;  // relative, of a bisected limit
constexpr double farthest = 1000.0;  // times 2 / omega: longest step for methods without a limit

}  // namespace

Measured measure_limit(ProbedBody& probed, const Method& method, const tissue::ViscousLaw& law,
                       const ContactSpring* contact) {
  const scene::Specimen& specimen = *probed.scene.specimen;
  const scene::SpringBody body(specimen.network, tissue::Kinematics::linear, law, specimen.held);
  probed.scene.scenario.solver.integrator = method.integrator;
  const BodyMode with_contact =
      contact != nullptr ? highest_mode(*probed.elastic, contact) : BodyMode{};
  const BodyMode& mode = contact != nullptr ? with_contact : probed.highest;
  FreeMotion motion{.scene = &probed.scene,
                    .body = &body,
                    .lagged = method.lags,
                    .centred = method == Method{},
                    .mode = mode,
                    .contact = contact};
  Measured measured;
  measured.theory = limit_theory(method, mode.frequency, law);
  const double explicit_limit = 2.0 / mode.frequency;
  Ending beyond = Ending::bounded;
  const auto stable = [&](double step) {
    const Moved moved = move(motion, step);
    if (moved.ending != Ending::bounded) beyond = moved.ending;
    return moved.ending == Ending::bounded;
  };
  if (measured.theory) {
    choose_length(motion, damping_ratio(mode.frequency, law));
    measured.limit = bisect_limit(stable, 0.5 * explicit_limit, 2e4 * explicit_limit, resolution);
    measured.failure = measured.limit ? failure_of(beyond) : Failure::none;
    if (!measured.limit) measured.note = "no limit found";
    return measured;
  }
  motion.steps = 100;
  for (double times = method.integrator == Integrator::modal ? farthest : 1.0; times <= farthest;
       times *= 10.0) {
    if (stable(times * explicit_limit)) continue;
    measured.failure = failure_of(beyond);
    measured.limit =
        bisect_limit(stable, times * explicit_limit, 2.0 * times * explicit_limit, resolution);
    if (beyond == Ending::cannot_step) measured.note = "its equations have no solution";
    return measured;
  }
  measured.note = "stable at " + rounded_text(farthest, 4) + " times the explicit limit, " +
                  rounded_text(farthest * explicit_limit, 3) + " s";
  return measured;
}

}  // namespace palpate::stability
