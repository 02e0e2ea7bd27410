// Which curves of a case are fitted, and by what.
#pragma once

#include <vector>

#include "fit/fit_table.h"
#include "record/record.h"
#include "scenario/scenario.h"

namespace palpate::fit {

// Of a press: force over indentation of the first `indent`, logarithmic, power and exponential.
// Of a uniform test: creep and recovery by Kelvin-Voigt, relaxation by the standard linear solid.
// A curve with too few points is left out. A display scale other than 1 adds the scaled curve.
[[nodiscard]] std::vector<NamedFit> case_fits(const scenario::Scenario& scenario,
                                              const record::CaseRecord& record);

}  // namespace palpate::fit
