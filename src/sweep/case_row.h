// What a sweep keeps of a finished case.
#pragma once

#include "record/record.h"
#include "scene/scene.h"
#include "sweep/row.h"

namespace palpate::sweep {

// Findings, parameters of fits if the scenario asks for them, and the curve if it is to be kept;
// without id and attempt.
[[nodiscard]] SweepRow row_of(const scene::Scene& scene, const record::CaseRecord& record,
                              bool keeps_curve);

}  // namespace palpate::sweep
