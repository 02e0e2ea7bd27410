// Loops over springs as the formulas are written, one spring after the other, for comparison.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "tissue/network.h"

namespace palpate::test {

// The present span of a spring, for kinematics other than linear.    docs/theory.md [elongation]
struct Stretched {
  Vec3 span;          // m, from the first end to the second
  double elongation;  // m
  double per_length;  // 1/m: direction = per_length * span
};

// Inlined, because returning vectors through memory took five times as long.
[[gnu::always_inline]] inline Stretched stretched(const tissue::Network& network,
                                                  tissue::Kinematics kinematics,
                                                  const tissue::Vector& displacement,
                                                  std::size_t s) {
  const auto [a, b] = network.ends[s];
  const Vec3 change = displacement.segment<3>(3 * b) - displacement.segment<3>(3 * a);
  const Vec3 at_rest = network.rest[as_index(b)] - network.rest[as_index(a)];
  const double rest = network.rest_length[s];
  const double squares = change.dot(2.0 * at_rest + change);
  if (kinematics == tissue::Kinematics::squared) {
    const double inverse = 1.0 / rest;
    return {at_rest + change, 0.5 * squares * inverse, inverse};
  }
  const double length = std::sqrt(rest * rest + squares);
  const double inverse = 1.0 / ((length + rest) * length);
  return {at_rest + change, squares * (length * inverse), (length + rest) * inverse};
}

// The elongations e_s (m) under a displacement u (m).                docs/theory.md [elongation]
inline void elongations(const tissue::Network& network, tissue::Kinematics kinematics,
                        const tissue::Vector& displacement, std::span<double> elongation) {
  for (std::size_t s = 0; s < network.ends.size(); ++s) {
    const auto [a, b] = network.ends[s];
    elongation[s] = kinematics == tissue::Kinematics::linear
                        ? network.direction[s].dot(
                              Vec3(displacement.segment<3>(3 * b) - displacement.segment<3>(3 * a)))
                        : stretched(network, kinematics, displacement, s).elongation;
  }
}

// The sum over springs of tension(elongation) times `along`, J; symmetric in both arguments.
inline double work(const tissue::Network& network, std::span<const double> elongation,
                   std::span<const double> along) {
  std::vector<double> tension(elongation.size());
  tissue::tensions(network, elongation, tension);
  double sum = 0.0;
  for (std::size_t s = 0; s < tension.size(); ++s) sum += tension[s] * along[s];
  return sum;
}

// f = sum over springs of tension (N) times the spring's direction: an external load of +f is in
// equilibrium with it. Overwrites `force`.
inline void gather_forces(const tissue::Network& network, tissue::Kinematics kinematics,
                          const tissue::Vector& displacement, std::span<const double> tension,
                          tissue::Vector& force) {
  force.setZero(3 * network.nodes());
  for (std::size_t s = 0; s < network.ends.size(); ++s) {
    const auto [a, b] = network.ends[s];
    Vec3 pull;
    if (kinematics == tissue::Kinematics::linear) {
      pull = tension[s] * network.direction[s];
    } else {
      const Stretched now = stretched(network, kinematics, displacement, s);
      pull = tension[s] * now.per_length * now.span;
    }
    force.segment<3>(3 * a) -= pull;
    force.segment<3>(3 * b) += pull;
  }
}

}  // namespace palpate::test
