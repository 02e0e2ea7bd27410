// A sparse factorisation kept as dense panels, for the many solves that follow it.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "base/split_matrix.h"

namespace palpate::integrate {

// L D L^T of a matrix, its columns of like pattern gathered in panels. A panel stands with its own
// triangle inverted into it, so that each half of a solve is one product a panel: in rows of four,
// instead of one number after the other.                                     docs/theory.md (38)
class PanelFactors {
 public:
  enum class Lanes { portable, widest };  // the same bits

  explicit PanelFactors(Lanes lanes = Lanes::widest) : lanes_(lanes) {}

  // Factors a symmetric matrix, positive definite but for a bordered part where `shared` has rows,
  // its order found anew. Returns false where a pivot is zero or not finite.
  [[nodiscard]] bool factor(const SplitMatrix& matrix);

  // x with A x = b: overwrites `x`, which has the size of `b`. Allocates nothing.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;

  struct Panel {
    int first = 0;           // column
    int width = 0;           // columns
    int below = 0;           // rows below its own triangle
    int fours = 0;           // rows, own and below, rounded up to fours
    std::size_t rows = 0;    // where its list of rows below begins
    std::size_t values = 0;  // where its numbers begin: 16 rows of every column, 16 more, and so on
  };

 private:
  void gather(const Eigen::SparseMatrix<double>& lower);
  void fill(const Eigen::SparseMatrix<double>& lower);

  Lanes lanes_;
  Eigen::Index size_ = 0;   // of the matrix without its border
  std::vector<int> place_;  // of every unknown in the order of elimination
  std::vector<Panel> panels_;
  std::vector<int> rows_;
  std::vector<double> values_;
  std::vector<double> inverse_pivots_;
  mutable std::vector<double> x_;
  mutable std::vector<double> scratch_;
};

}  // namespace palpate::integrate
