// The dense product of FrontCholesky, four rows and four columns at a time. One .cpp includes this
// file once per instruction set; no `#pragma once`.
#if !defined(PALPATE_LOOPS) || !defined(PALPATE_TARGET)
#error "front_cholesky.cpp includes this"
#endif

namespace palpate::PALPATE_LOOPS {

using Wide = Four;
#include "base/wide_loads.h"

// out = sum over k < depth of a_k b_k^T as four columns of four rows; a_k and b_k are four numbers.
PALPATE_TARGET inline void product(const double* a, const double* b, int depth, double* out) {
  Four sum[4] = {};
  for (int k = 0; k < depth; ++k, a += 4, b += 4) {
    const Four row = load(a);
#pragma GCC unroll 4
    for (int c = 0; c < 4; ++c) sum[c] += row * Four{b[c], b[c], b[c], b[c]};
  }
#pragma GCC unroll 4
  for (int c = 0; c < 4; ++c) store(out + 4 * c, sum[c]);
}

}  // namespace palpate::PALPATE_LOOPS
#undef PALPATE_INLINE
