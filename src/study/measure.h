// One limit of the time step, measured and by theory.
#pragma once

#include "study/free_motion.h"
#include "study/stability.h"
#include "study/variant.h"

namespace palpate::study {

// The methods of a map by name: the words of scenarios without `auto`, and lagged_velocity.
[[nodiscard]] std::vector<std::string> methods();

// A body in this damping form under this method; `contact` may be null. Modal bodies are
// decomposed at every trial: a large one is tried once.
struct Measured {
  std::optional<double> limit;   // s
  std::optional<double> theory;  // s
  Failure failure = Failure::none;
  std::string note;
};
[[nodiscard]] Measured measure_limit(Variant& variant, const std::string& method,
                                     const tissue::ViscousLaw& law, const ContactSpring* contact);

}  // namespace palpate::study
