// Fits as the rows of fits.csv.
#pragma once

#include <span>
#include <string>

#include "fit/regression.h"
#include "record/table.h"

namespace palpate::fit {

struct NamedFit {
  std::string case_name;
  std::string curve;  // what was fitted: `force_indentation`, `creep`
  Fit fit;
};

// One row a parameter, in the order given; a number that is not known is an empty field.
// Columns: case, curve, model, parameter, unit, estimate, std_error, ci95_low, ci95_high, r2,
// rmse, n, range_low, range_high, termination.
[[nodiscard]] record::Table fit_table(std::span<const NamedFit> fits);

}  // namespace palpate::fit
