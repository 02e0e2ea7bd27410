// The figures of a family of cases: as in the paper, Figure 6 for presses, 7 for uniform tests.
#pragma once

#include <optional>
#include <vector>

#include "fit/case_fits.h"
#include "fit/regression.h"
#include "plot/figure.h"
#include "record/record.h"
#include "scenario/family.h"

namespace palpate::report {

// The displacement is the indentation of test standards; the effective depth enters the contact law
// and its fits (Figure 6). A curvature has one point per case (Figure 6, lower graph), a slide at
// constant force the displacement along it. Strain over time is Figure 7.
enum class Kind {
  force_displacement,
  force_depth,
  force_curvature,
  force_slide,
  displacement_slide,
  strain_time,
  stress_time,
  stress_strain,
  force_time
};
// A figure of these series; one that names no file and columns has those of its kind.
[[nodiscard]] plot::Figure figure_of(Kind kind, std::vector<plot::Series> series);

// A fit as a curve over its range of x; nothing if an estimate is not finite.
[[nodiscard]] std::optional<plot::FittedCurve> fitted_curve(const fit::Fit& fit);

// The endings of the pictures that a scenario asks for: `svg`, then `pdf` and `png`.
[[nodiscard]] std::vector<std::string> picture_formats(const scenario::Output& output);

// Presses: force over indentation with its logarithmic regression; force or displacement along a
// slide; force over curvature if the cases have three curvatures or more. Uniform tests: strain
// over time for creep, stress over time for relaxation, with their fits.
[[nodiscard]] std::vector<plot::Figure> family_figures(
    const scenario::Family& family, const std::vector<record::CaseRecord>& records,
    const std::vector<fit::NamedFit>& fits);

// What a gauge without displacement has measured, which no model follows: force_time.csv.
[[nodiscard]] plot::Figure gauge_figure(const scenario::Family& family);

}  // namespace palpate::report
