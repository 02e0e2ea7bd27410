// What a finished case shows: named numbers, and sentences on its validity.
#pragma once

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// Adds the findings and remarks that follow from the scene and its rows.
void add_findings(const scene::Scene& scene, record::CaseRecord& record);

}  // namespace palpate::run
