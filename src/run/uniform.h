// Uniform tests: creep, recovery and relaxation of a specimen between platens.
#pragma once

#include <atomic>

#include "record/record.h"
#include "run/march.h"
#include "scene/scene.h"

namespace palpate::run {

// Runs every `creep` or `relax` step as a separate test of an unloaded specimen; time continues
// from step to step. If `stop` is set, the case ends as interrupted after some steps.
void load_uniformly(const scene::Scene& scene, const std::atomic<bool>& stop,
                    record::CaseRecord& record);

// The same as a coroutine, which pauses when its mesh has to be advanced. The arguments outlive it.
[[nodiscard]] Course uniform_course(const scene::Scene& scene, const std::atomic<bool>& stop,
                                    record::CaseRecord& record);

}  // namespace palpate::run
