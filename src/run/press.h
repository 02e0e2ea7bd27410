// Runs the loading programme of a press.
#pragma once

#include <atomic>

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// Runs all steps and adds rows, maps, frames, remarks and findings of the mesh to `record`. If
// `stop` is set, the case ends as interrupted at the next solver step.
void press(const scene::Scene& scene, const std::atomic<bool>& stop, record::CaseRecord& record);

}  // namespace palpate::run
