// The figures of a family of cases: as in the paper, Figure 6 for presses, 7 for uniform tests.
#pragma once

#include <vector>

#include "fit/fit_table.h"
#include "plot/figure.h"
#include "record/record.h"
#include "scenario/family.h"

namespace palpate::report {

// The endings of the pictures that a scenario asks for: `svg`, then `pdf` and `png`.
[[nodiscard]] std::vector<std::string> picture_formats(const scenario::Output& output);

// Presses: force over indentation with its logarithmic regression; force or travel along a slide;
// force over curvature if the cases have three curvatures or more. Uniform tests: strain over time
// for creep, stress over time for relaxation, with their fits.
[[nodiscard]] std::vector<plot::Figure> family_figures(
    const scenario::Family& family, const std::vector<record::CaseRecord>& records,
    const std::vector<fit::NamedFit>& fits);

}  // namespace palpate::report
