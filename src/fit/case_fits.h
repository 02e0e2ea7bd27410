// The fits of a case: which curves are fitted, and with which models.
#pragma once

#include <vector>

#include "fit/fit_table.h"
#include "record/record.h"
#include "scenario/resolved.h"

namespace palpate::fit {

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
