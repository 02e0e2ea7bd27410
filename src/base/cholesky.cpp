// Cholesky by Eigen's simplicial factorisations: serial, no BLAS, the same bits on every machine.
#include "base/cholesky.h"

#include <iostream>  // for Eigen/MetisSupport

#include <Eigen/MetisSupport>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <csignal>
#include <utility>

#include "base/index.h"

// METIS handles SIGTERM and SIGABRT while it works, for all threads, by a jump back to its own
// caller, and then puts the handlers from before back for one signal only. This definition stands
// in front of the C library's for the libraries that palpate loads, of which METIS alone asks for
// it: the handlers stay those of the program.
extern "C" sighandler_t __sysv_signal(int, sighandler_t) noexcept { return SIG_DFL; }

namespace palpate {

std::mutex& metis_lock() {
  static std::mutex one_at_a_time;
  return one_at_a_time;
}

namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

// Minimum degree ordering, and nested dissection for large matrices. Measured times of the
// factorisation: 36 s and 15 s on a structured mesh of 5832 nodes, equal times on one of 1728
// nodes.
struct Ordering {
  using PermutationType = Eigen::AMDOrdering<int>::PermutationType;

  template <class Matrix>
  void operator()(const Matrix& matrix, PermutationType& order) {
    constexpr Eigen::Index large = 6000;  // unknowns
    if (matrix.rows() < large) {
      Eigen::AMDOrdering<int>()(matrix, order);
      return;
    }
    const std::lock_guard lock(metis_lock());
    Eigen::MetisOrdering<int>()(matrix, order);
  }
};

// With p = W S x as further unknowns, (L + S^T W S) x = b is
//   [ L   S^T  ] [x]   [b]
//   [ S  -W^-1 ] [p] = [0],
// which has L's sparsity. Only the lower triangle is filled.
SparseMatrix bordered(const SplitMatrix& matrix) {
  const Eigen::Index n = matrix.local.rows();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(
      as_index(matrix.local.nonZeros() + matrix.shared.nonZeros() + matrix.weights.size()));
  for (Eigen::Index column = 0; column < n; ++column)
    for (SparseMatrix::InnerIterator entry(matrix.local, column); entry; ++entry)
      if (entry.row() >= column)
        entries.emplace_back(static_cast<int>(entry.row()), static_cast<int>(column),
                             entry.value());
  for (Eigen::Index column = 0; column < matrix.shared.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(matrix.shared, column); entry; ++entry)
      entries.emplace_back(static_cast<int>(n + entry.row()), static_cast<int>(column),
                           entry.value());
  for (Eigen::Index i = 0; i < matrix.weights.size(); ++i)
    entries.emplace_back(static_cast<int>(n + i), static_cast<int>(n + i),
                         -1.0 / matrix.weights[i]);
  const Eigen::Index size = n + matrix.weights.size();
  SparseMatrix all(size, size);
  all.setFromTriplets(entries.begin(), entries.end());
  return all;
}

// The positions of a matrix's nonzeros.
class Pattern {
 public:
  // Replaces the pattern by that of `matrix`; returns whether it was the same.
  bool becomes(const SparseMatrix& matrix) {
    std::vector<int> columns;
    std::vector<int> rows;
    if (matrix.isCompressed()) {
      columns.assign(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.outerSize() + 1);
      rows.assign(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros());
    }
    const bool same = !columns.empty() && columns == columns_ && rows == rows_;
    columns_ = std::move(columns);
    rows_ = std::move(rows);
    return same;
  }

 private:
  std::vector<int> columns_;
  std::vector<int> rows_;
};

// The magnitude of each diagonal entry before elimination: the diagonal of A, then 1/|W|.
Eigen::VectorXd sizes(const SplitMatrix& matrix) {
  const Eigen::Index n = matrix.local.rows();
  Eigen::VectorXd size(n + matrix.weights.size());
  size.head(n) = matrix.local.diagonal();
  size.tail(matrix.weights.size()) = matrix.weights.cwiseAbs().cwiseInverse();
  for (Eigen::Index column = 0; column < matrix.shared.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(matrix.shared, column); entry; ++entry)
      size[column] += std::abs(matrix.weights[entry.row()]) * entry.value() * entry.value();
  return size;
}

// Whether all pivots are larger than rounding; a smaller pivot means that the matrix is singular.
// Measured: the smallest pivot of free bodies is at most 2e-14 of its row's size; that of a bar of
// 60 cells that is held at one end, with nu = 0.4995, is 4e-7.
bool stands_clear(const Eigen::VectorXd& pivots, const Eigen::VectorXd& size,
                  const Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>& order) {
  constexpr double rounding = 1e-12;
  for (Eigen::Index i = 0; i < size.size(); ++i) {
    const double pivot = pivots[order.indices()[i]];
    if (!std::isfinite(pivot) || std::abs(pivot) <= rounding * size[i]) return false;
  }
  return true;
}

}  // namespace

struct Cholesky::Factors {
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Ordering> plain;
  Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Ordering> bordered;
  Pattern of_plain;
  Pattern of_bordered;
  Eigen::Index size = 0;
  Eigen::Index shared = 0;
  Eigen::VectorXd pivots;   // of `bordered`
  Eigen::VectorXd ordered;  // right-hand side and solution in the order of elimination
};

Cholesky::Cholesky() : factors_(std::make_unique<Factors>()) {}
Cholesky::~Cholesky() = default;
Cholesky::Cholesky(Cholesky&&) noexcept = default;
Cholesky& Cholesky::operator=(Cholesky&&) noexcept = default;

bool Cholesky::factor(const SplitMatrix& matrix) {
  Factors& factors = *factors_;
  factors.size = matrix.local.rows();
  factors.shared = matrix.weights.size();
  if (factors.shared == 0) {
    if (!factors.of_plain.becomes(matrix.local)) factors.plain.analyzePattern(matrix.local);
    factors.plain.factorize(matrix.local);
    if (factors.plain.info() != Eigen::Success) return false;
    const Eigen::VectorXd diagonal = factors.plain.matrixL().nestedExpression().diagonal();
    return stands_clear(diagonal.cwiseAbs2(), sizes(matrix), factors.plain.permutationP());
  }
  const SparseMatrix all = bordered(matrix);
  if (!factors.of_bordered.becomes(all)) factors.bordered.analyzePattern(all);
  factors.bordered.factorize(all);
  if (factors.bordered.info() != Eigen::Success) return false;
  // The number of negative pivots of the bordered matrix is the number of positive weights plus the
  // number of negative eigenvalues of the matrix itself (Sylvester's law of inertia).
  Eigen::Index expected = 0;
  for (Eigen::Index i = 0; i < factors.shared; ++i) expected += matrix.weights[i] > 0.0 ? 1 : 0;
  Eigen::VectorXd& pivots = factors.pivots;
  pivots = factors.bordered.vectorD();
  Eigen::Index negative = 0;
  for (Eigen::Index i = 0; i < pivots.size(); ++i) negative += pivots[i] < 0.0 ? 1 : 0;
  return negative == expected &&
         stands_clear(pivots, sizes(matrix), factors.bordered.permutationP());
}

Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& b) const {
  Eigen::VectorXd x;
  solve(b, x);
  return x;
}

// Like Eigen's solve(), which would allocate memory for its permutations.
void Cholesky::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  Factors& factors = *factors_;
  const bool plain = factors.shared == 0;
  const auto& order =
      (plain ? factors.plain.permutationP() : factors.bordered.permutationP()).indices();
  // The permutation is empty if Eigen kept the order of the unknowns.
  const auto place = [&](Eigen::Index i) { return order.size() > 0 ? Eigen::Index{order[i]} : i; };
  Eigen::VectorXd& ordered = factors.ordered;
  ordered.setZero(factors.size + factors.shared);
  for (Eigen::Index i = 0; i < factors.size; ++i) ordered[place(i)] = b[i];
  if (plain) {
    factors.plain.matrixL().solveInPlace(ordered);
    factors.plain.matrixU().solveInPlace(ordered);
  } else {
    factors.bordered.matrixL().solveInPlace(ordered);
    ordered = factors.pivots.asDiagonal().inverse() * ordered;
    factors.bordered.matrixU().solveInPlace(ordered);
  }
  x.resize(factors.size);
  for (Eigen::Index i = 0; i < factors.size; ++i) x[i] = ordered[place(i)];
}

}  // namespace palpate
