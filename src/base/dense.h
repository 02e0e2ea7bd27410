// Decompositions of dense matrices. Those of Eigen cost every file that names one three to ten
// seconds of its compilation, and again for each kind of expression that they are given: here they
// are compiled once.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace palpate::dense {

using Matrix = Eigen::MatrixXd;
// One row after the other, as solvers take derivatives.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

// The x of the least |A x - b|, by a QR decomposition with column pivots.
[[nodiscard]] Vector least_squares(const Matrix& a, const Vector& b);

// A = Q R: the columns of Q, as many as those of A, are orthonormal, and R is upper triangular. A
// has no fewer rows than columns.
struct Qr {
  Matrix q, r;
};
[[nodiscard]] Qr qr(const Matrix& a);

// A = U diag(values) V^T, the values falling. V is square, U has as many columns as there are
// values.
struct Svd {
  Vector values;
  Matrix u, v;
};
[[nodiscard]] Svd svd(const Matrix& a);

// S = L diag(pivots) L^T of a symmetric matrix, up to the order of its rows.
struct SymmetricFactors {
  Vector pivots;
  Matrix inverse;
};
// Nothing if a pivot is not greater than `least`.
[[nodiscard]] std::optional<SymmetricFactors> symmetric_factors(const Matrix& s,
                                                                double least = 0.0);

// The eigenvalues of a symmetric matrix, rising, and its eigenvectors as columns.
struct SymmetricModes {
  Vector values;
  Matrix vectors;
};
[[nodiscard]] SymmetricModes symmetric_modes(const Matrix& s);

// S = Q T Q^T of a symmetric matrix: the diagonal of T and the entries beside it.
struct Tridiagonal {
  Vector diagonal, beside;
  Matrix q;
};
[[nodiscard]] Tridiagonal tridiagonal(const Matrix& s);

// exp(A) of a square matrix.
[[nodiscard]] Matrix exponential(const Matrix& a);

// A B. Products of other types than these are compiled anew in every room.
[[nodiscard]] Matrix product(const Matrix& a, const Matrix& b);
// A^T B.
[[nodiscard]] Matrix inner_product(const Matrix& a, const Matrix& b);

}  // namespace palpate::dense
