// Known numbers of a scenario with their uncertainty: `finger.radius=11 mm +- 0.2 mm`.
#pragma once

#include <string>
#include <vector>

#include "identify/identify.h"

namespace palpate::identify {

// A key of the scenario with its value and standard deviation, SI.
struct Given {
  std::string key;
  std::optional<Unit> unit;
  double value = 0.0;
  double deviation = 0.0;
};

// Reads `KEY=VALUE +- SD`, with `+-` or the plus-minus sign. Throws InputError for unknown keys,
// for keys that are unknowns as well, for numbers outside the key's limits and for deviations that
// are not above 0.
[[nodiscard]] std::vector<Given> read_givens(const std::vector<std::string>& texts,
                                             const scenario::Scenario& scenario,
                                             const std::vector<Unknown>& unknowns);

// Sets the values in the family's first case.
void set_givens(scenario::Family& family, const std::vector<Given>& givens);

// Repeats the search with each given a standard deviation lower and higher, and widens the
// intervals of the unknowns: the variance of an estimate grows by the square of half the difference
// (docs/theory.md [givens]). The parts are kept in Identification::givens. `family` has the values
// set.
void carry_givens(Identification& found, const Measurement& measured,
                  const scenario::Family& family, const std::vector<Given>& givens, Noise noise);

}  // namespace palpate::identify
