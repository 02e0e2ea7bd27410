// Springs that know a tissue's own E and nu: coupled inside each tetrahedron, or independent with a
// volume term beside them.
#pragma once

#include <span>

#include "geometry/tet_mesh.h"
#include "tissue/network.h"

namespace palpate::tissue {

struct Isotropic {
  double young_modulus = 0.0;  // Pa, above 0
  double poisson_ratio = 0.0;  // above -1, below 1/2; near 1/2 all stiffness grows without bound
};

// How a change of volume is resisted: not at all, by each tetrahedron for itself (which locks as nu
// nears 1/2), or by the mean over the tetrahedra around a node.
enum class Volume { none, tetrahedron, nodal };

// mu = E / (2 (1 + nu)), Pa.
[[nodiscard]] double shear_modulus(const Isotropic& tissue);

// K = E / (3 (1 - 2 nu)), Pa.
[[nodiscard]] double bulk_modulus(const Isotropic& tissue);

// The E that independent springs, whose own nu is 1/4, need to have the tissue's mu:
// 5/4 E / (1 + nu), Pa.
[[nodiscard]] double spring_modulus(const Isotropic& tissue);

// What is then still missing against a change of volume: lambda - mu =
// E (4 nu - 1) / (2 (1 + nu) (1 - 2 nu)), Pa; below 0 where nu < 1/4.
[[nodiscard]] double volume_modulus(const Isotropic& tissue);

// Couples the six springs of every tetrahedron so that they are the linear finite element of their
// tissue (one a region of the mesh). Springs then have no stiffness by themselves: what the network
// had is replaced. With Volume::nodal the tetrahedra keep a bulk modulus of `own_share` times mu (0
// or more), at most all of K, and the rest acts on the volume averaged around each node, separately
// for every region that meets there: a share of K instead would lock again as nu nears 1/2. With
// Volume::none there is no bulk modulus at all. Needs tetrahedra of positive volume and a network
// made of this mesh. After Delingette 2008 (the element by its edges) and Bonet and Burton 1998
// (the average).                                                      docs/theory.md (65), (66)
void couple(Network& network, const geometry::TetMesh& mesh, std::span<const Isotropic> tissues,
            Volume volume, double own_share);

// Adds the volume term of springs that are independent otherwise: volume_modulus() times the change
// of each tetrahedron's volume, or of the volume averaged as above. Regions at nu = 1/4 need none.
// The springs' stiffness stays what it was.                               docs/theory.md (66)
void add_volume(Network& network, const geometry::TetMesh& mesh, std::span<const Isotropic> tissues,
                Volume volume);

}  // namespace palpate::tissue
