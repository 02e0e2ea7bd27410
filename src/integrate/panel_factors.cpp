// Makes panels from Eigen's simplicial factorisation.
#include "integrate/panel_factors.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <span>

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"  // all functions that take vectors of four are inlined
#endif

namespace palpate::integrate {
namespace {

using Panel = PanelFactors::Panel;
using Four = double __attribute__((vector_size(32)));

}  // namespace
}  // namespace palpate::integrate

#define PALPATE_LOOPS portable
#define PALPATE_TARGET
#include "base/index.h"
#include "integrate/panel_loops.h"
#undef PALPATE_LOOPS
#undef PALPATE_TARGET
#if defined(__x86_64__)
#define PALPATE_LOOPS avx2
#define PALPATE_TARGET __attribute__((target("avx2")))
#include "integrate/panel_loops.h"
#undef PALPATE_LOOPS
#undef PALPATE_TARGET
#endif

namespace palpate::integrate {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

// The lower triangle of [local, shared^T; shared, -1/weights]. With p = W S x as further unknowns,
// the product S^T W S is not multiplied out.                             docs/theory.md (67)
SparseMatrix bordered(const SplitMatrix& matrix) {
  const Eigen::Index n = matrix.local.rows();
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](const SparseMatrix& part, Eigen::Index down) {
    for (Eigen::Index column = 0; column < part.outerSize(); ++column)
      for (SparseMatrix::InnerIterator entry(part, column); entry; ++entry)
        if (entry.row() + down >= column)
          entries.emplace_back(static_cast<int>(entry.row() + down), static_cast<int>(column),
                               entry.value());
  };
  add(matrix.local, 0);
  if (matrix.weights.size() > 0) add(matrix.shared, n);
  for (Eigen::Index i = 0; i < matrix.weights.size(); ++i)
    entries.emplace_back(static_cast<int>(n + i), static_cast<int>(n + i),
                         -1.0 / matrix.weights[i]);
  SparseMatrix all(n + matrix.weights.size(), n + matrix.weights.size());
  all.setFromTriplets(entries.begin(), entries.end());
  return all;
}

}  // namespace

bool PanelFactors::factor(const SplitMatrix& matrix) {
  Eigen::SimplicialLDLT<SparseMatrix> ldlt(bordered(matrix));
  if (ldlt.info() != Eigen::Success) return false;
  const Eigen::VectorXd pivots = ldlt.vectorD();
  inverse_pivots_.assign(pivots.begin(), pivots.end());
  for (double& pivot : inverse_pivots_) {
    if (pivot == 0.0 || !std::isfinite(pivot)) return false;
    pivot = 1.0 / pivot;
  }
  size_ = matrix.local.rows();
  place_.assign(ldlt.permutationP().indices().begin(), ldlt.permutationP().indices().end());
  const SparseMatrix lower = ldlt.matrixL();  // with its diagonal of ones
  gather(lower);
  fill(lower);
  return true;
}

// Puts neighbouring columns, each the parent of the previous one in the elimination tree, into one
// panel if this adds few zeros.
void PanelFactors::gather(const SparseMatrix& lower) {
  const int* const start = lower.outerIndexPtr();
  const int* const row = lower.innerIndexPtr();
  const auto length = [&](int c) { return start[c + 1] - start[c]; };
  const int size = static_cast<int>(lower.cols());
  panels_.clear();
  rows_.clear();
  std::size_t values = 0;
  int widest = 0;
  for (int first = 0; first < size;) {
    int last = first;
    long entries = length(first);
    while (last + 1 < size && length(last) > 1 && row[start[last] + 1] == last + 1) {
      const long width = last + 2 - first;
      const long full = width * (length(last + 1) + width - 1) - width * (width - 1) / 2;
      // A panel costs about as much time as 40 additional numbers.
      if (full > (entries + length(last + 1)) * 5 / 4 + 40) break;
      entries += length(last + 1);
      ++last;
    }
    // A single column without entries below its diagonal needs no panel, only its pivot.
    if (last > first || length(first) > 1) {
      Panel panel;
      panel.first = first;
      panel.width = last + 1 - first;
      panel.below = length(last) - 1;
      panel.fours = (panel.width + panel.below + 3) / 4;
      panel.rows = rows_.size();
      panel.values = values;
      rows_.insert(rows_.end(), row + start[last] + 1, row + start[last + 1]);
      values += 4 * as_index(panel.fours) * as_index(panel.width);
      widest = std::max(widest, 4 * panel.fours + 4 * panel.width);
      panels_.push_back(panel);
    }
    first = last + 1;
  }
  values_.assign(values, 0.0);
  scratch_.assign(as_index(widest) + 16, 0.0);
  x_.assign(as_index(size) + 4, 0.0);
}

// Fills every panel with [1; B] T^-1: T is its unit triangle, B the rows below the triangle.
void PanelFactors::fill(const SparseMatrix& lower) {
  std::vector<int> local(as_index(lower.rows()), 0);
  for (const Panel& panel : panels_) {
    const int width = panel.width;
    for (int c = 0; c < width; ++c) local[as_index(panel.first + c)] = c;
    for (int k = 0; k < panel.below; ++k)
      local[as_index(rows_[panel.rows + as_index(k)])] = width + k;
    // Solves X T = [1; B] from the last column to the first, subtracting the columns to the right.
    Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(width, width);
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(4 * panel.fours, width);
    for (int c = 0; c < width; ++c)
      for (SparseMatrix::InnerIterator entry(lower, panel.first + c); entry; ++entry) {
        const int r = local[as_index(entry.row())];
        (r < width ? triangle(r, c) : x(r, c)) = entry.value();
      }
    for (int c = width - 1; c >= 0; --c) {
      x(c, c) = 1.0;
      for (int k = c + 1; k < width; ++k)
        for (Eigen::Index r = 0; r < x.rows(); ++r) x(r, c) -= x(r, k) * triangle(k, c);
    }
    double* to = &values_[panel.values];
    for (Eigen::Index top = 0; top < x.rows(); top += 16) {
      const Eigen::Index height = std::min<Eigen::Index>(16, x.rows() - top);
      for (int c = 0; c < width; ++c)
        for (Eigen::Index r = 0; r < height; ++r) *to++ = x(top + r, c);
    }
  }
}

void PanelFactors::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  std::fill(x_.begin(), x_.end(), 0.0);
  for (Eigen::Index i = 0; i < size_; ++i) x_[as_index(place_[as_index(i)])] = b[i];
  auto* work = &portable::solve;
#if defined(__x86_64__)
  if (lanes_ == Lanes::widest && __builtin_cpu_supports("avx2")) work = &avx2::solve;
#endif
  work(panels_, values_.data(), rows_.data(), inverse_pivots_.data(), inverse_pivots_.size(),
       x_.data(), scratch_.data());
  x.resize(size_);
  for (Eigen::Index i = 0; i < size_; ++i) x[i] = x_[as_index(place_[as_index(i)])];
}

}  // namespace palpate::integrate
