// Products in one pass over the upper half; every sum runs in the same order on every processor.
#include "base/block_matrix.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/wide.h"

namespace palpate {

struct BlockProduct {
  const int* row_start;
  const int* column;
  const double* values;
  std::size_t nodes;
  const int* shared_start;
  const int* shared_column;
  const double* changes;
  const double* weights;
  std::size_t shared;
  bool straight;

  explicit BlockProduct(const BlockMatrix& a)
      : row_start(a.rows_.start.data()),
        column(a.rows_.column.data()),
        values(a.values_.data()),
        nodes(as_index(a.nodes())),
        shared_start(a.shared_.start.data()),
        shared_column(a.shared_.column.data()),
        changes(a.changes_.data()),
        weights(a.weights_.data()),
        shared(a.weights_.size()),
        straight(a.straight_) {}
};

namespace {

// y = A x of one vector, with one more number than x has at its end, and four numbers per node in
// y, the fourth of which is unused.
PALPATE_WIDE void multiply_one(const BlockProduct& a, const double* __restrict x,
                               double* __restrict y) {
  for (std::size_t n = 0; n < a.nodes; ++n) store(y + 4 * n, Four{});
  for (std::size_t v = 0; v < a.shared; ++v) {
    const int begin = a.shared_start[v];
    const int end = a.shared_start[v + 1];
    Four even{};
    Four odd{};
    int k = begin;
    for (; k + 2 <= end; k += 2) {
      even += load(a.changes + 3 * k) * load(x + 3 * a.shared_column[k]);
      odd += load(a.changes + 3 * k + 3) * load(x + 3 * a.shared_column[k + 1]);
    }
    if (k < end) even += load(a.changes + 3 * k) * load(x + 3 * a.shared_column[k]);
    const Four sum = even + odd;
    const Four pressure = all(a.weights[v] * (sum[0] + (sum[1] + sum[2])));
    for (k = begin; k < end; ++k) {
      double* const to = y + 4 * a.shared_column[k];
      store(to, load(to) + pressure * load(a.changes + 3 * k));
    }
  }
  for (std::size_t n = 0; n < a.nodes; ++n) {
    int k = a.row_start[n];
    const int end = a.row_start[n + 1];
    const double* block = a.values + 9 * k;
    const double* from = x + 3 * n;
    const Four own = load(from);
    const Four u = all(from[0]);
    const Four v = all(from[1]);
    const Four w = all(from[2]);
    Four sum = load(block) * u + (load(block + 3) * v + load(block + 6) * w);
    for (++k; k < end; ++k) {
      block = a.values + 9 * k;
      const auto other = static_cast<std::size_t>(a.column[k]);
      from = x + 3 * other;
      const Four first = load(block);
      const Four second = load(block + 3);
      const Four third = load(block + 6);
      sum += first * all(from[0]) + (second * all(from[1]) + third * all(from[2]));
      double* const to = y + 4 * other;
      store(to, load(to) + (a.straight ? first * u + (second * v + third * w)
                                       : sums(first * own, second * own, third * own, Four{})));
    }
    store(y + 4 * n, load(y + 4 * n) + sum);
  }
}

PALPATE_WIDE void collect(const double* from, double* to, std::size_t nodes) {
  for (std::size_t n = 0; n + 1 < nodes; ++n) store(to + 3 * n, load(from + 4 * n));
  for (std::size_t i = 0; i < 3; ++i) to[3 * (nodes - 1) + i] = from[4 * (nodes - 1) + i];
}

// The same of four vectors, three times four numbers per node.
PALPATE_WIDE void multiply_four(const BlockProduct& a, const double* __restrict x,
                                double* __restrict y) {
  for (std::size_t d = 0; d < 3 * a.nodes; ++d) store(y + 4 * d, Four{});
  for (std::size_t v = 0; v < a.shared; ++v) {
    Four sum{};
    for (int k = a.shared_start[v]; k < a.shared_start[v + 1]; ++k) {
      const double* const from = x + 12 * a.shared_column[k];
      const double* const change = a.changes + 3 * k;
      sum += change[0] * load(from) + change[1] * load(from + 4) + change[2] * load(from + 8);
    }
    sum *= a.weights[v];
    for (int k = a.shared_start[v]; k < a.shared_start[v + 1]; ++k)
      for (int i = 0; i < 3; ++i) {
        double* const to = y + 12 * a.shared_column[k] + 4 * i;
        store(to, load(to) + a.changes[3 * k + i] * sum);
      }
  }
  for (std::size_t n = 0; n < a.nodes; ++n) {
    int k = a.row_start[n];
    const int end = a.row_start[n + 1];
    const double* const own = x + 12 * n;
    const Four u = load(own);
    const Four v = load(own + 4);
    const Four w = load(own + 8);
    const double* b = a.values + 9 * k;
    Four first = b[0] * u + b[3] * v + b[6] * w;
    Four second = b[1] * u + b[4] * v + b[7] * w;
    Four third = b[2] * u + b[5] * v + b[8] * w;
    for (++k; k < end; ++k) {
      b = a.values + 9 * k;
      const std::size_t other = 12 * static_cast<std::size_t>(a.column[k]);
      const Four p = load(x + other);
      const Four q = load(x + other + 4);
      const Four r = load(x + other + 8);
      first += b[0] * p + b[3] * q + b[6] * r;
      second += b[1] * p + b[4] * q + b[7] * r;
      third += b[2] * p + b[5] * q + b[8] * r;
      double* const to = y + other;
      store(to, load(to) + (b[0] * u + b[1] * v + b[2] * w));
      store(to + 4, load(to + 4) + (b[3] * u + b[4] * v + b[5] * w));
      store(to + 8, load(to + 8) + (b[6] * u + b[7] * v + b[8] * w));
    }
    double* const to = y + 12 * n;
    store(to, load(to) + first);
    store(to + 4, load(to + 4) + second);
    store(to + 8, load(to + 8) + third);
  }
}

}  // namespace

BlockMatrix::BlockMatrix(int nodes, std::span<const std::array<int, 2>> pairs) {
  rows_.start.assign(as_index(nodes) + 1, 0);
  for (std::size_t n = 1; n < rows_.start.size(); ++n) rows_.start[n] = 1;
  for (const auto& pair : pairs) ++rows_.start[as_index(pair[0]) + 1];
  for (std::size_t n = 1; n < rows_.start.size(); ++n) rows_.start[n] += rows_.start[n - 1];
  std::vector<int> next(rows_.start.begin(), rows_.start.end() - 1);
  rows_.column.resize(as_index(rows_.start.back()));
  for (int n = 0; n < nodes; ++n) rows_.column[as_index(next[as_index(n)]++)] = n;
  for (const auto& [a, b] : pairs) {
    assert(a < b);
    rows_.column[as_index(next[as_index(a)]++)] = b;
  }
  for (std::size_t n = 0; n < as_index(nodes); ++n)
    std::sort(rows_.column.begin() + rows_.start[n], rows_.column.begin() + rows_.start[n + 1]);
  values_.assign(9 * rows_.column.size() + 3, 0.0);
  changes_.assign(1, 0.0);
}

void BlockMatrix::add(int row, int column, const Block& block) {
  if (column < row) return;
  if (row != column && straight_) straight_ = block == block.transpose();
  const auto first = rows_.column.begin() + rows_.start[as_index(row)];
  const auto last = rows_.column.begin() + rows_.start[as_index(row) + 1];
  const auto found = std::lower_bound(first, last, column);
  assert(found != last && *found == column);
  Eigen::Map<Block>(&values_[9 * as_index(found - rows_.column.begin())]) += block;
}

void BlockMatrix::add_shared(std::span<const std::pair<int, Vec3>> row, double weight) {
  for (const auto& [node, change] : row) {
    shared_.column.push_back(node);
    changes_.insert(changes_.end() - 1, change.begin(), change.end());
  }
  shared_.start.push_back(static_cast<int>(shared_.column.size()));
  weights_.push_back(weight);
}

void BlockMatrix::add_to_diagonal(const Eigen::VectorXd& diagonal) {
  for (Eigen::Index n = 0; n < nodes(); ++n)
    for (Eigen::Index i = 0; i < 3; ++i)
      values_[9 * as_index(rows_.start[as_index(n)]) + as_index(4 * i)] += diagonal[3 * n + i];
}

BlockMatrix& BlockMatrix::operator*=(double factor) {
  for (double& value : values_) value *= factor;
  for (double& weight : weights_) weight *= factor;
  return *this;
}

void BlockMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  thread_local std::vector<double> from, to;
  const auto count = as_index(nodes());
  y.resize(x.size());
  if (count == 0) return;
  from.resize(3 * count + 1);
  to.resize(4 * count);
  std::ranges::copy(x, from.begin());
  multiply_one(BlockProduct(*this), from.data(), to.data());
  collect(to.data(), y.data(), count);
}

Eigen::VectorXd BlockMatrix::operator*(const Eigen::VectorXd& x) const {
  Eigen::VectorXd y;
  multiply(x, y);
  return y;
}

void BlockMatrix::multiply_lanes(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  y.resize(x.size());
  multiply_four(BlockProduct(*this), x.data(), y.data());
}

Eigen::VectorXd BlockMatrix::diagonal() const {
  Eigen::VectorXd diagonal(3 * nodes());
  for (int n = 0; n < nodes(); ++n)
    diagonal.segment<3>(3 * n) = block(rows_.start[as_index(n)]).diagonal();
  for (std::size_t v = 0; v < weights_.size(); ++v)
    for (int k = shared_.start[v]; k < shared_.start[v + 1]; ++k)
      diagonal.segment<3>(3 * shared_.column[as_index(k)]) += weights_[v] * change(k).cwiseAbs2();
  return diagonal;
}

BlockMatrix::Neighbours BlockMatrix::neighbours() const {
  Neighbours all;
  const auto count = as_index(nodes());
  all.start.assign(count + 1, 0);
  for (std::size_t n = 0; n < count; ++n)
    for (int k = rows_.start[n]; k < rows_.start[n + 1]; ++k) {
      ++all.start[n + 1];
      if (const auto other = as_index(rows_.column[as_index(k)]); other != n)
        ++all.start[other + 1];
    }
  for (std::size_t n = 1; n <= count; ++n) all.start[n] += all.start[n - 1];
  all.each.resize(as_index(all.start.back()));
  std::vector<int> next(all.start.begin(), all.start.end() - 1);
  // Rows ascend, so that the blocks below the diagonal come first and in order.
  for (int n = 0; n < nodes(); ++n)
    for (int k = rows_.start[as_index(n)]; k < rows_.start[as_index(n) + 1]; ++k) {
      const int other = rows_.column[as_index(k)];
      all.each[as_index(next[as_index(n)]++)] = {other, k, false};
      if (other != n) all.each[as_index(next[as_index(other)]++)] = {n, k, true};
    }
  return all;
}

SplitMatrix BlockMatrix::split(std::span<const char> held) const {
  const auto free = [&](int freedom) { return held[as_index(freedom)] == 0; };
  const Neighbours all = neighbours();
  SplitMatrix result;
  Eigen::SparseMatrix<double>& local = result.local;
  local.resize(3 * nodes(), 3 * nodes());
  // By symmetry the columns are the rows.
  for (const bool fills : {false, true}) {
    int next = 0;
    for (int column = 0; column < 3 * nodes(); ++column) {
      local.outerIndexPtr()[column] = next;
      const auto put = [&](int row, double value) {
        if (fills) {
          local.innerIndexPtr()[next] = row;
          local.valuePtr()[next] = value;
        }
        ++next;
      };
      if (!free(column)) {
        put(column, 1.0);
        continue;
      }
      const std::size_t node = as_index(column / 3);
      for (int e = all.start[node]; e < all.start[node + 1]; ++e) {
        const Neighbour& other = all.each[as_index(e)];
        const double* const values = &values_[9 * as_index(other.block)];
        for (int i = 0; i < 3; ++i)
          if (const int row = 3 * other.node + i; free(row))
            put(row, values[other.transposed ? 3 * (column % 3) + i : column % 3 + 3 * i]);
      }
    }
    local.outerIndexPtr()[3 * nodes()] = next;
    if (!fills) local.resizeNonZeros(next);
  }
  if (weights_.empty()) return result;
  result.weights = Eigen::Map<const Eigen::VectorXd>(weights_.data(),
                                                     static_cast<Eigen::Index>(weights_.size()));
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(changes_.size());
  for (int v = 0; v < static_cast<int>(weights_.size()); ++v)
    for (int k = shared_.start[as_index(v)]; k < shared_.start[as_index(v) + 1]; ++k)
      for (int i = 0; i < 3; ++i) {
        const int freedom = 3 * shared_.column[as_index(k)] + i;
        if (free(freedom)) triplets.emplace_back(v, freedom, change(k)[i]);
      }
  result.shared.resize(result.weights.size(), local.cols());
  result.shared.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

}  // namespace palpate
