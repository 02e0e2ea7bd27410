// The strain of every tetrahedron, from where its nodes have gone.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/tet_mesh.h"

namespace palpate::tissue {

// xx, yy, zz, xy, yz, xz of a symmetric tensor; the shears are the tensor's, half of the
// engineer's. Lengthening is positive.
using Strain = std::array<double, 6>;

// Small strain, constant in each tetrahedron: e = (H + H^T) / 2, H the gradient of the displacement
// (m, one a node) over the rest shape. A rotation by the angle r adds strains of about r^2 / 2 that
// are none. Needs tetrahedra of positive volume. One a tetrahedron, in the mesh's order.
[[nodiscard]] std::vector<Strain> small_strain(const geometry::TetMesh& mesh,
                                               std::span<const Vec3> displacement);

}  // namespace palpate::tissue
