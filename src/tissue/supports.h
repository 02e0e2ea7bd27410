// Which degrees of freedom of a specimen are held, and how its ends are pressed.
#pragma once

#include <vector>

#include "geometry/tet_mesh.h"
#include "tissue/springs.h"

namespace palpate::tissue {

// bonded: the base does not move. frictionless: it slides on the table, but does not lift.
enum class Base { bonded, frictionless };

// One flag a degree of freedom, 1 where it is held. The base is the lowest plane, or, for a
// `base_height` above 0 (m), all of the skin up to so far above it. A frictionless base keeps one
// node from sliding and a second one from turning the body about it.
[[nodiscard]] std::vector<char> held_by_base(const geometry::TetMesh& mesh, Base base,
                                             double base_height = 0.0);

// The same, and the top at height `top` moves only sideways: its height is prescribed.
[[nodiscard]] std::vector<char> held_between_platens(const geometry::TetMesh& mesh, Base base,
                                                     double top);

}  // namespace palpate::tissue
