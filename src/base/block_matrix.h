// A symmetric sparse matrix of 3 x 3 blocks, a part of which is kept as a product.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <span>
#include <vector>

#include "base/index.h"
#include "base/vec3.h"

namespace palpate {

// A symmetric sparse matrix, a part of which is kept as a product.
// A = local + shared^T diag(weights) shared. If the rows of `shared` are long, multiplying them out
// would fill in the matrix. Without such a part `shared` has no rows.
struct SplitMatrix {
  Eigen::SparseMatrix<double> local;   // n x n
  Eigen::SparseMatrix<double> shared;  // m x n
  Eigen::VectorXd weights;             // size m, no zeros

  [[nodiscard]] Eigen::VectorXd operator*(const Eigen::VectorXd& x) const {
    Eigen::VectorXd y = local * x;
    if (weights.size() > 0) y += shared.transpose() * weights.cwiseProduct(shared * x);
    return y;
  }
  SplitMatrix& operator*=(double factor) {
    local *= factor;
    weights *= factor;
    return *this;
  }
};

// Rows of entries: row i has the entries start[i] to start[i + 1] - 1.
struct BlockRows {
  std::vector<int> start{0};
  std::vector<int> column;  // ascending within a row
};

// A = blocks + shared^T diag(weights) shared, as SplitMatrix; one row of blocks per node. Of the
// symmetric blocks only those on and above the diagonal are kept.
class BlockMatrix {
 public:
  using Block = Eigen::Matrix3d;

  BlockMatrix() = default;
  // The diagonal and the blocks of these pairs of nodes, each named once with the lower number
  // first; all zero.
  BlockMatrix(int nodes, std::span<const std::array<int, 2>> pairs);

  // Adds to a block of the pattern. Those below the diagonal are the transposed ones above it, and
  // what is added to them is ignored.
  void add(int row, int column, const Block& block);
  // Adds a row of `shared`, given by its entries at ascending nodes, and its weight.
  void add_shared(std::span<const std::pair<int, Vec3>> row, double weight);
  void add_to_diagonal(const Eigen::VectorXd& diagonal);
  BlockMatrix& operator*=(double factor);

  [[nodiscard]] int nodes() const { return static_cast<int>(rows_.start.size()) - 1; }
  [[nodiscard]] const BlockRows& rows() const { return rows_; }  // of the blocks that are kept
  [[nodiscard]] Block block(int k) const {
    return Eigen::Map<const Block>(&values_[9 * as_index(k)]);
  }
  [[nodiscard]] const BlockRows& shared() const { return shared_; }  // its columns are nodes
  [[nodiscard]] Vec3 change(int k) const {
    return Eigen::Map<const Vec3>(&changes_[3 * as_index(k)]);
  }
  [[nodiscard]] std::span<const double> weights() const { return weights_; }

  // A x, with the same bits on every processor. multiply() allocates nothing after its first call
  // in a thread, and `y` must not be `x`.
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  [[nodiscard]] Eigen::VectorXd operator*(const Eigen::VectorXd& x) const;
  // For four vectors at once: entry `lane` of number d is x[4 d + lane].
  void multiply_lanes(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;

  [[nodiscard]] Eigen::VectorXd diagonal() const;
  // The same matrix by single numbers; rows and columns of `held` degrees of freedom are those of
  // the identity.
  [[nodiscard]] SplitMatrix split(std::span<const char> held) const;

  // All blocks of a row, also those below the diagonal.
  struct Neighbour {
    int node = 0;
    int block = 0;            // its number, or that of the transposed block
    bool transposed = false;  // below the diagonal
  };
  struct Neighbours {
    std::vector<int> start;       // per node
    std::vector<Neighbour> each;  // ascending within a row
  };
  [[nodiscard]] Neighbours neighbours() const;

 private:
  friend struct BlockProduct;
  BlockRows rows_;
  std::vector<double> values_;  // 9 per block, column by column, and 3 more
  BlockRows shared_;
  std::vector<double> changes_;  // 3 per entry of `shared_`, and 1 more
  std::vector<double> weights_;
  bool straight_ = true;  // whether all blocks are symmetric: those of single springs
};

// The number of vectors that are multiplied in one pass over a matrix.
inline constexpr std::size_t block_lanes = 4;

}  // namespace palpate
