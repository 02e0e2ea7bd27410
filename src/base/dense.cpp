// Each decomposition of Eigen is instantiated here and nowhere else.
#include "base/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <unsupported/Eigen/MatrixFunctions>

namespace palpate::dense {

Vector least_squares(const Matrix& a, const Vector& b) { return a.colPivHouseholderQr().solve(b); }

Qr qr(const Matrix& a) {
  const Eigen::HouseholderQR<Matrix> split(a);
  return {.q = split.householderQ() * Matrix::Identity(a.rows(), a.cols()),
          .r = split.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>()};
}

Svd svd(const Matrix& a) {
  // A = Q R, or A with rows of zeros below, so that the one to be decomposed is square.
  Qr square;
  if (a.rows() > a.cols()) {
    square = qr(a);
  } else {
    square = {.q = Matrix::Identity(a.rows(), a.cols()), .r = Matrix::Zero(a.cols(), a.cols())};
    square.r.topRows(a.rows()) = a;
  }
  const Eigen::JacobiSVD<Matrix, Eigen::NoQRPreconditioner> split(
      square.r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {.values = split.singularValues(),
          .u = product(square.q, split.matrixU()),
          .v = split.matrixV()};
}

std::optional<SymmetricFactors> symmetric_factors(const Matrix& s, double least) {
  const Eigen::LDLT<Matrix> split(s);
  if (split.info() != Eigen::Success || !(split.vectorD().minCoeff() > least)) return std::nullopt;
  return SymmetricFactors{.pivots = split.vectorD(),
                          .inverse = split.solve(Matrix::Identity(s.rows(), s.cols()))};
}

SymmetricModes symmetric_modes(const Matrix& s) {
  const Eigen::SelfAdjointEigenSolver<Matrix> split(s);
  return {.values = split.eigenvalues(), .vectors = split.eigenvectors()};
}

Tridiagonal tridiagonal(const Matrix& s) {
  const Eigen::Tridiagonalization<Matrix> split(s);
  return {.diagonal = split.diagonal(), .beside = split.subDiagonal(), .q = split.matrixQ()};
}

Matrix exponential(const Matrix& a) { return a.exp(); }

Matrix product(const Matrix& a, const Matrix& b) { return a * b; }
Matrix inner_product(const Matrix& a, const Matrix& b) { return a.transpose() * b; }

}  // namespace palpate::dense
