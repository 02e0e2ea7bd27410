// Whether a mesh is fine enough for `resolved` contact.
#pragma once

#include "scene/scene.h"

namespace palpate::scene {

// Number of cells of the surface along the contact radius a = sqrt(R h) of the deepest travel, at
// the coarsest place of the finger's path. A cell is two triangles; its side is the square root of
// twice their mean area within a of the finger.                              docs/theory.md [cells]
[[nodiscard]] double cells_per_contact_radius(const Scene& scene);

// Throws MeshError if the coupling is `resolved` and there are fewer than three such cells.
void refuse_unresolved(const Scene& scene);

}  // namespace palpate::scene
