// The loops of springs.cpp and viscous.cpp over four springs at a time. One .cpp includes this file
// once per instruction set and defines the namespace (PALPATE_LOOPS), the target attribute
// (PALPATE_TARGET) and a square root of four numbers (PALPATE_ROOT). Fused multiply-add is never
// used, so that all give the same bits. No `#pragma once`, because the file is included twice.
#if !defined(PALPATE_LOOPS) || !defined(PALPATE_TARGET) || !defined(PALPATE_ROOT)
#error "fast_springs.cpp includes this"
#endif

namespace palpate::tissue::PALPATE_LOOPS {

// Each lane computes as the plain loop does.

#include "tissue/node_loops.h"

PALPATE_INLINE double sum_of(const Four& lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

PALPATE_INLINE Four root(const Four& x) { return PALPATE_ROOT(x); }

PALPATE_INLINE Four displacement(const FastNode& node) { return load(node.displacement); }

// Elongations and directions of four springs at the present displacement.
struct Stretch {
  Four elongation;  // m
  Four per_pull;    // the pull is tension times per_pull times along; not set for linear springs
  Four along[4];    // of each spring, lanes x, y, z and an unused one
};

template <Kinematics kinematics>
PALPATE_INLINE Stretch stretch(const FastSpringData& data, const FastNode* nodes,
                               std::size_t first) {
  Stretch now;
  Four product[4];
#pragma GCC unroll 4
  for (std::size_t j = 0; j < 4; ++j) {
    const std::size_t s = first + j;
    const Four change =
        displacement(nodes[data.ends[2 * s + 1]]) - displacement(nodes[data.ends[2 * s]]);
    const Four along = load(&data.along[3 * s]);
    if constexpr (kinematics == Kinematics::linear) {
      product[j] = along * change;
      now.along[j] = along;
    } else {
      product[j] = change * ((along + along) + change);
      now.along[j] = along + change;
    }
  }
  const Four scalar = sums(product[0], product[1], product[2], product[3]);
  if constexpr (kinematics == Kinematics::linear) {
    now.elongation = scalar;
  } else {
    const Four rest = load(&data.rest_length[first]);
    if constexpr (kinematics == Kinematics::nonlinear) {
      const Four length = root(rest * rest + scalar);
      const Four inverse = 1.0 / ((length + rest) * length);
      now.elongation = scalar * (length * inverse);
      now.per_pull = (length + rest) * inverse;
    } else {
      now.per_pull = 1.0 / rest;
      now.elongation = (0.5 * scalar) * now.per_pull;
    }
  }
  return now;
}

PALPATE_INLINE void pull(const FastSpringData& data, FastNode* nodes, std::size_t first,
                         const Four& scale, const Four* along) {
  // Forces are added to both nodes in memory, spring by spring, so that a node sums them in the
  // order of the plain loop. Keeping a node in a register would cost a branch that is mispredicted.
#pragma GCC unroll 4
  for (std::size_t j = 0; j < 4; ++j) {
    const std::size_t s = first + j;
    const Four force = all(scale[j]) * along[j];
    double* const a = nodes[data.ends[2 * s]].force;
    store(a, load(a) - force);
    double* const b = nodes[data.ends[2 * s + 1]].force;
    store(b, load(b) + force);
  }
}

// Sums over groups of four springs, one lane each, J: twice the stored energy, and the lost one.
struct Energy {
  Four stored = {};
  Four lost = {};
};

// One number of the memory of each of four springs; the springs' memories are `size` numbers apart.
PALPATE_INLINE Four column(const double* from, std::size_t size) {
  return Four{from[0], from[size], from[2 * size], from[3 * size]};
}

PALPATE_INLINE void put_column(double* to, std::size_t size, const Four& values) {
  for (int j = 0; j < 4; ++j) to[as_index(j) * size] = values[j];
}

// Advances the memory by a step (or only reads it) and returns the effective elongations.
template <Viscosity viscosity, Passage passage>
PALPATE_INLINE Four remember(const FastSpringData& data, const Four& stiffness,
                             const Four& elongation, double* memory, Energy& energy) {
  const Four e = elongation;
  if constexpr (passage == Passage::look && viscosity != Viscosity::prony) return e;
  if constexpr (viscosity == Viscosity::none) {
    const Four tension = stiffness * e;
    energy.stored += tension * e;
    return e;
  }
  if constexpr (viscosity == Viscosity::kelvin_voigt) {
    const Four low = load(memory);
    const Four high = load(memory + 4);
    const Four before = __builtin_shufflevector(low, high, 0, 2, 4, 6);
    const Four effective = __builtin_shufflevector(low, high, 1, 3, 5, 7);
    const MemoryStep& step = data.steps[0];
    Four next = e;
    if (step.end != 0.0) next = (e - (step.keep * before + step.begin * effective)) / step.end;
    store(memory, __builtin_shufflevector(e, next, 0, 4, 1, 5));
    store(memory + 4, __builtin_shufflevector(e, next, 2, 6, 3, 7));
    energy.stored += (stiffness * e) * e;
    energy.lost += (stiffness * (e - before)) * (e - before);
    return e;
  }
  // One or more branches: `size` numbers per spring.
  const std::size_t size = data.memory_size;
  Four sum = e;
  Four stored = (stiffness * e) * e;
  const Four before = column(memory, size);
  for (std::size_t i = 0; i + 1 < size; ++i) {
    const double ratio = data.ratios[i];
    const Four inner = column(memory + 1 + i, size);
    Four next = inner;
    if constexpr (passage == Passage::remember) {
      const MemoryStep& step = data.steps[i];
      next = (step.keep * inner + step.begin * before) + step.end * e;
      put_column(memory + 1 + i, size, next);
      const Four mean = 0.5 * ((before - inner) + (e - next));
      energy.lost += ratio * ((stiffness * mean) * (next - inner));
      stored += ratio * ((stiffness * (e - next)) * (e - next));
    }
    sum += ratio * (e - next);
  }
  if constexpr (passage == Passage::remember) {
    put_column(memory, size, e);
    energy.stored += stored;
  }
  return sum;
}

// Computes elongations, memory, tensions and pulls of the springs `first` to `first + 3`.
template <Kinematics kinematics, Viscosity viscosity, Passage passage>
PALPATE_INLINE void four_springs(const FastSpringData& data, FastNode* nodes, std::size_t first,
                                 double* memory, Energy& energy) {
  const Stretch now = stretch<kinematics>(data, nodes, first);
  const Four stiffness = load(&data.stiffness[first]);
  const Four effective =
      remember<viscosity, passage>(data, stiffness, now.elongation, memory, energy);
  if (data.coupled) {
    store(&data.elongation[first], now.elongation);
    store(&data.effective[first], effective);
    return;
  }
  Four scale = stiffness * effective;
  if constexpr (kinematics != Kinematics::linear) scale *= now.per_pull;
  pull(data, nodes, first, scale, now.along);
}

template <Kinematics kinematics, Viscosity viscosity, Passage passage>
PALPATE_TARGET void springs(const FastSpringData& data, FastNode* nodes, double* memory,
                            double* energies) {
  Energy energy;
  const std::size_t size = data.memory_size;
  std::size_t s = 0;
  for (; s + 4 <= data.springs; s += 4)
    four_springs<kinematics, viscosity, passage>(data, nodes, s, memory + size * s, energy);
  if (s < data.springs) {
    // The last one to three springs, in a group filled up with springs that have no stiffness.
    double* const few = data.few;
    const std::size_t numbers = size * (data.springs - s);
    if (passage == Passage::remember || viscosity == Viscosity::prony)
      for (std::size_t i = 0; i < numbers; ++i) few[i] = memory[size * s + i];
    four_springs<kinematics, viscosity, passage>(data, nodes, s, few, energy);
    if (passage == Passage::remember)
      for (std::size_t i = 0; i < numbers; ++i) memory[size * s + i] = few[i];
  }
  energies[0] = 0.5 * sum_of(energy.stored);
  energies[1] = sum_of(energy.lost);
}

// The directions of the springs in the last pass, three numbers per spring. A store writes four
// numbers; the store of the next spring overwrites the fourth.
template <Kinematics kinematics>
PALPATE_TARGET void turn(const FastSpringData& data, const FastNode* nodes, double* direction) {
  for (std::size_t s = 0; s < data.springs; s += 4) {
    const Stretch now = stretch<kinematics>(data, nodes, s);
#pragma GCC unroll 4
    for (int j = 0; j < 4; ++j)
      store(direction + 3 * (s + as_index(j)), all(now.per_pull[j]) * now.along[j]);
  }
}

// Adds to the nodes the pulls of the tensions of coupled springs.
template <Kinematics kinematics>
PALPATE_TARGET void pulls(const FastSpringData& data, FastNode* nodes) {
  for (std::size_t s = 0; s < data.springs; s += 4) {
    const Four tension = load(&data.tension[s]);
    if constexpr (kinematics == Kinematics::linear) {
      const Four along[4] = {load(&data.along[3 * s]), load(&data.along[3 * s + 3]),
                             load(&data.along[3 * s + 6]), load(&data.along[3 * s + 9])};
      pull(data, nodes, s, tension, along);
    } else {
      const Stretch now = stretch<kinematics>(data, nodes, s);
      pull(data, nodes, s, tension * now.per_pull, now.along);
    }
  }
}

// Tensions of the effective elongations: the contributions of single springs, then of tetrahedra,
// then of shared volumes, each in index order.
PALPATE_TARGET inline void tensions(const FastSpringData& data) {
  for (std::size_t s = 0; s < data.springs; s += 4)
    store(&data.tension[s], load(&data.stiffness[s]) * load(&data.effective[s]));
  for (std::size_t group = 0; group < data.tetrahedra; group += 4) {
    const std::int32_t* const spring = &data.six_springs[6 * group];
    const double* const stiffness = &data.six_stiffness[21 * group];
    Four e[6];
#pragma GCC unroll 6
    for (int i = 0; i < 6; ++i)
      e[i] = Four{data.effective[spring[4 * i]], data.effective[spring[4 * i + 1]],
                  data.effective[spring[4 * i + 2]], data.effective[spring[4 * i + 3]]};
    double sum[24];
#pragma GCC unroll 6
    for (int i = 0; i < 6; ++i) {
      Four row = all(0.0);
#pragma GCC unroll 6
      for (int j = 0; j < 6; ++j) {
        const int entry = i > j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
        row += load(&stiffness[4 * entry]) * e[j];
      }
      store(&sum[4 * i], row);
    }
#pragma GCC unroll 4
    for (int lane = 0; lane < 4; ++lane)
#pragma GCC unroll 6
      for (int i = 0; i < 6; ++i) data.tension[spring[4 * i + lane]] += sum[4 * i + lane];
  }
  for (std::size_t v = 0; v < data.volumes; ++v) {
    const std::int32_t begin = data.volume_start[v];
    const std::int32_t end = data.volume_start[v + 1];
    double dilation = 0.0;
    for (std::int32_t k = begin; k < end; ++k)
      dilation += data.dilation[k] * data.effective[data.volume_springs[k]];
    const double pressure = data.volume_stiffness[v] * dilation;
    for (std::int32_t k = begin; k < end; ++k)
      data.tension[data.volume_springs[k]] += pressure * data.dilation[k];
  }
}

// Energies of coupled springs without branches: 1/2 sum T e, and sum (T - T0) (e - e0).
PALPATE_TARGET inline void coupled_energies(const FastSpringData& data,
                                            const double* tension_before,
                                            const double* elongation_before, double* energies) {
  Energy energy;
  for (std::size_t s = 0; s < data.springs; s += 4) {
    const Four tension = load(&data.tension[s]);
    const Four e = load(&data.elongation[s]);
    energy.stored += tension * e;
    energy.lost += (tension - load(&tension_before[s])) * (e - load(&elongation_before[s]));
  }
  energies[0] = 0.5 * sum_of(energy.stored);
  energies[1] = sum_of(energy.lost);
}

template <Kinematics kinematics, Viscosity viscosity>
Springs for_passage(Passage passage) {
  return passage == Passage::look ? &springs<kinematics, viscosity, Passage::look>
                                  : &springs<kinematics, viscosity, Passage::remember>;
}

template <Kinematics kinematics>
Springs for_law(Viscosity viscosity, Passage passage) {
  switch (viscosity) {
    case Viscosity::none:
    case Viscosity::nodal_drag: return for_passage<kinematics, Viscosity::none>(passage);
    case Viscosity::kelvin_voigt: return for_passage<kinematics, Viscosity::kelvin_voigt>(passage);
    case Viscosity::standard_linear_solid:
    case Viscosity::prony: break;
  }
  return for_passage<kinematics, Viscosity::prony>(passage);
}

inline Pulls choose_pulls(Kinematics kinematics) {
  if (kinematics == Kinematics::linear) return &pulls<Kinematics::linear>;
  if (kinematics == Kinematics::nonlinear) return &pulls<Kinematics::nonlinear>;
  return &pulls<Kinematics::squared>;
}

inline Turn choose_turn(Kinematics kinematics) {
  return kinematics == Kinematics::nonlinear ? &turn<Kinematics::nonlinear>
                                             : &turn<Kinematics::squared>;
}

inline Springs choose(Kinematics kinematics, Viscosity viscosity, Passage passage) {
  if (kinematics == Kinematics::linear) return for_law<Kinematics::linear>(viscosity, passage);
  if (kinematics == Kinematics::nonlinear)
    return for_law<Kinematics::nonlinear>(viscosity, passage);
  return for_law<Kinematics::squared>(viscosity, passage);
}

}  // namespace palpate::tissue::PALPATE_LOOPS
#undef PALPATE_INLINE
