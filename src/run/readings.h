// Single numbers read off a case's curves, between its rows.
#pragma once

#include <optional>

#include "record/record.h"
#include "scenario/scenario.h"

namespace palpate::run {

// The force (N, `force` of the rows) at which the first `indent` comes to the indentation `depth`
// (m, above 0), on a straight line between the two rows around it: of F ~ h^(3/2) at rows dh apart
// that is at most 3/32 (dh / h)^2 of the force too much. Nothing where it does not get there.
[[nodiscard]] std::optional<double> force_at_indentation(const scenario::Scenario& scenario,
                                                         const record::CaseRecord& record,
                                                         double depth);

// How long (s) after its load the first creep test has half of `elastic_strain`, on a straight
// line between two rows: tau ln 2 of a Kelvin-Voigt solid. Nothing where the load is taken off
// before.
[[nodiscard]] std::optional<double> creep_half_time(const record::CaseRecord& record,
                                                    double elastic_strain);

}  // namespace palpate::run
