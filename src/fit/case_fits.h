// The fits of a case: which curves are fitted, and with which models; and the table of fits.csv.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fit/regression.h"
#include "record/record.h"
#include "record/table.h"
#include "scenario/resolved.h"

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

// Press: force over indentation of the first `indent`, with the models logarithmic, power and
// exponential. Uniform test: creep with Kelvin-Voigt (or standard_linear_solid, for a tissue with
// that viscosity), recovery with Kelvin-Voigt, relaxation with standard_linear_solid. A curve with
// too few points is excluded. With a display scale other than 1 the scaled curve is fitted as well.
// Correlated residuals, as `palpate fit` takes them, cost some milliseconds a fit, which a sweep
// has not.
[[nodiscard]] std::vector<NamedFit> case_fits(const scenario::Resolved& scenario,
                                              const record::CaseRecord& record,
                                              Residuals residuals = Residuals::independent);

}  // namespace palpate::fit
