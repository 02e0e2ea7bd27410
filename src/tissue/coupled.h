// Springs that represent any E and nu of a tissue: the six springs of a tetrahedron are coupled to
// each other, or a volume term is added to independent springs.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/tet_mesh.h"
#include "tissue/network.h"

namespace palpate::tissue {

struct Isotropic {
  double young_modulus = 0.0;  // Pa, above 0
  double poisson_ratio = 0.0;  // above -1, below 1/2; towards 1/2 the bulk modulus is unbounded
};

// What resists a change of volume: nothing, each tetrahedron by itself (which locks as nu nears
// 1/2), or the change averaged over the tetrahedra around a node.
enum class Volume { none, tetrahedron, nodal };

// mu = E / (2 (1 + nu)), Pa.
[[nodiscard]] double shear_modulus(const Isotropic& tissue);

// K = E / (3 (1 - 2 nu)), Pa.
[[nodiscard]] double bulk_modulus(const Isotropic& tissue);

// The Young's modulus with which independent springs, whose nu is 1/4, have the tissue's mu:
// 5/4 E / (1 + nu), Pa.                                          docs/theory.md [nodal_volume]
[[nodiscard]] double spring_modulus(const Isotropic& tissue);

// The volume stiffness that such springs lack, Pa; negative where nu < 1/4:
// lambda - mu = E (4 nu - 1) / (2 (1 + nu) (1 - 2 nu)).          docs/theory.md [nodal_volume]
[[nodiscard]] double volume_modulus(const Isotropic& tissue);

// Couples the six springs of every tetrahedron so that they are its linear finite element;
// `tissues` has one entry per region of the mesh. The network's former stiffnesses are discarded:
// single springs then have none. With Volume::nodal each tetrahedron keeps the bulk modulus
// min(K, own_share mu), own_share >= 0, and the rest acts on the volume averaged around each node,
// separately for every region that meets there. (With a fraction of K instead, the mesh would lock
// again as nu nears 1/2.) With Volume::none there is no bulk modulus. The tetrahedra must have
// positive volume, and the network must be made of this mesh. After Delingette 2008 (the element in
// terms of its edges) and Bonet and Burton 1998 (the average).
//                                                          docs/theory.md [coupled], [nodal_volume]
void couple(Network& network, const geometry::TetMesh& mesh, std::span<const Isotropic> tissues,
            Volume volume, double own_share);

// Adds a volume term to independent springs: volume_modulus() times the change of each
// tetrahedron's volume, or of the volume averaged as above. Regions with nu = 1/4 need none. The
// stiffness of the springs does not change.                      docs/theory.md [nodal_volume]
void add_volume(Network& network, const geometry::TetMesh& mesh, std::span<const Isotropic> tissues,
                Volume volume);

// xx, yy, zz, xy, yz, xz of a symmetric tensor; shears are tensor components, half of the
// engineering shear strain. Extension is positive.
using Strain = std::array<double, 6>;

// Small strain, constant in each tetrahedron: e = (H + H^T) / 2, where H is the gradient of the
// displacement (m, one per node) over the rest shape. A rotation by the angle r appears as a strain
// of about r^2 / 2. The tetrahedra must have positive volume. One entry per tetrahedron.
[[nodiscard]] std::vector<Strain> small_strain(const geometry::TetMesh& mesh,
                                               std::span<const Vec3> displacement);

}  // namespace palpate::tissue
