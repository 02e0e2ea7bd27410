// Uniform tests: creep, recovery and relaxation of a specimen between platens.
#pragma once

#include <atomic>

#include "record/record.h"
#include "run/march.h"
#include "scene/scene.h"

namespace palpate::run {

// Every `creep` or `relax` step is a test of its own on a fresh specimen; time runs on. All that is
// given must outlive the course.
[[nodiscard]] Course load_uniformly(const scene::Scene& scene, const std::atomic<bool>& stop,
                                    record::CaseRecord& record);

}  // namespace palpate::run
