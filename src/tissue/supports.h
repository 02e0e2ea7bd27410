// The held degrees of freedom of a specimen: at its base, and between platens.
#pragma once

#include <vector>

#include "geometry/tet_mesh.h"
#include "tissue/network.h"

namespace palpate::tissue {

// bonded: the base does not move. frictionless: the base slides on the table but does not lift off.
enum class Base { bonded, frictionless };

// The message where supports leave a part of a mesh free.
inline constexpr const char* not_held =
    "the base does not hold all tetrahedra of the mesh: its stiffness is singular; check "
    "`tissue.base_height`, and whether all parts of the mesh share nodes";

// One flag per degree of freedom, 1 where it is held. The base is the lowest plane or, if
// `base_height` (m) is positive, the surface up to this height above it. With a frictionless base
// one node is kept from sliding and a second one from turning the body about the first. Heights are
// along `up`, a unit vector; another one than z needs a bonded base.
[[nodiscard]] std::vector<char> held_by_base(const geometry::TetMesh& mesh, Base base,
                                             double base_height = 0.0,
                                             const Vec3& up = Vec3::UnitZ());

// The same, and the height of the nodes at `top` (m) is prescribed; where `platen` is bonded they
// do not move sideways either.
[[nodiscard]] std::vector<char> held_between_platens(const geometry::TetMesh& mesh, Base base,
                                                     double top, Base platen);

}  // namespace palpate::tissue
