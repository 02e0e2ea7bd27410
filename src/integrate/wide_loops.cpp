// Sums entry by entry, so that any width gives the same bits; CMakeLists.txt has compiler options.
#include "integrate/wide_loops.h"

#include "base/wide.h"

namespace palpate::integrate::wide {

PALPATE_WIDEST void add_scaled(std::size_t size, double factor, const double* __restrict row,
                               double* __restrict sum) {
  for (std::size_t i = 0; i < size; ++i) sum[i] += factor * row[i];
}

PALPATE_WIDEST void add_products(std::size_t size, const double* __restrict a,
                                 const double* __restrict b, double* __restrict sum) {
  for (std::size_t i = 0; i < size; ++i) sum[i] += a[i] * b[i];
}

namespace {

// sum_i term(i): terms with equal index modulo 8 in ascending order, then these sums in pairs.
template <class Term>
[[gnu::always_inline]] inline double sum(std::size_t size, const Term& term) {
  constexpr std::size_t lanes = 8;
  double sums[lanes] = {};
  std::size_t i = 0;
  for (; i + lanes <= size; i += lanes)
    for (std::size_t k = 0; k < lanes; ++k) sums[k] += term(i + k);
  for (std::size_t k = 0; i + k < size; ++k) sums[k] += term(i + k);
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

}  // namespace

PALPATE_WIDEST double product(std::size_t size, const double* a, const double* b) {
  return sum(
      size, [=](std::size_t i) __attribute__((always_inline)) { return a[i] * b[i]; });
}

PALPATE_WIDEST double kinetic(std::size_t size, const double* mass, const double* velocity) {
  return sum(
      size, [=](std::size_t i) __attribute__((always_inline)) {
        return 0.5 * mass[i] * velocity[i] * velocity[i];
      });
}

PALPATE_WIDEST double moved_squares(std::size_t size, const double* factor, const double* before,
                                    const double* after) {
  return sum(
      size, [=](std::size_t i) __attribute__((always_inline)) {
        return factor[i] * (after[i] - before[i]) * (after[i] - before[i]);
      });
}

PALPATE_WIDEST double work(std::size_t size, const double* force_before, const double* force_after,
                           const double* before, const double* after) {
  return sum(
      size, [=](std::size_t i) __attribute__((always_inline)) {
        return 0.5 * (force_before[i] + force_after[i]) * (after[i] - before[i]);
      });
}

PALPATE_WIDEST void advance(std::size_t size, const Advance& step) {
  const double square = step.square;
  const double rate = step.rate;
  const double* __restrict inverse = step.inverse;
  const double* __restrict keep = step.keep;
  const double* __restrict external = step.external;
  const double* __restrict internal = step.internal;
  double* __restrict moved = step.moved;
  double* __restrict displacement = step.displacement;
  double* __restrict velocity = step.velocity;
  for (std::size_t i = 0; i < size; ++i) {
    const double w = inverse[i] * (square * (external[i] - internal[i]) + keep[i] * moved[i]);
    moved[i] = w;
    displacement[i] += w;
    velocity[i] = rate * w;
  }
}

PALPATE_WIDEST void pass(std::size_t size, const Frame& frame) {
  const double* __restrict k00 = frame.keep[0][0];
  const double* __restrict k01 = frame.keep[0][1];
  const double* __restrict k10 = frame.keep[1][0];
  const double* __restrict k11 = frame.keep[1][1];
  const double* __restrict b0 = frame.begin[0];
  const double* __restrict b1 = frame.begin[1];
  const double* __restrict e0 = frame.end[0];
  const double* __restrict e1 = frame.end[1];
  const double* __restrict f0 = frame.force_before;
  const double* __restrict f1 = frame.force_after;
  const double* __restrict damping = frame.damping;
  double* __restrict q = frame.x[0];
  double* __restrict v = frame.x[1];
  double* __restrict work = frame.work;
  double* __restrict lost = frame.lost;
  for (std::size_t i = 0; i < size; ++i) {
    const double position = (k00[i] * q[i] + k01[i] * v[i]) + (b0[i] * f0[i] + e0[i] * f1[i]);
    const double velocity = (k10[i] * q[i] + k11[i] * v[i]) + (b1[i] * f0[i] + e1[i] * f1[i]);
    const double moved = position - q[i];
    work[i] += 0.5 * (f0[i] + f1[i]) * moved;
    lost[i] += damping[i] * moved * moved;
    q[i] = position;
    v[i] = velocity;
  }
}

}  // namespace palpate::integrate::wide
