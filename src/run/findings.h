// Computes the findings and remarks of a finished case.
#pragma once

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// Adds findings (named numbers) and remarks (sentences on validity) from the scene and the rows.
void add_findings(const scene::Scene& scene, record::CaseRecord& record);

}  // namespace palpate::run
