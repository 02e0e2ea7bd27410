// The force of an EdgeForm, x, y and z of an edge in one vector. One .cpp includes this file once
// per instruction set, like fast_loops.h, without fused multiply-add. No `#pragma once`.
#if !defined(PALPATE_LOOPS) || !defined(PALPATE_TARGET)
#error "fast_edges.cpp includes this"
#endif

namespace palpate::tissue::PALPATE_LOOPS {

#include "tissue/node_loops.h"

PALPATE_INLINE void add(double* to, const Four& values) { store(to, load(to) + values); }
PALPATE_INLINE void subtract(double* from, const Four& values) { store(from, load(from) - values); }

struct Ends {
  std::size_t a, b;
};
PALPATE_INLINE Ends ends_of(const std::int32_t* pairs, std::size_t edge) {
  return {as_index(pairs[2 * edge]), as_index(pairs[2 * edge + 1])};
}

// w = u_b - u_a, m. Fourth lanes are never used.
PALPATE_INLINE Four moved(const FastNode* nodes, const Ends& ends) {
  return load(nodes[ends.b].displacement) - load(nodes[ends.a].displacement);
}

// S w
PALPATE_INLINE Four product(const double* block, const Four& w) {
  const Four first = load(block);
  const Four second = load(block + 1);
  const Four third = load(block + 2);
  return first * __builtin_shufflevector(w, w, 0, 0, 0, 0) +
         (__builtin_shufflevector(second, second, 0, 3, 2, 1) *
              __builtin_shufflevector(w, w, 1, 1, 1, 1) +
          __builtin_shufflevector(third, third, 0, 1, 3, 2) *
              __builtin_shufflevector(w, w, 2, 2, 2, 2));
}

PALPATE_INLINE Four cross(const Four& a, const Four& w) {
  return __builtin_shufflevector(a, a, 1, 2, 0, 3) * __builtin_shufflevector(w, w, 2, 0, 1, 3) -
         __builtin_shufflevector(a, a, 2, 0, 1, 3) * __builtin_shufflevector(w, w, 1, 2, 0, 3);
}

// The pressures of all slots, which take the place of the fourth component of the displacement.
PALPATE_TARGET inline void pressures(const FastEdgeData& data, FastNode* nodes) {
  for (std::size_t e = 0; e < data.inner; ++e) {
    const Ends ends = ends_of(data.ends, e);
    const Four change = load(data.change + 3 * e) * moved(nodes, ends);
    add(nodes[ends.a].force, change);
    add(nodes[ends.b].force, change);
  }
  for (std::size_t e = data.inner; e < data.edges; ++e) {
    const std::size_t outer = e - data.inner;
    const double* const change = data.change + 3 * data.inner + 6 * outer;
    const Four w = moved(nodes, ends_of(data.ends, e));
    const Ends slots = ends_of(data.slots, outer);
    add(nodes[slots.a].force, load(change) * w);
    add(nodes[slots.b].force, load(change + 3) * w);
  }
  for (std::size_t n = 0; n < data.slot_groups; n += 4) {
    FastNode* const four = nodes + n;
    const Four theta =
        sums(load(four[0].force), load(four[1].force), load(four[2].force), load(four[3].force));
    const Four pressure = load(data.weight + n) * theta;
#pragma GCC unroll 4
    for (int j = 0; j < 4; ++j) {
      four[j].displacement[3] = pressure[j];
      store(four[j].force, all(0.0));
    }
  }
}

template <bool volumes>
PALPATE_TARGET void edges(const FastEdgeData& data, FastNode* nodes) {
  if constexpr (volumes) pressures(data, nodes);
  for (std::size_t e = 0; e < data.inner; ++e) {
    const Ends ends = ends_of(data.ends, e);
    Four pull = product(data.block + 6 * e, moved(nodes, ends));
    if constexpr (volumes)
      pull += all(nodes[ends.a].displacement[3] + nodes[ends.b].displacement[3]) *
              load(data.change + 3 * e);
    subtract(nodes[ends.a].force, pull);
    add(nodes[ends.b].force, pull);
  }
  for (std::size_t e = data.inner; e < data.edges; ++e) {
    const std::size_t outer = e - data.inner;
    const Ends ends = ends_of(data.ends, e);
    const Four w = moved(nodes, ends);
    Four pull = product(data.block + 6 * e, w);
    if constexpr (volumes) {
      const double* const change = data.change + 3 * data.inner + 6 * outer;
      const Ends slots = ends_of(data.slots, outer);
      pull += all(nodes[slots.a].displacement[3]) * load(change) +
              all(nodes[slots.b].displacement[3]) * load(change + 3);
    }
    const Four turn = cross(load(data.turn + 3 * outer), w);
    subtract(nodes[ends.a].force, pull + turn);
    add(nodes[ends.b].force, pull - turn);
  }
}

// sum u . f
PALPATE_TARGET inline double work(const FastNode* nodes, std::size_t count) {
  Four sum = all(0.0);
  for (std::size_t n = 0; n < count; ++n) sum += load(nodes[n].displacement) * load(nodes[n].force);
  return sum[0] + (sum[1] + sum[2]);
}

inline EdgePasses choose(bool volumes) {
  return {&place, volumes ? &edges<true> : &edges<false>, &collect, &work};
}

}  // namespace palpate::tissue::PALPATE_LOOPS
#undef PALPATE_INLINE
