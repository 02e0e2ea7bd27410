// The results of identify() as tables and as sentences, and in a result folder: tables, figures and
// the fitted scenario.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/whole_folder.h"
#include "identify/identify.h"
#include "plot/gnuplot.h"
#include "record/table.h"
#include "report/manifest.h"
#include "scenario/family.h"

namespace palpate::identify {

// unknown, unit, estimate, std_error, ci95_low, ci95_high, at_bound, identifiable,
// profile_low, profile_high, interval, moved_down, moved_up: one row per unknown, then one per
// combination. Tied unknowns have no numbers; `interval` names the interval to trust, `student` or
// `profile`.
[[nodiscard]] record::Table identified_table(const Identification& found);

// unknown, then one column per unknown; empty if one of the two is not separately identifiable or
// at a bound.
[[nodiscard]] record::Table correlation_table(const Identification& found);

// unknown, unit, value, delta, threshold: the profile likelihood, delta = (SSE - least SSE) / s^2,
// threshold = t^2.                                                       docs/theory.md [profile]
[[nodiscard]] record::Table profile_table(const Identification& found);

// Whether residuals are below a millionth of the curve: rounding, of the file's digits or the
// computation's.
[[nodiscard]] bool is_exact(const Identification& found);

// The 95 % interval to trust, in the unknown's unit; nothing: open on that side.
struct Interval {
  std::optional<double> low, high;
};
[[nodiscard]] Interval trusted(const Identified& one);

// What computed the curve: `layer` in back-quotes, or the formula of a uniform specimen, for which
// no model runs.
[[nodiscard]] std::string computed_by(const CurveFit& found);

// Lines for stdout: estimates, inseparable unknowns, model, residuals and effect of
// the contact point.
[[nodiscard]] std::vector<std::string> identified_sentences(const Identification& found);

struct WeightedResiduals {
  std::span<const double> values;  // in the order of the points
  double noise = 0.0;              // their standard deviation
};

// Sentences on why the estimates may be wrong: on correlated residuals, few independent points, R^2
// below 0.9, estimates at a bound, the model's own error at the estimates, and neglected inertia.
[[nodiscard]] std::vector<std::string> warnings_of(const Identification& found,
                                                   const WeightedResiduals& residuals,
                                                   const scenario::Resolved& with);

// curve.gp: data, model and residuals. Reads residuals.csv. Of the pairs of a joint identification
// the names have a suffix: curve_2.gp, residuals_2.csv, scenario_2.toml.
[[nodiscard]] plot::Sheet identified_sheet(const std::string& title, const Identification& found,
                                           const std::string& suffix);
// profile.gp: one panel per unknown, profile likelihood and 95 % level. Reads profile.csv.
[[nodiscard]] plot::Sheet profile_sheet(const std::string& title, const Identification& found);

// Writes an identification into `folder` and renames it to its final name. run.json stores the
// hashes of the measured files. Returns warnings, one per figure that could not
// be drawn. Throws SystemError if the folder cannot be written.
[[nodiscard]] std::vector<std::string> write_identification(const Identification& found,
                                                            std::span<const Pair> pairs,
                                                            const report::Origin& origin,
                                                            WholeFolder& folder);

}  // namespace palpate::identify
