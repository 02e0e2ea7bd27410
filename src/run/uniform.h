// Uniform tests: creep, recovery and relaxation of a specimen between platens.
#pragma once

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// Runs every `creep` or `relax` step as a separate test of an unloaded specimen; time continues
// from step to step. Throws Stopped where its thread is stopped.
void load_uniformly(const scene::Scene& scene, record::CaseRecord& record);

}  // namespace palpate::run
