// Hertz pressure spread over the nodes of a flat top: the load that a mesh feels.
#pragma once

#include <vector>

#include "base/vec3.h"
#include "geometry/flat_top.h"

namespace palpate::contact {

// Shares of a force on nodes: they sum to 1 and their centre is the contact's centre, because
// every quadrature point is shared by the linear shape functions of its triangle.
struct Spread {
  std::vector<int> nodes;      // mesh indices, ascending
  std::vector<double> shares;  // one a node, >= 0
};

// The Hertz pressure of contact radius `radius` (m) about (x, y) of `centre`, as shares on the
// top's nodes; all on the triangle under the centre for a radius of 0. Points beyond the top's
// edge are taken at the edge.
[[nodiscard]] Spread spread_over_flat(const geometry::FlatTop& top, const Vec3& centre,
                                      double radius);

}  // namespace palpate::contact
