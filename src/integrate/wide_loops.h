// Loops over all modes or degrees of freedom of one step, in a file of their own so that they can
// be compiled with vectorisation.
#pragma once

#include <cstddef>

namespace palpate::integrate::wide {

// sum += factor row
void add_scaled(std::size_t size, double factor, const double* row, double* sum);

// sum += a b, entry by entry
void add_products(std::size_t size, const double* a, const double* b, double* sum);

// sum_i a_i b_i: terms with equal index modulo 8 in ascending order, then these sums in pairs.
[[nodiscard]] double product(std::size_t size, const double* a, const double* b);

// Energies, J: 1/2 sum m v^2, and sum d (u1 - u0)^2.
[[nodiscard]] double kinetic(std::size_t size, const double* mass, const double* velocity);
[[nodiscard]] double moved_squares(std::size_t size, const double* factor, const double* before,
                                   const double* after);
// The work of forces (N) along a displacement (m), J: sum 1/2 (f0 + f1) (u1 - u0).
[[nodiscard]] double work(std::size_t size, const double* force_before, const double* force_after,
                          const double* before, const double* after);

// One step of central differences at every degree of freedom:           docs/theory.md [central]
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
void advance(std::size_t size, const Advance& step);

// One step of modes without branches: x = (q, q'/omega) becomes keep x + begin f0 + end f1. The
// work of the force and the energy lost to damping are added to `work` and `lost`.
struct Frame {
  const double* keep[2][2] = {};
  const double* begin[2] = {};
  const double* end[2] = {};
  const double* force_before = nullptr;  // N / sqrt(kg): f0
  const double* force_after = nullptr;   // f1
  const double* damping = nullptr;       // 1/s^2: the loss is damping (q1 - q0)^2, J
  double* x[2] = {};                     // m sqrt(kg)
  double* work = nullptr;                // J
  double* lost = nullptr;                // J
};
void pass(std::size_t size, const Frame& frame);

}  // namespace palpate::integrate::wide
