// The figures of a family of cases: Figure 6 for presses, Figure 7 for uniform tests.
#pragma once

#include <vector>

#include "fit/fit_table.h"
#include "record/record.h"
#include "report/figure.h"
#include "scenario/family.h"

namespace palpate::report {

// Force over indentation with its logarithmic regression; strain over time with its Kelvin-Voigt
// fits; stress over time where a specimen relaxes.
[[nodiscard]] std::vector<Figure> family_figures(const scenario::Family& family,
                                                 const std::vector<record::CaseRecord>& records,
                                                 const std::vector<fit::NamedFit>& fits);

}  // namespace palpate::report
