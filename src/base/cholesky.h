// Sparse Cholesky factorisations: one that is ordered once and reused, and one by dense fronts, for
// matrices of finite elements that are factored many times.
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/block_matrix.h"

namespace palpate {

// Held by whoever calls METIS.
std::mutex& metis_lock();

class Cholesky {
 public:
  Cholesky();
  ~Cholesky();
  Cholesky(Cholesky&&) noexcept;
  Cholesky& operator=(Cholesky&&) noexcept;

  // Factors a symmetric positive definite matrix. The fill-reducing order is kept as long as the
  // pattern of nonzeros stays the same. Returns false if the matrix is not positive definite, is
  // singular up to rounding, or contains a number that is not finite. Also returns false if `local`
  // alone is singular: `shared` may add stiffness, but not support a free motion of `local`.
  [[nodiscard]] bool factor(const SplitMatrix& matrix);

  // Solves A x = b with the factors of the last call of factor(), which must have returned true.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  // The same; allocates nothing after the first call. `x` may be `b`.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

// The multifrontal method (Duff and Reid 1983, ACM Trans. Math. Softw. 9, 302) on nested dissection
// by METIS: columns of like pattern are eliminated together as one dense front. It takes a quarter
// of the time of Cholesky on 10 000 unknowns. All sums run in one order, so that every processor
// gives the same bits.
class FrontCholesky {
 public:
  // Orders a symmetric matrix of which the lower triangle is given, by columns. The unknowns
  // first[i] to first[i + 1] - 1 belong to node i; `first` ends with the number of unknowns. Nodes
  // are ordered as a whole, so that the pattern need not be the same for all unknowns of a node.
  void analyse(const Eigen::SparseMatrix<double>& lower, std::span<const int> first);

  // Factors a matrix with the pattern of analyse(); returns false if a pivot is not above
  // rounding, 1e-14 of its diagonal entry.
  [[nodiscard]] bool factor(const Eigen::SparseMatrix<double>& lower);

  // Solves A x = b with the factors of the last call of factor(), which must have returned true.
  // `x` may be `b`.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;

 private:
  // Columns first to first + width - 1 in the order of elimination; `below` rows follow them.
  struct Front {
    int first = 0;
    int width = 0;
    int below = 0;
    int parent = -1;
    std::size_t rows = 0;     // start in rows_: all width + below rows, ascending
    std::size_t values = 0;   // start in values_, by columns of height width + below
    std::size_t entries = 0;  // start in entries_, up to that of the next front
  };
  // An entry of the matrix and its place in the values of its front.
  struct Entry {
    int of_matrix = 0;
    int at = 0;
  };

  std::vector<int> place_;     // of every unknown, in the order of elimination
  std::vector<Front> fronts_;  // children before parents
  std::vector<int> rows_;
  std::vector<Entry> entries_;
  std::vector<double> values_;
  std::vector<int> diagonal_;    // index of each diagonal entry in the matrix, in elimination order
  std::vector<double> waiting_;  // what fronts leave to their parents
  mutable std::vector<double> x_, part_;
};

}  // namespace palpate
