// Computes the findings and warnings of a finished case.
#pragma once

#include <optional>

#include "record/record.h"
#include "scenario/scenario.h"
#include "scene/scene.h"

namespace palpate::run {

// The force (N, ContactRow::force) at which the first `indent` reaches the indentation `depth` (m,
// above 0). For F ~ h^(3/2) and rows at a distance dh it is too large by at most the fraction 3/32
// (dh / h)^2. Nothing if the indentation is not reached.
[[nodiscard]] std::optional<double> force_at_indentation(const scenario::PlainScenario& scenario,
                                                         const record::CaseRecord& record,
                                                         double depth);

// The time (s) from the application of the load until the first creep test reaches half of
// `elastic_strain`: tau ln 2 for a Kelvin-Voigt solid. Nothing if the load is removed earlier.
[[nodiscard]] std::optional<double> creep_half_time(const record::CaseRecord& record,
                                                    double elastic_strain);

// Adds findings (named numbers) and warnings (sentences on validity) from the scene and the rows.
void add_findings(const scene::Scene& scene, record::CaseRecord& record);

}  // namespace palpate::run
