// The specimen's tetrahedra from what the scenario says of its shape, mesh and regions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/shapes.h"
#include "geometry/tet_mesh.h"
#include "scenario/scenario.h"

namespace palpate::scene {

// The parametric shape, where it is one.
[[nodiscard]] std::optional<geometry::Shape> parametric(const scenario::Shape& shape);

// The mesh and the substances that its regions name: TetMesh::regions counts from 0 for
// `tissue.material`, then the scenario's regions in order. A uniform test stands a shape that lies
// along y up on its end. Files are looked for in `folder`.
// Throws MeshError for what cannot be meshed, InputError for a region that the mesh does not have.
[[nodiscard]] geometry::TetMesh specimen_mesh(const scenario::Scenario& scenario,
                                              const std::string& folder);

}  // namespace palpate::scene
