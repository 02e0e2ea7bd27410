// Measures one limit of the time step and computes it from theory.
#pragma once

#include "stability/free_motion.h"
#include "stability/limit_theory.h"
#include "stability/probed_body.h"
#include "stability/stability.h"

namespace palpate::stability {

struct Measured {
  std::optional<double> limit;      // s; nothing: none was found
  std::optional<double> theory;     // s
  Failure failure = Failure::none;  // beyond the limit
  std::string note;
};
// The limit of `method` for the body with the viscous law `law`; `contact` may be null. `modal`,
// whose decomposition is repeated in every trial, is tried with one time step only.
[[nodiscard]] Measured measure_limit(ProbedBody& probed, const Method& method,
                                     const tissue::ViscousLaw& law, const ContactSpring* contact);

}  // namespace palpate::stability
