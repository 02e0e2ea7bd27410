// Scenes whose mesh is refined where its own error in the force comes from.
#pragma once

#include "scene/scene.h"
#include "scene/specimen_shape.h"

namespace palpate::run {

// scene::build(), with a mesh that is refined if the scenario asks for it (`tissue.mesh.refine`):
// the tetrahedra that hold most of the error e of [compliance] are halved three times, until
// the stated error is below half of `solver.tolerance` or the mesh has `most_nodes`. The other half
// is for what the model neglects. Throws what scene::build() throws.
//                                                                docs/theory.md [compliance]
[[nodiscard]] scene::Scene build_scene(const scenario::Case& one, const scenario::Family& family);
[[nodiscard]] scene::Scene build_scene(const scenario::Case& one, const scenario::Family& family,
                                       scene::SpecimenShapes& shapes);
[[nodiscard]] scene::Scene build_scene(const scenario::Case& one, const scenario::Family& family,
                                       scene::SpecimenShapes& shapes, scene::Choice choice);

}  // namespace palpate::run
