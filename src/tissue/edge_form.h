// The stiffness of a network at rest, edge by edge: of a linear body without memory it needs a
// third of the numbers that its coupled springs have.                           docs/theory.md
// (65), (66)
#pragma once

#include <cstdint>
#include <vector>

#include "tissue/network.h"

namespace palpate::tissue {

// An edge from node a to b with w = u_b - u_a adds  t - a x w  to the force at b and  -t - a x w to
// that at a, where
//   t = S w + p_a c_a + p_b c_b,   p = weight theta,   theta_a = sum c_a . w,  theta_b = sum c_b .
//   w
// over the edges around a node: S and the matrix of a x are the symmetric and the other part of
// minus the edge's 3 x 3 block of stiffness, and p is the pressure of a node's averaged volume. In
// the inside of one tissue a is zero and c_a = c_b: such edges come first.
//
// theta is the change of all tetrahedra around a node, m^3. A slot is an averaged volume. That of a
// node has the node's number; those of further tissues at it follow, and the last one, with weight
// 0, stands for none.
struct EdgeForm {
  std::size_t inner = 0;            // edges with one c and no a
  std::vector<std::int32_t> ends;   // 2 per edge
  std::vector<std::int32_t> slots;  // 2 per edge after the inner ones
  std::vector<double> block;        // N/m, 6 per edge: S_xx, S_xy, S_xz, S_yz, S_yy, S_zz
  std::vector<double> change;       // m^2, 3 per inner edge (c), then 6 (c_a, c_b)
  std::vector<double> turn;         // N/m, 3 per edge after the inner ones: a
  std::vector<double> weight;       // Pa/m^3, one per slot; empty if there are no averaged volumes

  [[nodiscard]] std::size_t edges() const { return ends.size() / 2; }
  // Whether the two differ in nothing but stiffness.
  [[nodiscard]] bool alike(const EdgeForm& other) const;
};

// Whether the network has this form: not if springs of an averaged volume are missing, as in the
// part of a body.
[[nodiscard]] bool has_edge_form(const Network& network);

[[nodiscard]] EdgeForm edge_form(const Network& network);

}  // namespace palpate::tissue
