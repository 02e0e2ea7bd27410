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

  // z += P C^-1 P^T r for the first `lanes` of block_lanes vectors.
  void add(const std::vector<double>& r, std::size_t lanes, std::vector<double>& z);

 private:
  std::vector<int> group_;  // per node
  std::vector<char> held_;
  Cholesky factors_;
  std::vector<double> gathered_;  // block_lanes numbers per unknown of C
  Eigen::VectorXd load_, moved_;
};

}  // namespace palpate
