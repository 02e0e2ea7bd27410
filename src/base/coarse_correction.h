// The smooth part of a solution, by far fewer unknowns: the second level of a preconditioner.
#pragma once

#include <span>
#include <vector>

#include "base/block_matrix.h"
#include "base/cholesky.h"

namespace palpate {

// The nodes of a matrix in connected groups. Each group moves as one, by a translation of its
// degrees of freedom that are not held: with P, whose columns are these translations, C = P^T A P
// is small and is factored. Conjugate gradients with D^-1 + P C^-1 P^T in place of the diagonal's
// D^-1 take a number of iterations that depends on the size of a group only, and not on that of
// the matrix.                                                        Nicolaides 1987
class CoarseCorrection {
 public:
  // Returns false if C is not positive definite; then A is not either.
  [[nodiscard]] bool prepare(const BlockMatrix& matrix, std::span<const char> held);

  // z += P C^-1 P^T r for `lanes` vectors: entry l of degree of freedom d is r[stride d + l].
  void add(const Eigen::VectorXd& r, std::size_t lanes, std::size_t stride, Eigen::VectorXd& z);

 private:
  std::vector<int> free_;     // the degrees of freedom that are not held
  std::vector<int> unknown_;  // of C, for each of these
  Cholesky factors_;
  std::vector<double> gathered_;  // `stride` numbers per unknown of C
  Eigen::VectorXd load_, moved_;
};

}  // namespace palpate
