// What every frame does to every mode: plain loops that the compiler makes wide, apart from the
// rest so that they may be compiled for it.
#pragma once

#include <cstddef>

namespace palpate::integrate::mode_loops {

// sum += factor row
void add_scaled(std::size_t size, double factor, const double* row, double* sum);

// sum += a b, entry by entry
void add_products(std::size_t size, const double* a, const double* b, double* sum);

// sum_i a_i b_i: terms whose index is alike modulo 8 in rising order, then those sums in pairs.
[[nodiscard]] double product(std::size_t size, const double* a, const double* b);

// A mode without inner branches: x = (q, q'/omega) goes to keep x + begin f0 + end f1, and what the
// force does on the way, and damping takes from it, is added up.
struct Frame {
  const double* keep[2][2] = {};
  const double* begin[2] = {};
  const double* end[2] = {};
  const double* force_before = nullptr;  // N / sqrt(kg): f0
  const double* force_after = nullptr;   // f1
  const double* damping = nullptr;       // 1/s^2: (q1 - q0)^2 damping is lost, J
  double* x[2] = {};                     // m sqrt(kg)
  double* work = nullptr;                // J
  double* lost = nullptr;                // J
};
void pass(std::size_t size, const Frame& frame);

}  // namespace palpate::integrate::mode_loops
