// The table of fits.csv.
#pragma once

#include <span>
#include <string>

#include "fit/regression.h"
#include "record/table.h"

namespace palpate::fit {

struct NamedFit {
  std::string case_name;
  std::string curve;  // `force_indentation`, `creep`, ...
  Fit fit;
};

// One row per parameter, in the given order; an unknown number is an empty field.
// Columns: case, curve, model, parameter, unit, estimate, std_error, ci95_low, ci95_high, r2,
// rmse, n, range_low, range_high, termination.
[[nodiscard]] record::Table fit_table(std::span<const NamedFit> fits);

// The table of `palpate fit`: the same columns, then excluded (points not used), effective_n
// (independent points of the same worth), durbin_watson and law (the formula with its source).
[[nodiscard]] record::Table measured_fit_table(std::span<const NamedFit> fits);

}  // namespace palpate::fit
