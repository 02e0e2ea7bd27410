// Products with the panels of a factorisation, four rows at a time. One .cpp includes this file
// once per instruction set, like tissue/fast_loops.h; no `#pragma once`.
#if !defined(PALPATE_LOOPS) || !defined(PALPATE_TARGET)
#error "panel_factors.cpp includes this"
#endif

namespace palpate::integrate::PALPATE_LOOPS {

using Wide = Four;
#include "base/wide_loads.h"

// out = block x, where the block has 4 `fours` rows and is stored by columns.
template <int fours>
PALPATE_INLINE void times(const double* block, int columns, const double* x, double* out) {
  Four sum[fours] = {};
  for (int c = 0; c < columns; ++c) {
    const Four factor = {x[c], x[c], x[c], x[c]};
#pragma GCC unroll 4
    for (int k = 0; k < fours; ++k) sum[k] += load(block + 4 * k) * factor;
    block += 4 * fours;
  }
#pragma GCC unroll 4
  for (int k = 0; k < fours; ++k) store(out + 4 * k, sum[k]);
}

// sums += block^T x, with four partial sums (lanes) for every column.
template <int fours>
PALPATE_INLINE void transposed_times(const double* block, int columns, const double* x,
                                     double* sums) {
  Four factor[fours];
#pragma GCC unroll 4
  for (int k = 0; k < fours; ++k) factor[k] = load(x + 4 * k);
  for (int c = 0; c < columns; ++c) {
    Four sum = load(sums + 4 * c);
#pragma GCC unroll 4
    for (int k = 0; k < fours; ++k) sum += load(block + 4 * k) * factor[k];
    store(sums + 4 * c, sum);
    block += 4 * fours;
  }
}

PALPATE_TARGET inline void solve(std::span<const Panel> panels, const double* values,
                                 const int* rows, const double* inverse_pivots, std::size_t size,
                                 double* x, double* scratch) {
  for (const Panel& panel : panels) {
    double* const own = x + panel.first;
    const double* block = values + panel.values;
    int fours = panel.fours;
    double* out = scratch;
    for (; fours >= 4; fours -= 4, block += 16 * panel.width, out += 16)
      times<4>(block, panel.width, own, out);
    if (fours == 3) times<3>(block, panel.width, own, out);
    if (fours == 2) times<2>(block, panel.width, own, out);
    if (fours == 1) times<1>(block, panel.width, own, out);
    for (int c = 0; c < panel.width; ++c) own[c] = scratch[c];
    const int* const below = rows + panel.rows;
    for (int k = 0; k < panel.below; ++k) x[below[k]] -= scratch[panel.width + k];
  }
  for (std::size_t i = 0; i < size; ++i) x[i] *= inverse_pivots[i];
  for (std::size_t p = panels.size(); p-- > 0;) {
    const Panel& panel = panels[p];
    double* const own = x + panel.first;
    const int* const below = rows + panel.rows;
    double* const in = scratch;
    double* const sums = scratch + 4 * panel.fours;
    for (int c = 0; c < panel.width; ++c) in[c] = own[c];
    for (int k = 0; k < panel.below; ++k) in[panel.width + k] = -x[below[k]];
    for (int k = panel.width + panel.below; k < 4 * panel.fours; ++k) in[k] = 0.0;
    for (int c = 0; c < panel.width; ++c) store(sums + 4 * c, Four{});
    const double* block = values + panel.values;
    int fours = panel.fours;
    const double* from = in;
    for (; fours >= 4; fours -= 4, block += 16 * panel.width, from += 16)
      transposed_times<4>(block, panel.width, from, sums);
    if (fours == 3) transposed_times<3>(block, panel.width, from, sums);
    if (fours == 2) transposed_times<2>(block, panel.width, from, sums);
    if (fours == 1) transposed_times<1>(block, panel.width, from, sums);
    for (int c = 0; c < panel.width; ++c) {
      const double* const s = sums + 4 * c;
      own[c] = (s[0] + s[1]) + (s[2] + s[3]);
    }
  }
}

}  // namespace palpate::integrate::PALPATE_LOOPS
#undef PALPATE_INLINE
