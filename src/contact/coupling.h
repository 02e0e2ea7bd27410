// How a Hertz contact sits on a mesh: which part of the mesh's sinking the contact law must know.
#pragma once

namespace palpate::contact {

// h is the penetration of eq. (2), travel how far the finger has come below the tissue at rest.
// one_way: h = travel. series: h = travel - u, u the pressure-weighted sinking of the mesh under
// the contact. consistent: h = travel - v, v the sinking that Hertz's half-space does not know,
// read in the ring of surface around the contact, and where inertia reaches the force by how much
// the mesh is from its statics. resolved: without eq. (2), nodes of a fine mesh that the finger can
// press and not pull.                                     docs/theory.md (9)-(14), (70)-(76)
enum class Coupling { one_way, series, consistent, resolved };

}  // namespace palpate::contact
