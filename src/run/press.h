// A finger pressed into a scene, step after step of the loading programme.
#pragma once

#include <atomic>

#include "record/record.h"
#include "run/march.h"
#include "scene/scene.h"

namespace palpate::run {

// Runs the steps with a finger. `stop` is looked at every output row; a stopped case ends with
// what it has and says so. All that is given must outlive the course.
[[nodiscard]] Course press(const scene::Scene& scene, const std::atomic<bool>& stop,
                           record::CaseRecord& record);

}  // namespace palpate::run
