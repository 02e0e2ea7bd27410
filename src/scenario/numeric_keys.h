// The numbers of a scenario by the names of their keys: what a search may vary.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.h"
#include "scenario/scenario.h"

namespace palpate::scenario {

struct NumericKey {
  std::string path;             // as `--set` writes it: `tissue.shape.size.3`, `region.1.top`
  std::optional<double> value;  // SI; nothing where the scenario leaves it open
  std::optional<Unit> unit;     // nothing: a pure number
  Range range;                  // SI
  Use use;                      // where it counts, its table's included
};

// Every key that holds a real number or a quantity, in the order of fields(); entries of lists one
// by one, counted from 1. Whole numbers are none.
[[nodiscard]] std::vector<NumericKey> numeric_keys(const Scenario& scenario);

// Sets the number of that path, SI, without any check. False where there is none.
bool set_number(Scenario& scenario, std::string_view path, double si);

}  // namespace palpate::scenario
