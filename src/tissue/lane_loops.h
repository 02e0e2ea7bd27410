// The loops of LaneSprings over PALPATE_WIDTH of the eight lanes at a time. One .cpp includes this
// file once per instruction set, like fast_loops.h, without fused multiply-add. No `#pragma once`.
#if !defined(PALPATE_LOOPS) || !defined(PALPATE_TARGET) || !defined(PALPATE_WIDTH)
#error "lane_springs.cpp includes this"
#endif

namespace palpate::tissue::PALPATE_LOOPS {

// Each lane computes as fast_loops.h does: x + (y + z) is the order of summation of Vec3::dot.

using Piece = double __attribute__((vector_size(8 * PALPATE_WIDTH)));
constexpr std::size_t piece_width = PALPATE_WIDTH;

using Wide = Piece;
#include "base/index.h"
#include "base/wide_loads.h"

struct Three {
  Piece x, y, z;
};

PALPATE_INLINE Three load_three(const double* from) {
  return {load(from), load(from + 8), load(from + 16)};
}

PALPATE_INLINE void store_three(double* to, const Three& values) {
  store(to, values.x);
  store(to + 8, values.y);
  store(to + 16, values.z);
}

PALPATE_INLINE Three minus(const Three& a, const Three& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

PALPATE_INLINE Three plus(const Three& a, const Three& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

// Adds to one of four sums, separately for each lane.
PALPATE_INLINE void add(double* sums, std::size_t which, std::size_t lane, const Piece& value) {
  double* const sum = sums + 8 * (which % 4) + lane;
  store(sum, load(sum) + value);
}

PALPATE_INLINE void add_four(const double* sums, double factor, double* to) {
  for (std::size_t lane = 0; lane < 8; ++lane)
    to[lane] = factor * ((sums[lane] + sums[8 + lane]) + (sums[16 + lane] + sums[24 + lane]));
}

// Elongation of a spring, m, with linear kinematics.
PALPATE_INLINE Piece elongation(const double* along, const Three& change) {
  return along[0] * change.x + (along[1] * change.y + along[2] * change.z);
}

// Advances the memory by a step and returns the effective elongation.
template <bool branches>
PALPATE_INLINE Piece remember(const LaneData& data, std::size_t s, std::size_t lane,
                              const Piece& stiffness, const Piece& e, double* stored_sums,
                              double* lost_sums) {
  Piece stored = (stiffness * e) * e;
  if constexpr (!branches) {
    add(stored_sums, s, lane, stored);
    return e;
  }
  double* const memory = data.memory + 8 * (1 + data.branches) * s + lane;
  const Piece before = load(memory);
  Piece sum = e;
  for (std::size_t i = 0; i < data.branches; ++i) {
    const std::size_t at = 8 * i + lane;
    const Piece ratio = load(data.ratio + at);
    const Piece inner = load(memory + 8 * (1 + i));
    const Piece next =
        (load(data.keep + at) * inner + load(data.begin + at) * before) + load(data.end + at) * e;
    store(memory + 8 * (1 + i), next);
    const Piece mean = 0.5 * ((before - inner) + (e - next));
    add(lost_sums, s, lane, ratio * ((stiffness * mean) * (next - inner)));
    stored += ratio * ((stiffness * (e - next)) * (e - next));
    sum += ratio * (e - next);
  }
  store(memory, e);
  add(stored_sums, s, lane, stored);
  return sum;
}

// Node by node, so that a node's force stays in a register while it is summed: first the springs
// that end at the node, whose tensions earlier nodes have computed, then those that begin there.
// Each node thus sums in the order of the springs.
template <bool branches>
PALPATE_TARGET void springs(const LaneData& data) {
  double stored[32] = {};
  double lost[32] = {};
  for (std::size_t n = 0; n < data.nodes; ++n)
    for (std::size_t lane = 0; lane < 8; lane += piece_width) {
      const Three u = load_three(data.displacement + 24 * n + lane);
      Three force{};
      for (std::int32_t q = data.ending_start[n]; q < data.ending_start[n + 1]; ++q) {
        const auto s = as_index(data.ending[q]);
        const double* const along = data.along + 3 * s;
        const Piece tension = load(data.tension + 8 * s + lane);
        force = {force.x + tension * along[0], force.y + tension * along[1],
                 force.z + tension * along[2]};
      }
      const auto last = as_index(data.beginning[n + 1]);
      for (auto s = as_index(data.beginning[n]); s < last; ++s) {
        const double* const along = data.along + 3 * s;
        const Three change =
            minus(load_three(data.displacement + 24 * as_index(data.second[s]) + lane), u);
        const Piece stiffness = load(data.stiffness + 8 * s + lane);
        const Piece tension =
            stiffness *
            remember<branches>(data, s, lane, stiffness, elongation(along, change), stored, lost);
        store(data.tension + 8 * s + lane, tension);
        force = minus(force, {tension * along[0], tension * along[1], tension * along[2]});
      }
      store_three(data.force + 24 * n + lane, force);
    }
  add_four(stored, 0.5, data.stored);
  add_four(lost, 1.0, data.lost);
}

// The place of three pieces of a node or slot, the one that `pairs` names at `which`.
PALPATE_INLINE std::size_t place_of(const std::int32_t* pairs, std::size_t which,
                                    std::size_t lane) {
  return 24 * as_index(pairs[which]) + lane;
}

PALPATE_INLINE void add_three(double* to, const Three& values) {
  store_three(to, plus(load_three(to), values));
}

PALPATE_INLINE Three moved(const LaneData& data, std::size_t edge, std::size_t lane) {
  return minus(load_three(data.displacement + place_of(data.edge_ends, 2 * edge + 1, lane)),
               load_three(data.displacement + place_of(data.edge_ends, 2 * edge, lane)));
}

// Where an edge changes volumes, and how.
struct Changes {
  const std::int32_t* slots;  // two
  const double* first;
  const double* second;
};
PALPATE_INLINE Changes changes_of(const LaneData& data, std::size_t edge) {
  if (edge < data.inner) {
    const double* const change = data.change + 3 * edge;
    return {data.edge_ends + 2 * edge, change, change};
  }
  const std::size_t outer = edge - data.inner;
  const double* const change = data.change + 3 * data.inner + 6 * outer;
  return {data.edge_slots + 2 * outer, change, change + 3};
}

inline PALPATE_TARGET void pressures(const LaneData& data) {
  for (std::size_t e = 0; e < data.edges; ++e)
    for (std::size_t lane = 0; lane < 8; lane += piece_width) {
      const auto [slots, c, d] = changes_of(data, e);
      const Three w = moved(data, e, lane);
      add_three(data.force + place_of(slots, 0, lane), {c[0] * w.x, c[1] * w.y, c[2] * w.z});
      add_three(data.force + place_of(slots, 1, lane), {d[0] * w.x, d[1] * w.y, d[2] * w.z});
    }
  for (std::size_t n = 0; n < data.slots; ++n)
    for (std::size_t lane = 0; lane < 8; lane += piece_width) {
      double* const sums = data.force + 24 * n + lane;
      const Three theta = load_three(sums);
      store(data.pressure + 8 * n + lane,
            load(data.weight + 8 * n + lane) * (theta.x + (theta.y + theta.z)));
      store_three(sums, Three{});
    }
}

// Coupled springs without branches, edge by edge in the order of edge_loops.h.
inline PALPATE_TARGET void edges(const LaneData& data) {
  const std::size_t sums = data.slots > 0 ? data.slots : data.nodes;
  for (std::size_t i = 0; i < 24 * sums; i += piece_width) store(data.force + i, Piece{});
  if (data.slots > 0) pressures(data);
  for (std::size_t e = 0; e < data.edges; ++e)
    for (std::size_t lane = 0; lane < 8; lane += piece_width) {
      const Three w = moved(data, e, lane);
      Piece s[6];
#pragma GCC unroll 6
      for (int entry = 0; entry < 6; ++entry)
        s[entry] = load(data.block + 8 * (6 * e + as_index(entry)) + lane);
      Three pull = {s[0] * w.x + (s[1] * w.y + s[2] * w.z), s[1] * w.x + (s[4] * w.y + s[3] * w.z),
                    s[2] * w.x + (s[3] * w.y + s[5] * w.z)};
      const bool inner = e < data.inner;
      if (data.slots > 0) {
        const auto [slots, c, d] = changes_of(data, e);
        const Piece p = load(data.pressure + 8 * as_index(slots[0]) + lane);
        const Piece q = load(data.pressure + 8 * as_index(slots[1]) + lane);
        const Piece both = p + q;
        if (inner)
          pull = plus(pull, {both * c[0], both * c[1], both * c[2]});
        else
          pull = plus(pull, {p * c[0] + q * d[0], p * c[1] + q * d[1], p * c[2] + q * d[2]});
      }
      double* const a = data.force + place_of(data.edge_ends, 2 * e, lane);
      double* const b = data.force + place_of(data.edge_ends, 2 * e + 1, lane);
      if (inner) {
        store_three(a, minus(load_three(a), pull));
        add_three(b, pull);
        continue;
      }
      const Three t = load_three(data.turn + 24 * (e - data.inner) + lane);
      const Three turn = {t.y * w.z - t.z * w.y, t.z * w.x - t.x * w.z, t.x * w.y - t.y * w.x};
      store_three(a, minus(load_three(a), plus(pull, turn)));
      add_three(b, minus(pull, turn));
    }
  for (std::size_t lane = 0; lane < 8; lane += piece_width) {
    Three work{};
    for (std::size_t n = 0; n < data.nodes; ++n) {
      const Three u = load_three(data.displacement + 24 * n + lane);
      const Three f = load_three(data.force + 24 * n + lane);
      work = plus(work, {u.x * f.x, u.y * f.y, u.z * f.z});
    }
    store(data.stored + lane, 0.5 * (work.x + (work.y + work.z)));
    store(data.lost + lane, Piece{});
  }
}

// advance() and the sums of fast_vectors.h in one pass.
template <bool drag>
PALPATE_TARGET void advance(const LaneData& data) {
  double kinetic[32] = {};
  double work[32] = {};
  double moved_squares[32] = {};
  for (std::size_t n = 0; n < data.nodes; ++n)
    for (std::size_t lane = 0; lane < 8; lane += piece_width) {
      const Piece mass = load(data.mass + 8 * n + lane);
      const Piece square = load(data.square + lane);
      const Piece rate = load(data.rate + lane);
      Piece keep = 2.0 * mass;
      Piece drag_here{};
      if constexpr (drag) {
        drag_here = load(data.drag + lane) * mass;
        keep -= load(data.drag_step + lane) * drag_here;
      }
#pragma GCC unroll 3
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t d = 3 * n + axis;
        const std::size_t at = 8 * d + lane;
        Piece external{};
        if (data.loaded[n] != 0) external = load(data.load_before + at);
        const Piece w = load(data.inverse + at) * (square * (external - load(data.force + at)) +
                                                   keep * load(data.moved + at));
        const Piece before = load(data.displacement + at);
        const Piece after = before + w;
        store(data.moved + at, w);
        store(data.displacement + at, after);
        const Piece v = rate * w;
        add(kinetic, d, lane, 0.5 * mass * v * v);
        const Piece moved = after - before;
        if constexpr (drag) add(moved_squares, d, lane, drag_here * moved * moved);
        if (data.loaded[n] != 0) {
          const Piece end = load(data.load_after + at);
          const Piece start = load(data.jumped + lane) != Piece{} ? end : external;
          add(work, d, lane, 0.5 * (start + end) * moved);
        }
      }
    }
  add_four(kinetic, 1.0, data.kinetic);
  add_four(work, 1.0, data.work);
  add_four(moved_squares, 1.0, data.moved_squares);
}

inline LanePasses choose(const LaneData& data, Viscosity viscosity) {
  LanePasses passes;
  passes.advance = viscosity == Viscosity::nodal_drag ? &advance<true> : &advance<false>;
  if (data.coupled)
    passes.springs = &edges;
  else
    passes.springs = data.branches > 0 ? &springs<true> : &springs<false>;
  return passes;
}

}  // namespace palpate::tissue::PALPATE_LOOPS
#undef PALPATE_INLINE
