// The contacts of the finger's spheres with the tissue, and what is summed over them.
#pragma once

#include <string>
#include <vector>

#include "contact/law.h"
#include "contact/patch.h"
#include "mechanics/kept_list.h"
#include "scene/scene.h"

namespace palpate::mechanics {

class BodySinking;

// The nodal forces and gaps of a contact with the coupling `resolved`.
struct NodalContact {
  std::vector<Vec3> push;      // per newton of the contact's force: one per vertex of its `load`
  double peak_pressure = 0.0;  // Pa, largest nodal pressure, docs/theory.md [nodal_pressure]
  std::vector<int> vertices;   // of the surface near the sphere, ascending
  std::vector<double> gap;     // m, between these vertices and the sphere

  void renew();  // clears all, but keeps the memory of the lists
};

// The contact of one sphere at one place of the surface.
struct SphereContact {
  int sphere = 0;
  contact::Patch patch;
  contact::ContactLaw law;
  double approach = 0.0;        // m, A of theory.md [one_contact]: the sphere below the surface
  double depth = 0.0;           // m, h of eq. (2)
  double force = 0.0;           // N, along the patch's normal
  double elastic = 0.0;         // N, the part of `force` that the law gives for relaxed tissue
  double radiated = 0.0;        // N, the part of `force` for waves that the mesh cannot resolve
  double deep = 1.0;            // the factor [deep] of a deep press, in the law's `part` too
  double compliance = 0.0;      // m/N, C_ii of docs/theory.md [contacts]
  double sinking_error = 0.0;   // m/N, e of docs/theory.md [sinking]
  double sinking_doubt = 0.0;   // m/N, BeyondHalfSpace::doubt
  double stiffness = 0.0;       // N/m, derivative of `force` with respect to `depth`; where inertia
                                // reaches the force, to the finger's position, within a step
  Vec3 drag = Vec3::Zero();     // N, tangential, on the tissue
  Vec3 stretch = Vec3::Zero();  // m, of the finger relative to the tissue since the last slip
  contact::Spread load;         // of the pressure
  contact::Spread wide;         // over the wide patch [inertia], which loads the mesh; or empty
  NodalContact nodal;           // with `resolved`; otherwise empty
  bool on_crease = false;
  bool one_sided = false;  // its curvature has StarStatus::one_sided

  // m/N: the tangential displacement beyond the half-space's is this tensor times the drag.
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero();

  void renew();  // resets all members, but keeps the memory of the lists
};

// The pressure in the middle of the contact, Pa: for Hertz 3/2 of the mean, for a layer from its
// law [layer_pressure], with `resolved` the largest nodal pressure.
[[nodiscard]] double peak_pressure(const SphereContact& contact);

// The mesh's own error in the contact's force, a fraction of it; 0 where the law alone gives it.
//                                                                   docs/theory.md [sinking]
[[nodiscard]] double mesh_error(const SphereContact& contact);

// Position of the finger and the state of its contacts at one moment.
struct Touch {
  Vec3 finger = Vec3::Zero();  // m, the finger's reference point
  double travel = 0.0;         // m, below the first touch
  double slide = 0.0;          // m, sideways
  KeptList<SphereContact> contacts;

  [[nodiscard]] const SphereContact* deepest() const;  // null without contacts
  [[nodiscard]] double normal_force() const;           // N, upwards on the finger, without friction
  [[nodiscard]] double force() const;                  // N, upwards on the finger, with friction
  [[nodiscard]] Vec3 drag() const;       // N, sum of the tangential forces on the tissue
  [[nodiscard]] double pressed() const;  // N, sum of the magnitudes of the normal forces
};

// Friction of all contacts after the finger has moved by `move` (m). The stretch grows by the
// tangential part of `move`, and Cattaneo and Mindlin's partial slip gives the drag, at most mu F;
// with `contact.slip = "coulomb"` the drag is mu F along `move`. `beyond` renews the contacts'
// `shear`; without it they keep it.                                      docs/theory.md [stick]
void rub(const scene::Scene& scene, const Vec3& move, Touch& touch, BodySinking* beyond = nullptr);

// Why Hertz's law does not apply to tissue of the curvature `kappa_2` (1/m).
[[nodiscard]] std::string hollow_text(double kappa_2);

}  // namespace palpate::mechanics
