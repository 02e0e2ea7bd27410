// Pressure maps of `resolved` contact, from its nodal forces.
#pragma once

#include "mechanics/contacts.h"
#include "record/pressure_map.h"

namespace palpate::run {

inline constexpr int samples = 8;  // along each side of a pixel, of every map

// The largest distance of a contact's pressure from its centre, m; 0 for other couplings.
[[nodiscard]] double nodal_reach(const scene::Scene& scene,
                                 const mechanics::SphereContact& contact);

// Fills a map whose size, pitch and origin are set. Nodal pressure is the force divided by a third
// of the area, seen from above, of the triangles around the node. Pressure, traction and gap are
// linear between nodes; the pressure integrates to Touch::normal_force().
void draw_nodes(const scene::Scene& scene, const mechanics::Touch& touch, record::PressureMap& map);

}  // namespace palpate::run
