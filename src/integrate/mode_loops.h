// Loops over all modes of one step, in a file of their own so that they can be compiled with
// vectorisation.
#pragma once

#include <cstddef>

namespace palpate::integrate::mode_loops {

// sum += factor row
void add_scaled(std::size_t size, double factor, const double* row, double* sum);

// sum += a b, entry by entry
void add_products(std::size_t size, const double* a, const double* b, double* sum);

// sum_i a_i b_i: terms with equal index modulo 8 in ascending order, then these sums in pairs.
[[nodiscard]] double product(std::size_t size, const double* a, const double* b);

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

}  // namespace palpate::integrate::mode_loops
