// Loops over degrees of freedom, four at a time; their run time is that of memory access.
#pragma once

#include <cstddef>

namespace palpate::tissue {

namespace fast_vectors {

// Two numbers in one register, which every x86-64 and every 64-bit ARM processor has.
using Two = double __attribute__((vector_size(16)));

inline Two load(const double* from) {
  Two values;
  __builtin_memcpy(&values, from, sizeof values);
  return values;
}
inline void store(double* to, Two values) { __builtin_memcpy(to, &values, sizeof values); }

// sum_i term(i) for i < count: terms with equal index modulo 4 in ascending order, then these sums
// as (0 + 1) + (2 + 3). `term` gets an index and a function to load one or two numbers from there.
template <class Term>
double sum_in_four(std::size_t count, const Term& term) {
  const auto pair = [](const double* from) { return load(from); };
  const auto single = [](const double* from) { return *from; };
  Two low{};
  Two high{};
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    low += term(i, pair);
    high += term(i + 2, pair);
  }
  double sum[4] = {low[0], low[1], high[0], high[1]};
  for (std::size_t j = 0; i + j < count; ++j) sum[j] += term(i + j, single);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace fast_vectors

inline double sum_of_products(std::size_t count, const double* a, const double* b) {
  return fast_vectors::sum_in_four(
      count, [=](std::size_t d, const auto& at) { return at(a + d) * at(b + d); });
}

// sum of 1/2 a v^2: for masses a (kg) and velocities v (m/s) the kinetic energy, J.
inline double sum_of_squares(std::size_t count, const double* a, const double* v) {
  return fast_vectors::sum_in_four(count, [=](std::size_t d, const auto& at) {
    return 0.5 * at(a + d) * at(v + d) * at(v + d);
  });
}

// sum of a (u1 - u0)^2.
inline double sum_of_moved_squares(std::size_t count, const double* a, const double* u0,
                                   const double* u1) {
  return fast_vectors::sum_in_four(count, [=](std::size_t d, const auto& at) {
    const auto moved = at(u1 + d) - at(u0 + d);
    return at(a + d) * moved * moved;
  });
}

// sum of 1/2 (f0 + f1) (u1 - u0): the work of forces (N) along a displacement (m), J.
inline double work_of_forces(std::size_t count, const double* f0, const double* f1,
                             const double* u0, const double* u1) {
  return fast_vectors::sum_in_four(count, [=](std::size_t d, const auto& at) {
    return 0.5 * (at(f0 + d) + at(f1 + d)) * (at(u1 + d) - at(u0 + d));
  });
}

// One step of central differences at every degree of freedom:                docs/theory.md (38)
//   w = inverse (square (external - internal) + keep w),  u = u + w,  v = rate w
struct Advance {
  double square = 0.0;               // s^2
  double rate = 0.0;                 // 1/s
  const double* inverse = nullptr;   // 1/kg
  const double* keep = nullptr;      // kg
  const double* external = nullptr;  // N
  const double* internal = nullptr;  // N
  double* moved = nullptr;           // m: w
  double* displacement = nullptr;    // m: u
  double* velocity = nullptr;        // m/s: v
};

inline void advance(std::size_t count, const Advance& step) {
  using fast_vectors::load;
  using fast_vectors::store;
  // A copy, so that the compiler can see that no store below changes it.
  const Advance a = step;
  std::size_t d = 0;
  for (; d + 2 <= count; d += 2) {
    const fast_vectors::Two w =
        load(a.inverse + d) * (a.square * (load(a.external + d) - load(a.internal + d)) +
                               load(a.keep + d) * load(a.moved + d));
    store(a.moved + d, w);
    store(a.displacement + d, load(a.displacement + d) + w);
    store(a.velocity + d, a.rate * w);
  }
  for (; d < count; ++d) {
    const double w =
        a.inverse[d] * (a.square * (a.external[d] - a.internal[d]) + a.keep[d] * a.moved[d]);
    a.moved[d] = w;
    a.displacement[d] += w;
    a.velocity[d] = a.rate * w;
  }
}

}  // namespace palpate::tissue
