// Computes the findings and remarks of a finished case.
#pragma once

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// Adds findings (named numbers) and remarks (sentences on validity) from the scene and the rows.
void add_findings(const scene::Scene& scene, record::CaseRecord& record);

// Adds findings and remarks to a press whose settings select a method that fails: a fixed edge too
// near, volumes that lock, a load on one node, curvature without sign, friction that jumps,
// Kelvin-Voigt tissue under a finger that turns back, and a stiffness that a device cannot render
// passively. Adds nothing otherwise.                                    docs/theory.md [failures]
void add_known_failures(const scene::Scene& scene, record::CaseRecord& record);

}  // namespace palpate::run
