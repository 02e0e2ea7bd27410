// A symmetric sparse matrix of 3 x 3 blocks, a part of which is kept as a product.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/split_matrix.h"
#include "base/vec3.h"

namespace palpate {

// Rows of blocks: row i has the blocks start[i] to start[i + 1] - 1.
struct BlockRows {
  std::vector<int> start{0};
  std::vector<int> column;  // ascending within a row
};

// A = blocks + shared^T diag(weights) shared, as SplitMatrix; one row of blocks per node.
struct BlockMatrix {
  using Block = Eigen::Matrix3d;

  BlockRows rows;
  std::vector<Block> blocks;  // of `rows`; symmetric as a whole
  BlockRows volumes;          // one row per weight, its columns are nodes
  std::vector<Vec3> changes;  // of `volumes`: the entries of `shared`
  std::vector<double> weights;
  // The transpose of `volumes`, filled by end_volumes(): rows are nodes, columns volumes.
  BlockRows around;
  std::vector<Vec3> changes_around;  // of `around`: the same `changes` in its order

  // Sets `rows` with the diagonal and the blocks of these pairs of nodes, each named once with the
  // lower number first, and zero blocks.
  BlockMatrix() = default;
  BlockMatrix(int nodes, std::span<const std::array<int, 2>> pairs);

  [[nodiscard]] int nodes() const { return static_cast<int>(rows.start.size()) - 1; }
  // The block of a row and a column, which must be in the pattern.
  [[nodiscard]] Block& at(int row, int column);

  // Call when `volumes` is complete.
  void end_volumes();

  // A x.
  [[nodiscard]] Eigen::VectorXd operator*(const Eigen::VectorXd& x) const;
  // The diagonal of A.
  [[nodiscard]] Eigen::VectorXd diagonal() const;
  // The same matrix by single numbers; rows and columns of `held` degrees of freedom are those of
  // the identity.
  [[nodiscard]] SplitMatrix split(std::span<const char> held) const;
};

// The number of vectors that are multiplied in one pass over a matrix.
inline constexpr std::size_t block_lanes = 4;

// y = A x for four vectors at once: entry `lane` of number d is x[4 d + lane].
void multiply_lanes(const BlockMatrix& matrix, const std::vector<double>& x,
                    std::vector<double>& y);

}  // namespace palpate
