// A sparse factorisation stored in dense panels, for the many solves that follow it.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "base/split_matrix.h"

namespace palpate::integrate {

// L D L^T of a matrix, with columns of similar pattern gathered in panels. A panel is stored as the
// product with the inverse of its triangle, so that each half of a solve is one product per panel
// with four rows at a time, instead of a chain of single operations.
class PanelFactors {
 public:
  enum class Lanes { portable, widest };  // both give the same bits

  explicit PanelFactors(Lanes lanes = Lanes::widest) : lanes_(lanes) {}

  // Orders and factors a symmetric matrix, which must be positive definite except for its border,
  // the rows of `shared` (67). Returns false if a pivot is zero or not finite.
  [[nodiscard]] bool factor(const SplitMatrix& matrix);

  // Solves A x = b; `x` is resized like `b` if necessary. Allocates nothing otherwise.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;

  struct Panel {
    int first = 0;           // first column
    int width = 0;           // number of columns
    int below = 0;           // number of rows below its triangle
    int fours = 0;           // number of groups of four in its rows, rounded up
    std::size_t rows = 0;    // start of the list of the rows below, in rows_
    std::size_t values = 0;  // start in values_: all columns of 16 rows, of the next 16, and so on
  };

 private:
  void gather(const Eigen::SparseMatrix<double>& lower);
  void fill(const Eigen::SparseMatrix<double>& lower);

  Lanes lanes_;
  Eigen::Index size_ = 0;   // of the matrix without its border
  std::vector<int> place_;  // position of every unknown in the order of elimination
  std::vector<Panel> panels_;
  std::vector<int> rows_;
  std::vector<double> values_;
  std::vector<double> inverse_pivots_;
  mutable std::vector<double> x_;
  mutable std::vector<double> scratch_;
};

}  // namespace palpate::integrate
