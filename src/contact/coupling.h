// How a contact is coupled to a mesh: which displacements of the mesh enter the contact law.
#pragma once

namespace palpate::contact {

// `h` is the depth in the contact law, `travel` the displacement of the finger below the undeformed
// surface (theory.md [depth], [unilateral], [inertia]). one_way: h = travel. series: h = travel -
// u, where u is the pressure-weighted displacement of the mesh under the contact. consistent: h =
// travel - v, where v is what the body sinks beyond the law's half-space, from the energy of the
// rest of the field; where inertia reaches the force, the deviation of the mesh from statics is
// subtracted too. resolved: no contact law; the finger presses nodes of
// a fine mesh without tension.
enum class Coupling { one_way, series, consistent, resolved };

// Whether the mesh represents the tissue at the contact, with its viscosity and inertia.
[[nodiscard]] constexpr bool mesh_is_tissue(Coupling coupling) {
  return coupling == Coupling::series || coupling == Coupling::resolved;
}

// Whether the contact force may act on a single node. This requires that the coupling averages the
// displacement of all nodes that it loads, or uses no displacement.
[[nodiscard]] constexpr bool presses_one_node(Coupling coupling) {
  return coupling == Coupling::one_way || coupling == Coupling::series;
}

}  // namespace palpate::contact
