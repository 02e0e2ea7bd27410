// The picture of a contact whose forces stand node by node.
#pragma once

#include "record/pressure_map.h"
#include "run/contacts.h"

namespace palpate::run {

// How far from the force's centre such a contact's pressure reaches, m; 0 for other contacts.
[[nodiscard]] double nodal_reach(const scene::Scene& scene, const SphereContact& contact);

// Fills in a map whose frame (size, pitch, origin) is set. Every node's force is spread over its
// third of the triangles around it, seen from above, linearly between the nodes: the pressure
// integrates to Touch::normal_force(). The gap is linear between the nodes likewise.
void draw_nodes(const scene::Scene& scene, const Touch& touch, record::PressureMap& map);

}  // namespace palpate::run
