// Products row by row; every sum runs in the order of the columns.
#include "base/block_matrix.h"

#include <algorithm>
#include <cassert>

#include "base/index.h"

// Vectors of four lanes need no instructions of their own: both kinds of processor give the same
// bits.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"  // all functions that take vectors of four are inlined
#endif

namespace palpate {
namespace {

// A value per lane.
using Four = double __attribute__((vector_size(32)));

// Inlined into functions for different kinds of processors.
#define PALPATE_ALWAYS [[gnu::always_inline]] inline

PALPATE_ALWAYS Four load(const double* from) {
  Four values;
  __builtin_memcpy(&values, from, sizeof values);
  return values;
}
PALPATE_ALWAYS void store(double* to, const Four& values) {
  __builtin_memcpy(to, &values, sizeof values);
}

// y = A x. `Value` is a number or one per lane: `get` reads it from x, `put` writes it to y.
template <class Value, class Get, class Put>
PALPATE_ALWAYS void multiply(const BlockMatrix& matrix, const Get& get, const Put& put) {
  // Not a vector of values, whose allocator would not know how four of them are aligned.
  constexpr std::size_t width = sizeof(Value) / sizeof(double);
  std::vector<double> pressures(width * matrix.weights.size());
  for (std::size_t v = 0; v < matrix.weights.size(); ++v) {
    Value sum{};
    for (int k = matrix.volumes.start[v]; k < matrix.volumes.start[v + 1]; ++k) {
      const Vec3& change = matrix.changes[as_index(k)];
      const std::size_t first = 3 * as_index(matrix.volumes.column[as_index(k)]);
      sum += change.x() * get(first) + change.y() * get(first + 1) + change.z() * get(first + 2);
    }
    sum *= matrix.weights[v];
    __builtin_memcpy(&pressures[width * v], &sum, sizeof sum);
  }
  const std::size_t nodes = as_index(matrix.nodes());
  for (std::size_t n = 0; n < nodes; ++n) {
    Value a{};
    Value b{};
    Value c{};
    for (int k = matrix.rows.start[n]; k < matrix.rows.start[n + 1]; ++k) {
      const double* block = matrix.blocks[as_index(k)].data();  // column by column
      const std::size_t first = 3 * as_index(matrix.rows.column[as_index(k)]);
      const Value x = get(first);
      const Value y = get(first + 1);
      const Value z = get(first + 2);
      a += block[0] * x + block[3] * y + block[6] * z;
      b += block[1] * x + block[4] * y + block[7] * z;
      c += block[2] * x + block[5] * y + block[8] * z;
    }
    if (!pressures.empty())
      for (int k = matrix.around.start[n]; k < matrix.around.start[n + 1]; ++k) {
        const Vec3& change = matrix.changes_around[as_index(k)];
        Value pressure;
        __builtin_memcpy(&pressure, &pressures[width * as_index(matrix.around.column[as_index(k)])],
                         sizeof pressure);
        a += change.x() * pressure;
        b += change.y() * pressure;
        c += change.z() * pressure;
      }
    put(3 * n, a);
    put(3 * n + 1, b);
    put(3 * n + 2, c);
  }
}

PALPATE_ALWAYS void multiply_four(const BlockMatrix& matrix, const double* x, double* y) {
  struct Get {
    const double* x;
    [[gnu::always_inline]] Four operator()(std::size_t d) const {
      return load(x + block_lanes * d);
    }
  };
  struct Put {
    double* y;
    [[gnu::always_inline]] void operator()(std::size_t d, const Four& values) const {
      store(y + block_lanes * d, values);
    }
  };
  multiply<Four>(matrix, Get{x}, Put{y});
}

void portable(const BlockMatrix& matrix, const double* x, double* y) {
  multiply_four(matrix, x, y);
}
#if defined(__x86_64__)
__attribute__((target("avx2"))) void avx2(const BlockMatrix& matrix, const double* x, double* y) {
  multiply_four(matrix, x, y);
}
#endif

}  // namespace

BlockMatrix::BlockMatrix(int nodes, std::span<const std::array<int, 2>> pairs) {
  rows.start.assign(as_index(nodes) + 1, 0);
  for (std::size_t n = 1; n < rows.start.size(); ++n) rows.start[n] = 1;
  for (const auto& [a, b] : pairs) {
    ++rows.start[as_index(a) + 1];
    ++rows.start[as_index(b) + 1];
  }
  for (std::size_t n = 1; n < rows.start.size(); ++n) rows.start[n] += rows.start[n - 1];
  std::vector<int> next(rows.start.begin(), rows.start.end() - 1);
  rows.column.resize(as_index(rows.start.back()));
  for (int n = 0; n < nodes; ++n) rows.column[as_index(next[as_index(n)]++)] = n;
  for (const auto& [a, b] : pairs) {
    rows.column[as_index(next[as_index(a)]++)] = b;
    rows.column[as_index(next[as_index(b)]++)] = a;
  }
  for (int n = 0; n < nodes; ++n)
    std::sort(rows.column.begin() + rows.start[as_index(n)],
              rows.column.begin() + rows.start[as_index(n) + 1]);
  blocks.assign(rows.column.size(), Block::Zero());
}

BlockMatrix::Block& BlockMatrix::at(int row, int column) {
  const auto first = rows.column.begin() + rows.start[as_index(row)];
  const auto last = rows.column.begin() + rows.start[as_index(row) + 1];
  const auto found = std::lower_bound(first, last, column);
  assert(found != last && *found == column);
  return blocks[as_index(found - rows.column.begin())];
}

void BlockMatrix::end_volumes() {
  around.start.assign(as_index(nodes()) + 1, 0);
  for (const int node : volumes.column) ++around.start[as_index(node) + 1];
  for (std::size_t n = 1; n < around.start.size(); ++n) around.start[n] += around.start[n - 1];
  std::vector<int> next(around.start.begin(), around.start.end() - 1);
  around.column.resize(volumes.column.size());
  changes_around.resize(volumes.column.size());
  for (int v = 0; v < static_cast<int>(weights.size()); ++v)
    for (int k = volumes.start[as_index(v)]; k < volumes.start[as_index(v) + 1]; ++k) {
      const int place = next[as_index(volumes.column[as_index(k)])]++;
      around.column[as_index(place)] = v;
      changes_around[as_index(place)] = changes[as_index(k)];
    }
}

Eigen::VectorXd BlockMatrix::operator*(const Eigen::VectorXd& x) const {
  Eigen::VectorXd y(x.size());
  multiply<double>(
      *this, [&](std::size_t d) { return x[static_cast<Eigen::Index>(d)]; },
      [&](std::size_t d, double value) { y[static_cast<Eigen::Index>(d)] = value; });
  return y;
}

void multiply_lanes(const BlockMatrix& matrix, const std::vector<double>& x,
                    std::vector<double>& y) {
  y.resize(x.size());
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return avx2(matrix, x.data(), y.data());
#endif
  portable(matrix, x.data(), y.data());
}

Eigen::VectorXd BlockMatrix::diagonal() const {
  Eigen::VectorXd diagonal(3 * nodes());
  for (int n = 0; n < nodes(); ++n) {
    const auto first = rows.column.begin() + rows.start[as_index(n)];
    const auto own = std::lower_bound(first, rows.column.begin() + rows.start[as_index(n) + 1], n);
    diagonal.segment<3>(3 * n) = blocks[as_index(own - rows.column.begin())].diagonal();
  }
  for (std::size_t v = 0; v < weights.size(); ++v)
    for (int k = volumes.start[v]; k < volumes.start[v + 1]; ++k)
      diagonal.segment<3>(3 * volumes.column[as_index(k)]) +=
          weights[v] * changes[as_index(k)].cwiseAbs2();
  return diagonal;
}

SplitMatrix BlockMatrix::split(std::span<const char> held) const {
  using Sparse = Eigen::SparseMatrix<double>;
  const auto free = [&](int freedom) { return held[as_index(freedom)] == 0; };
  SplitMatrix result;
  Sparse& local = result.local;
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
      for (int k = rows.start[node]; k < rows.start[node + 1]; ++k)
        for (int i = 0; i < 3; ++i) {
          const int row = 3 * rows.column[as_index(k)] + i;
          if (free(row)) put(row, blocks[as_index(k)](column % 3, i));
        }
    }
    local.outerIndexPtr()[3 * nodes()] = next;
    if (!fills) local.resizeNonZeros(next);
  }
  if (weights.empty()) return result;
  result.weights =
      Eigen::Map<const Eigen::VectorXd>(weights.data(), static_cast<Eigen::Index>(weights.size()));
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(3 * changes.size());
  for (int v = 0; v < static_cast<int>(weights.size()); ++v)
    for (int k = volumes.start[as_index(v)]; k < volumes.start[as_index(v) + 1]; ++k)
      for (int i = 0; i < 3; ++i) {
        const int freedom = 3 * volumes.column[as_index(k)] + i;
        if (free(freedom)) triplets.emplace_back(v, freedom, changes[as_index(k)][i]);
      }
  result.shared.resize(result.weights.size(), local.cols());
  result.shared.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

}  // namespace palpate
