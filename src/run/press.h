// Runs the loading history of a press.
#pragma once

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// Runs all steps and adds rows, maps, frames, remarks and findings of the mesh to `record`. Throws
// Stopped where its thread is stopped.
void press(const scene::Scene& scene, record::CaseRecord& record);

}  // namespace palpate::run
