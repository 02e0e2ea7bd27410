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

enum class Stage { all, tensions_known };

// Node by node, so that a node's force stays in a register while it is summed: first the springs
// that end at the node, whose tensions earlier nodes have computed, then those that begin there.
// Each node thus sums in the order of the springs.
template <bool branches, Stage stage>
PALPATE_TARGET void pull_nodes(const LaneData& data, double* stored_sums, double* lost_sums) {
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
        Piece tension;
        if constexpr (stage == Stage::all) {
          const Three change =
              minus(load_three(data.displacement + 24 * as_index(data.second[s]) + lane), u);
          const Piece stiffness = load(data.stiffness + 8 * s + lane);
          tension =
              stiffness * remember<branches>(data, s, lane, stiffness, elongation(along, change),
                                             stored_sums, lost_sums);
          store(data.tension + 8 * s + lane, tension);
        } else {
          tension = load(data.tension + 8 * s + lane);
        }
        force = minus(force, {tension * along[0], tension * along[1], tension * along[2]});
      }
      store_three(data.force + 24 * n + lane, force);
    }
}

template <bool branches>
PALPATE_TARGET void springs(const LaneData& data) {
  double stored[32] = {};
  double lost[32] = {};
  pull_nodes<branches, Stage::all>(data, stored, lost);
  add_four(stored, 0.5, data.stored);
  add_four(lost, 1.0, data.lost);
}

// Coupled springs without branches: elongations, then tensions in the order of `tensions` in
// fast_loops.h, then pulls.
inline PALPATE_TARGET void coupled_springs(const LaneData& data) {
  double stored[32] = {};
  double* const tension = data.tension;
  for (std::size_t s = 0; s < data.springs; ++s)
    for (std::size_t lane = 0; lane < 8; lane += piece_width) {
      const Three change =
          minus(load_three(data.displacement + 24 * as_index(data.second[s]) + lane),
                load_three(data.displacement + 24 * as_index(data.first[s]) + lane));
      const Piece e = elongation(data.along + 3 * s, change);
      store(data.elongation + 8 * s + lane, e);
      store(tension + 8 * s + lane, load(data.stiffness + 8 * s + lane) * e);
    }
  for (std::size_t t = 0; t < data.tetrahedra; ++t)
    for (std::size_t lane = 0; lane < 8; lane += piece_width) {
      const std::int32_t* const spring = data.six_springs + 6 * t;
      const double* const stiffness = data.six_stiffness + 8 * 21 * t + lane;
      Piece e[6];
#pragma GCC unroll 6
      for (int i = 0; i < 6; ++i) e[i] = load(data.elongation + 8 * as_index(spring[i]) + lane);
#pragma GCC unroll 6
      for (int i = 0; i < 6; ++i) {
        Piece row{};
#pragma GCC unroll 6
        for (int j = 0; j < 6; ++j) {
          const int entry = i > j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
          row += load(stiffness + 8 * entry) * e[j];
        }
        double* const sum = tension + 8 * as_index(spring[i]) + lane;
        store(sum, load(sum) + row);
      }
    }
  for (std::size_t v = 0; v < data.volumes; ++v)
    for (std::size_t lane = 0; lane < 8; lane += piece_width) {
      const std::int32_t begin = data.volume_start[v];
      const std::int32_t end = data.volume_start[v + 1];
      const auto at = [&](std::int32_t k) { return 8 * as_index(data.volume_springs[k]) + lane; };
      Piece dilation{};
      for (std::int32_t k = begin; k < end; ++k)
        dilation += data.dilation[k] * load(data.elongation + at(k));
      const Piece pressure = load(data.volume_stiffness + 8 * v + lane) * dilation;
      for (std::int32_t k = begin; k < end; ++k)
        store(tension + at(k), load(tension + at(k)) + pressure * data.dilation[k]);
    }
  for (std::size_t s = 0; s < data.springs; ++s)
    for (std::size_t lane = 0; lane < 8; lane += piece_width)
      add(stored, s, lane, load(tension + 8 * s + lane) * load(data.elongation + 8 * s + lane));
  pull_nodes<false, Stage::tensions_known>(data, nullptr, nullptr);
  add_four(stored, 0.5, data.stored);
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
    passes.springs = &coupled_springs;
  else
    passes.springs = data.branches > 0 ? &springs<true> : &springs<false>;
  return passes;
}

}  // namespace palpate::tissue::PALPATE_LOOPS
#undef PALPATE_INLINE
