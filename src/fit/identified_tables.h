// What identify() found, as tables and as sentences.
#pragma once

#include <string>
#include <vector>

#include "fit/identify.h"
#include "record/table.h"

namespace palpate::fit {

// unknown, unit, estimate, std_error, ci95_low, ci95_high, at_bound, tied, profile_low,
// profile_high, interval, moved_down, moved_up: a row an unknown, then a row a combination. Tied
// unknowns have no numbers; `interval` says which of the two to trust, `student` or `profile`.
[[nodiscard]] record::Table identified_table(const Identification& found);

// unknown, then a column an unknown; empty where one of the two is tied or on its bound.
[[nodiscard]] record::Table correlation_table(const Identification& found);

// x, measured, model, residual, with names and units of the curve.
[[nodiscard]] record::Table residual_table(const Identification& found);

// unknown, unit, value, delta, threshold: the profile likelihood, delta = (SSE - least SSE) / s^2.
[[nodiscard]] record::Table profile_table(const Identification& found);

// The 95 % interval to trust, in the unit shown; nothing: open on that side.
struct Interval {
  std::optional<double> low, high;
};
[[nodiscard]] Interval trusted(const Identified& one);

// For people, a line each: the estimates, what is tied, the model, the residuals, the contact
// point. Notes and warnings are not in it.
[[nodiscard]] std::vector<std::string> identified_sentences(const Identification& found);

}  // namespace palpate::fit
