// Loops over nodes, and what all loops of four numbers share. Included inside the namespace of such
// loops, once per instruction set; without `#pragma once`. Defines PALPATE_INLINE.
#if !defined(PALPATE_TARGET)
#error "fast_loops.h and edge_loops.h include this"
#endif

using Wide = Four;
#include "base/index.h"
#include "base/wide_loads.h"

PALPATE_INLINE Four all(double value) { return Four{value, value, value, value}; }

// For each argument the sum of its first three lanes: x + (y + z) is the order of Vec3::dot.
PALPATE_INLINE Four sums(const Four& a, const Four& b, const Four& c, const Four& d) {
  const Four xz_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Four y_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four xz_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Four y_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  const Four x = __builtin_shufflevector(xz_ab, xz_cd, 0, 1, 4, 5);
  const Four y = __builtin_shufflevector(y_ab, y_cd, 0, 1, 4, 5);
  const Four z = __builtin_shufflevector(xz_ab, xz_cd, 2, 3, 6, 7);
  return x + (y + z);
}

// Copies displacements (three numbers per node) to the nodes and clears their forces. The fourth
// lane takes the next node's x; what it leads to ends in the unused fourth lane of the forces.
PALPATE_TARGET inline void place(const double* from, FastNode* nodes, std::size_t count) {
  for (std::size_t i = 0; i + 1 < count; ++i) {
    store(nodes[i].displacement, load(from + 3 * i));
    store(nodes[i].force, all(0.0));
  }
  FastNode& last = nodes[count - 1];
  for (std::size_t axis = 0; axis < 3; ++axis)
    last.displacement[axis] = from[3 * (count - 1) + axis];
  store(last.force, all(0.0));
}

// Copies the forces back; the next node's store overwrites the fourth number of each store.
PALPATE_TARGET inline void collect(const FastNode* nodes, double* to, std::size_t count) {
  for (std::size_t i = 0; i + 1 < count; ++i) store(to + 3 * i, load(nodes[i].force));
  for (std::size_t axis = 0; axis < 3; ++axis)
    to[3 * (count - 1) + axis] = nodes[count - 1].force[axis];
}
