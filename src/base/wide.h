// Attributes of loops that are wide on any processor, and four numbers at a time;
// src/CMakeLists.txt has compiler options for their files.
#pragma once

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"  // all functions that take vectors of four are inlined
#endif

// The function is compiled for these processors, and the one at hand takes its own.
#if defined(__x86_64__)
#define PALPATE_WIDE_ON(...) __attribute__((target_clones(__VA_ARGS__)))
#else
#define PALPATE_WIDE_ON(...)
#endif
#define PALPATE_WIDE PALPATE_WIDE_ON("default", "avx2")
#define PALPATE_WIDEST PALPATE_WIDE_ON("default", "avx2", "avx512f")
#define PALPATE_ALWAYS [[gnu::always_inline]] inline

namespace palpate {

using Four = double __attribute__((vector_size(32)));

PALPATE_ALWAYS Four load(const double* from) {
  Four values;
  __builtin_memcpy(&values, from, sizeof values);
  return values;
}
PALPATE_ALWAYS void store(double* to, const Four& values) {
  __builtin_memcpy(to, &values, sizeof values);
}
PALPATE_ALWAYS Four all(double value) { return Four{value, value, value, value}; }

// For each argument the sum of its first three numbers.
PALPATE_ALWAYS Four sums(const Four& a, const Four& b, const Four& c, const Four& d) {
  const Four xz_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Four y_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four xz_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Four y_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return __builtin_shufflevector(xz_ab, xz_cd, 0, 1, 4, 5) +
         (__builtin_shufflevector(y_ab, y_cd, 0, 1, 4, 5) +
          __builtin_shufflevector(xz_ab, xz_cd, 2, 3, 6, 7));
}

}  // namespace palpate
