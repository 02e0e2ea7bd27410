// What is known to go wrong with settings that are there to be compared: found, and named.
#pragma once

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// Adds findings and remarks of a pressed case where its settings ask for a method that fails: a
// fixed edge too near, volumes that lock, a load on one node, curvature without sign, friction that
// jumps, Kelvin-Voigt turning back, a stiffness that the device cannot hold. Nothing otherwise.
void add_known_failures(const scene::Scene& scene, record::CaseRecord& record);

}  // namespace palpate::run
