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

// Each figure lists the file and columns that it uses for a series that names none.

// Force against the displacement, the indentation of test standards: force_indentation.csv,
// travel_mm, force_N.
[[nodiscard]] plot::Figure figure_force_indentation(std::vector<plot::Series> series);
// The same over indentation_mm, the effective depth, which the contact law and its fits take
// (Figure 6).
[[nodiscard]] plot::Figure figure_force_depth(std::vector<plot::Series> series);

// Force against the curvature of the tissue at the contact (Figure 6 of the paper, lower graph),
// one point per case: findings.csv, local_curvature_per_m, peak_force_N.
[[nodiscard]] plot::Figure figure_force_curvature(std::vector<plot::Series> series);

// Force along a slide: force_indentation.csv, slide_mm, force_N.
[[nodiscard]] plot::Figure figure_force_slide(std::vector<plot::Series> series);

// Travel along a slide at constant force: force_indentation.csv, slide_mm, travel_mm.
[[nodiscard]] plot::Figure figure_displacement_slide(std::vector<plot::Series> series);

// Strain against time (Figure 7 of the paper): strain_time.csv, time_s, strain.
[[nodiscard]] plot::Figure figure_strain_time(std::vector<plot::Series> series);

// Stress against time in relaxation: strain_time.csv, time_s, stress_kPa.
[[nodiscard]] plot::Figure figure_stress_time(std::vector<plot::Series> series);

// Stress against strain in compression: strain_time.csv, strain, stress_kPa.
[[nodiscard]] plot::Figure figure_stress_strain(std::vector<plot::Series> series);

// Force over time, for holds and live runs: force_indentation.csv, time_s, force_N.
[[nodiscard]] plot::Figure figure_force_time(std::vector<plot::Series> series);

// A fit as a curve over its range of x; nothing if an estimate is not finite.
[[nodiscard]] std::optional<plot::FittedCurve> fitted_curve(const fit::Fit& fit);

// The endings of the pictures that a scenario asks for: `svg`, then `pdf` and `png`.
[[nodiscard]] std::vector<std::string> picture_formats(const scenario::Output& output);

// Presses: force over indentation with its logarithmic regression; force or travel along a slide;
// force over curvature if the cases have three curvatures or more. Uniform tests: strain over time
// for creep, stress over time for relaxation, with their fits.
[[nodiscard]] std::vector<plot::Figure> family_figures(
    const scenario::Family& family, const std::vector<record::CaseRecord>& records,
    const std::vector<fit::NamedFit>& fits);

}  // namespace palpate::report
