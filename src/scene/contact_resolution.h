// Whether a mesh is fine enough to carry a contact by itself.
#pragma once

#include "scene/scene.h"

namespace palpate::scene {

// Cells of the skin along the contact radius a = sqrt(R h) of the deepest travel, where it is
// coarsest on the finger's way. A cell is two triangles: its side is the root of twice their mean
// area within a of the finger.                                            docs/theory.md (73)
[[nodiscard]] double cells_per_contact_radius(const Scene& scene);

// Throws MeshError where `resolved` has fewer than three.
void refuse_unresolved(const Scene& scene);

}  // namespace palpate::scene
