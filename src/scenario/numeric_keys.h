// The numbers of a scenario by the names of their keys: the possible unknowns of a search.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.h"
#include "scenario/scenario.h"

namespace palpate::scenario {

struct NumericKey {
  std::string path;          // as in `--set`: `tissue.shape.size.3`, `region.1.top`
  std::optional<Unit> unit;  // nothing for a pure number
  Range range;               // in SI units
  Use use;                   // when the key has an effect, with the condition of its table
};

// All keys of real numbers and quantities, in the order of fields(); entries of lists are separate
// keys, counted from 1. Whole numbers are not included.
[[nodiscard]] std::vector<NumericKey> numeric_keys(const Scenario& scenario);

// Sets the number at `path` to `si`, in SI units and unchecked. Returns false if there is none.
bool set_number(Scenario& scenario, std::string_view path, double si);

}  // namespace palpate::scenario
