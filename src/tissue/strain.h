// The strain of every tetrahedron from the displacements of its nodes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/tet_mesh.h"

namespace palpate::tissue {

// xx, yy, zz, xy, yz, xz of a symmetric tensor; shears are tensor components, half of the
// engineering shear strain. Extension is positive.
using Strain = std::array<double, 6>;

// Small strain, constant in each tetrahedron: e = (H + H^T) / 2, where H is the gradient of the
// displacement (m, one per node) over the rest shape. A rotation by the angle r appears as a strain
// of about r^2 / 2. The tetrahedra must have positive volume. One entry per tetrahedron.
[[nodiscard]] std::vector<Strain> small_strain(const geometry::TetMesh& mesh,
                                               std::span<const Vec3> displacement);

}  // namespace palpate::tissue
