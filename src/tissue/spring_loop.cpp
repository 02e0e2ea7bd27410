// Spans and pulls with x, y and z in one vector, lengths with several springs in one vector.
#include "tissue/spring_loop.h"

#include <algorithm>
#include <cmath>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "base/wide.h"

namespace palpate::tissue {
namespace {

using Springs = SpringLoop::Springs;
using Node = SpringLoop::Node;

PALPATE_ALWAYS Four root(const Four& x) {
#if defined(__x86_64__)
  const __m128d low = _mm_sqrt_pd(__builtin_shufflevector(x, x, 0, 1));
  const __m128d high = _mm_sqrt_pd(__builtin_shufflevector(x, x, 2, 3));
  return __builtin_shufflevector(low, high, 0, 1, 2, 3);
#else
  return Four{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
#endif
}

// Four springs at the present displacement.
struct Stretched {
  Four span[4];     // m, of each: x, y, z and an unused number
  Four elongation;  // m
  Four per_length;  // 1/m: direction = per_length * span
};

PALPATE_ALWAYS Stretched stretch(const Springs springs, const Node* nodes, std::size_t first) {
  Stretched now;
  Four product[4];
#pragma GCC unroll 4
  for (std::size_t j = 0; j < 4; ++j) {
    const std::size_t s = first + j;
    const Four change = load(nodes[springs.ends[2 * s + 1]].displacement) -
                        load(nodes[springs.ends[2 * s]].displacement);
    const Four rest = load(springs.span + 3 * s);
    product[j] = change * ((rest + rest) + change);
    now.span[j] = rest + change;
  }
  // As in springs.cpp.                                           docs/theory.md [elongation]
  const Four squares = sums(product[0], product[1], product[2], product[3]);
  const Four rest = load(springs.rest_length + first);
  if (springs.squared) {
    now.per_length = 1.0 / rest;
    now.elongation = (0.5 * squares) * now.per_length;
    return now;
  }
  const Four length = root(rest * rest + squares);
  const Four inverse = 1.0 / ((length + rest) * length);
  now.elongation = squares * (length * inverse);
  now.per_length = (length + rest) * inverse;
  return now;
}

PALPATE_ALWAYS void pull_four(const Springs springs, Node* nodes, std::size_t first,
                              const Stretched& now, const Four& scale) {
#pragma GCC unroll 4
  for (std::size_t j = 0; j < 4; ++j) {
    const std::size_t s = first + j;
    const Four force = all(scale[j]) * now.span[j];
    double* const a = nodes[springs.ends[2 * s]].force;
    store(a, load(a) - force);
    double* const b = nodes[springs.ends[2 * s + 1]].force;
    store(b, load(b) + force);
  }
}

// The fourth number of a node is that of the next one's x and is never used.
PALPATE_WIDE void place_all(const double* from, Node* nodes, std::size_t count) {
  for (std::size_t n = 0; n + 1 < count; ++n) {
    store(nodes[n].displacement, load(from + 3 * n));
    store(nodes[n].force, Four{});
  }
  Node& last = nodes[count - 1];
  for (std::size_t i = 0; i < 3; ++i) last.displacement[i] = from[3 * (count - 1) + i];
  store(last.force, Four{});
}

PALPATE_WIDE void collect_all(const Node* nodes, double* to, std::size_t count) {
  for (std::size_t n = 0; n + 1 < count; ++n) store(to + 3 * n, load(nodes[n].force));
  for (std::size_t i = 0; i < 3; ++i) to[3 * (count - 1) + i] = nodes[count - 1].force[i];
}

PALPATE_WIDE double pass_elastic(const Springs springs, Node* nodes) {
  Four energy{};
  for (std::size_t first = 0; first < springs.count; first += 4) {
    const Stretched now = stretch(springs, nodes, first);
    const Four tension = load(springs.stiffness + first) * now.elongation;
    energy += tension * now.elongation;
    pull_four(springs, nodes, first, now, tension * now.per_length);
  }
  return 0.5 * ((energy[0] + energy[1]) + (energy[2] + energy[3]));
}

PALPATE_WIDE void pass_elongations(const Springs springs, const Node* nodes, double* elongation) {
  for (std::size_t first = 0; first < springs.count; first += 4)
    store(elongation + first, stretch(springs, nodes, first).elongation);
}

// The rates of elongation, from velocities that stand in place of the nodes' forces.
PALPATE_WIDE void pass_rates(const Springs springs, const Node* nodes, double* rate) {
  for (std::size_t first = 0; first < springs.count; first += 4) {
    const Stretched now = stretch(springs, nodes, first);
    Four product[4];
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j) {
      const std::size_t s = first + j;
      product[j] = now.span[j] * (load(nodes[springs.ends[2 * s + 1]].force) -
                                  load(nodes[springs.ends[2 * s]].force));
    }
    store(rate + first, now.per_length * sums(product[0], product[1], product[2], product[3]));
  }
}

PALPATE_WIDE void pass_pull(const Springs springs, Node* nodes, const double* tension) {
  for (std::size_t first = 0; first < springs.count; first += 4) {
    const Stretched now = stretch(springs, nodes, first);
    pull_four(springs, nodes, first, now, load(tension + first) * now.per_length);
  }
}

// Where a spring stands in the loop. Successive ones mostly have their first node in common, whose
// force each would wait for: the four of a chunk are sixteen apart.
constexpr std::size_t apart = 16;
constexpr std::size_t block = apart * SpringLoop::chunk;

std::size_t slot(std::size_t spring) {
  const std::size_t in_block = spring % block;
  return spring - in_block + SpringLoop::chunk * (in_block % apart) + in_block / apart;
}

}  // namespace

SpringLoop::SpringLoop(const Network& network, Kinematics kinematics) {
  const std::size_t count = network.ends.size();
  const std::size_t padded = (count + block - 1) / block * block;
  const auto nobody = static_cast<std::int32_t>(network.rest.size());
  nodes_.resize(network.rest.size() + 1);
  ends_.assign(2 * padded, nobody);
  span_.assign(3 * padded + 1, 0.0);  // loads take four numbers
  rest_length_.assign(padded, 1.0);
  stiffness_.assign(padded, 0.0);
  values_.assign(padded, 0.0);
  for (std::size_t s = 0; s < count; ++s) {
    const auto [a, b] = network.ends[s];
    const std::size_t at = slot(s);
    ends_[2 * at] = a;
    ends_[2 * at + 1] = b;
    const Vec3 rest = network.rest[as_index(b)] - network.rest[as_index(a)];
    std::ranges::copy(rest, &span_[3 * at]);
    rest_length_[at] = network.rest_length[s];
    stiffness_[at] = network.stiffness[s];
  }
  springs_ = {.squared = kinematics == Kinematics::squared,
              .count = padded,
              .ends = ends_.data(),
              .span = span_.data(),
              .rest_length = rest_length_.data(),
              .stiffness = stiffness_.data()};
}

// Copies displacements to the nodes and clears their forces.
void SpringLoop::place(const Vector& displacement) {
  place_all(displacement.data(), nodes_.data(), nodes_.size() - 1);
}

void SpringLoop::collect(Vector& force) const {
  force.resize(3 * static_cast<Eigen::Index>(nodes_.size() - 1));
  collect_all(nodes_.data(), force.data(), nodes_.size() - 1);
}

double SpringLoop::elastic(const Vector& displacement, Vector& force) {
  place(displacement);
  const double stored = pass_elastic(springs_, nodes_.data());
  collect(force);
  return stored;
}

void SpringLoop::elongations(const Vector& displacement, std::span<double> elongation) {
  place(displacement);
  pass_elongations(springs_, nodes_.data(), values_.data());
  for (std::size_t s = 0; s < elongation.size(); ++s) elongation[s] = values_[slot(s)];
}

void SpringLoop::rates(const Vector& displacement, const Vector& velocity, std::span<double> rate) {
  place(displacement);
  for (std::size_t n = 0; n + 1 < nodes_.size(); ++n)
    for (std::size_t i = 0; i < 3; ++i)
      nodes_[n].force[i] = velocity[static_cast<Eigen::Index>(3 * n + i)];
  pass_rates(springs_, nodes_.data(), values_.data());
  for (std::size_t s = 0; s < rate.size(); ++s) rate[s] = values_[slot(s)];
}

void SpringLoop::pull(const Vector& displacement, std::span<const double> tension, Vector& force) {
  place(displacement);
  for (std::size_t s = 0; s < tension.size(); ++s) values_[slot(s)] = tension[s];
  pass_pull(springs_, nodes_.data(), values_.data());
  collect(force);
}

}  // namespace palpate::tissue
