// Orders nodes, finds the fronts, and eliminates them from the leaves of the tree to its roots.

#include <metis.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/cholesky.h"
#include "base/index.h"
#include "base/stop_scope.h"
#include "base/wide.h"

namespace palpate {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

// Numbers that are computed at once.
using Two = double __attribute__((vector_size(16)));
using Eight = double __attribute__((vector_size(64)));

// Eight rows by four columns: the sums over k < depth of eight numbers a_k times four numbers b_k,
// which stand eight apart as well.
using Tile = double[4][8];

template <class Numbers>
PALPATE_ALWAYS void multiply(const double* a, const double* b, int depth, Tile& tile) {
  constexpr int parts = sizeof(Eight) / sizeof(Numbers);
  Numbers sum[4 * parts] = {};
  for (int k = 0; k < depth; ++k, a += 8, b += 8) {
    Numbers rows[parts];
    for (int p = 0; p < parts; ++p) __builtin_memcpy(&rows[p], a + 8 / parts * p, sizeof rows[p]);
#pragma GCC unroll 8
    for (int i = 0; i < 4 * parts; ++i) sum[i] += rows[i % parts] * b[i / parts];
  }
  __builtin_memcpy(tile, sum, sizeof sum);
}

// Neighbours of every node, ascending and without itself.
struct Graph {
  std::vector<idx_t> start{0};
  std::vector<idx_t> to;
};

Graph node_graph(const SparseMatrix& lower, std::span<const int> first) {
  const int nodes = static_cast<int>(first.size()) - 1;
  std::vector<int> node_of(as_index(lower.rows()));
  for (int n = 0; n < nodes; ++n)
    for (int d = first[as_index(n)]; d < first[as_index(n) + 1]; ++d) node_of[as_index(d)] = n;
  std::vector<std::vector<int>> around(as_index(nodes));
  for (int column = 0; column < lower.cols(); ++column)
    for (SparseMatrix::InnerIterator entry(lower, column); entry; ++entry) {
      const int a = node_of[as_index(column)];
      const int b = node_of[as_index(entry.row())];
      if (a == b || (!around[as_index(a)].empty() && around[as_index(a)].back() == b)) continue;
      around[as_index(a)].push_back(b);
      around[as_index(b)].push_back(a);
    }
  Graph graph;
  for (std::vector<int>& list : around) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
    graph.to.insert(graph.to.end(), list.begin(), list.end());
    graph.start.push_back(static_cast<idx_t>(graph.to.size()));
  }
  return graph;
}

// order[i] is the node that is eliminated as number i.
std::vector<int> dissect(Graph& graph) {
  idx_t nodes = static_cast<idx_t>(graph.start.size()) - 1;
  std::vector<idx_t> order(as_index(nodes));
  std::vector<idx_t> place(as_index(nodes));
  std::iota(order.begin(), order.end(), 0);
  if (!graph.to.empty()) {
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_NUMBERING] = 0;
    const std::lock_guard lock(metis_lock());
    METIS_NodeND(&nodes, graph.start.data(), graph.to.data(), nullptr, options, order.data(),
                 place.data());
  }
  return {order.begin(), order.end()};
}

// The elimination of nodes: parents, and the later nodes that each meets (Liu 1990, SIAM J. Matrix
// Anal. Appl. 11, 134). Numbers are places in the order.
struct Elimination {
  std::vector<int> parent;
  std::vector<std::vector<int>> later;
};

Elimination eliminate(const Graph& graph, const std::vector<int>& order) {
  const int nodes = static_cast<int>(order.size());
  std::vector<int> place(order.size());
  for (int i = 0; i < nodes; ++i) place[as_index(order[as_index(i)])] = i;
  Elimination found{std::vector<int>(order.size(), -1),
                    std::vector<std::vector<int>>(order.size())};
  std::vector<std::vector<int>> children(order.size());
  std::vector<int> seen(order.size(), -1);
  for (int i = 0; i < nodes; ++i) {
    std::vector<int>& later = found.later[as_index(i)];
    const auto take = [&](int j) {
      if (j <= i || seen[as_index(j)] == i) return;
      seen[as_index(j)] = i;
      later.push_back(j);
    };
    const auto node = as_index(order[as_index(i)]);
    for (idx_t k = graph.start[node]; k < graph.start[node + 1]; ++k)
      take(place[as_index(graph.to[as_index(k)])]);
    for (const int child : children[as_index(i)])
      for (const int j : found.later[as_index(child)]) take(j);
    std::ranges::sort(later);
    if (later.empty()) continue;
    found.parent[as_index(i)] = later.front();
    children[as_index(later.front())].push_back(i);
  }
  return found;
}

// Places in an order in which every subtree is consecutive, children before parents.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int nodes = static_cast<int>(parent.size());
  std::vector<int> first_child(parent.size(), -1);
  std::vector<int> next(parent.size(), -1);
  for (int i = nodes - 1; i >= 0; --i) {
    if (parent[as_index(i)] < 0) continue;
    next[as_index(i)] = std::exchange(first_child[as_index(parent[as_index(i)])], i);
  }
  std::vector<int> order;
  std::vector<int> stack;
  for (int root = 0; root < nodes; ++root) {
    if (parent[as_index(root)] >= 0) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int top = stack.back();
      if (const int child = std::exchange(first_child[as_index(top)], -1); child >= 0) {
        for (int c = child; c >= 0; c = next[as_index(c)]) stack.push_back(c);
        continue;
      }
      order.push_back(top);
      stack.pop_back();
    }
  }
  return order;
}

// Rows of a matrix with `height` rows by columns, from row `top`, columns `begin` to `end`: packed
// by eight rows, missing ones zero.
void pack(const double* from, int height, int top, int begin, int end, std::vector<double>& to) {
  const int depth = end - begin;
  const int eights = (height - top + 7) / 8;
  to.assign(8 * as_index(eights) * as_index(depth), 0.0);
  for (int g = 0; g < eights; ++g) {
    double* out = &to[8 * as_index(g) * as_index(depth)];
    const int rows = std::min(8, height - top - 8 * g);
    for (int k = begin; k < end; ++k, out += 8)
      for (int r = 0; r < rows; ++r)
        out[r] = from[as_index(k) * as_index(height) + as_index(top + 8 * g + r)];
  }
}

constexpr int block = 64;  // columns that are eliminated together
constexpr int strip = 8;   // of which so many one by one

// Packed rows A, and a lower triangle of `size` rows and `columns` columns with distance `stride`,
// whose first row is that of the first packed one.
struct Update {
  const double* packed;
  int depth, size, columns;
  double* to;
  std::size_t stride;
};

// Subtracts A A^T from the triangle. Every sum is in the order of the packed columns, so that its
// bits do not depend on the processor.
template <class Numbers>
PALPATE_ALWAYS void subtract_by(const Update& by) {
  const auto depth = as_index(by.depth);
  for (int c = 0; c < by.columns; c += 4) {
    const int wide = std::min(4, by.columns - c);
    const int first = c - c % 8;
    const double* b = by.packed + as_index(first) * depth + c % 8;
    for (int r = first; r < by.size; r += 8) {
      Tile tile;
      multiply<Numbers>(by.packed + as_index(r) * depth, b, by.depth, tile);
      double* to = by.to + as_index(c) * by.stride + as_index(r);
      // Below the diagonal all of it, elsewhere what is on it or below.
      const bool whole = wide == 4 && r >= c + 3 && r + 8 <= by.size;
      for (int j = 0; j < wide; ++j, to += by.stride) {
        const int begin = whole ? 0 : std::max(0, c + j - r);
        const int end = whole ? 8 : std::min(8, by.size - r);
        for (int i = begin; i < end; ++i) to[i] -= tile[j][i];
      }
    }
  }
}

#if defined(__x86_64__)
__attribute__((target("avx512f"))) void subtract_by_eight(const Update& by) {
  subtract_by<Eight>(by);
}

__attribute__((target("avx2"))) void subtract_by_four(const Update& by) { subtract_by<Four>(by); }
#endif

void subtract(const Update& by) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) return subtract_by_eight(by);
  if (__builtin_cpu_supports("avx2")) return subtract_by_four(by);
#endif
  subtract_by<Two>(by);
}

// column -= factor * before, from entry `begin` to `end`.
PALPATE_ALWAYS void subtract_scaled(double* column, const double* before, double factor, int begin,
                                    int end) {
  for (int r = begin; r < end; ++r) column[r] -= factor * before[r];
}

PALPATE_WIDEST void subtract_column(double* column, const double* before, double factor, int begin,
                                    int end) {
  subtract_scaled(column, before, factor, begin, end);
}

// The columns of a front and the rows below: x = L^-1 x, and what that takes from those rows.
PALPATE_WIDEST void solve_down(const double* column, int width, int height, double* x) {
  for (int c = 0; c < width; ++c, column += height) {
    const double value = x[c] /= column[c];
    subtract_scaled(x, column, value, c + 1, height);
  }
}

// x = L^-T x for the columns of a front, from those rows. Sums are by eights on any processor.
PALPATE_WIDEST void solve_up(const double* panel, int width, int height, double* x) {
  for (int c = width - 1; c >= 0; --c) {
    const double* column = panel + as_index(c) * as_index(height);
    Eight sums = {};
    int r = c + 1;
    for (; r + 8 <= height; r += 8) {
      Eight factors;
      Eight values;
      __builtin_memcpy(&factors, column + r, sizeof factors);
      __builtin_memcpy(&values, x + r, sizeof values);
      sums += factors * values;
    }
    double rest = 0.0;
    for (; r < height; ++r) rest += column[r] * x[r];
    for (int i = 0; i < 8; ++i) rest += sums[i];
    x[c] = (x[c] - rest) / column[c];
  }
}

}  // namespace

void FrontCholesky::analyse(const SparseMatrix& lower, std::span<const int> first) {
  Graph graph = node_graph(lower, first);
  std::vector<int> order = dissect(graph);
  {
    const Elimination once = eliminate(graph, order);
    std::vector<int> sorted;
    for (const int i : postorder(once.parent)) sorted.push_back(order[as_index(i)]);
    order = std::move(sorted);
  }
  const Elimination tree = eliminate(graph, order);
  const int nodes = static_cast<int>(order.size());
  const auto unknowns = [&](int i) {
    const auto node = as_index(order[as_index(i)]);
    return first[node + 1] - first[node];
  };
  place_.assign(as_index(lower.rows()), 0);
  std::vector<int> at(as_index(nodes) + 1, 0);  // first unknown of every node, in the order
  for (int i = 0; i < nodes; ++i) {
    at[as_index(i) + 1] = at[as_index(i)] + unknowns(i);
    for (int d = 0; d < unknowns(i); ++d)
      place_[as_index(first[as_index(order[as_index(i)])] + d)] = at[as_index(i)] + d;
  }
  // A node joins the front of the one before if that is its only way on and few zeros are added.
  fronts_.clear();
  rows_.clear();
  std::vector<int> front_of(as_index(nodes), -1);
  std::size_t values = 0;
  const auto count = [&](const std::vector<int>& list) {
    int sum = 0;
    for (const int j : list) sum += unknowns(j);
    return sum;
  };
  for (int start = 0; start < nodes;) {
    int end = start;  // the last node of the front
    long zeros = 0;
    while (end + 1 < nodes && tree.parent[as_index(end)] == end + 1) {
      const long width = at[as_index(end) + 1] - at[as_index(start)];
      const long more = count(tree.later[as_index(end) + 1]) + unknowns(end + 1) -
                        count(tree.later[as_index(end)]);
      const long height = width + count(tree.later[as_index(end)]);
      if (more > 0 && zeros + width * more > std::max(64L, (width * height) / 8)) break;
      zeros += width * more;
      ++end;
    }
    Front front;
    front.first = at[as_index(start)];
    front.width = at[as_index(end) + 1] - front.first;
    front.below = count(tree.later[as_index(end)]);
    front.rows = rows_.size();
    front.values = values;
    for (int i = start; i <= end; ++i) front_of[as_index(i)] = static_cast<int>(fronts_.size());
    for (int d = 0; d < front.width; ++d) rows_.push_back(front.first + d);
    for (const int j : tree.later[as_index(end)])
      for (int d = at[as_index(j)]; d < at[as_index(j) + 1]; ++d) rows_.push_back(d);
    values += as_index(front.width) * as_index(front.width + front.below);
    fronts_.push_back(front);
    start = end + 1;
  }
  std::vector<int> front_at(as_index(lower.rows()), -1);
  for (std::size_t f = 0; f < fronts_.size(); ++f)
    for (int d = 0; d < fronts_[f].width; ++d)
      front_at[as_index(fronts_[f].first + d)] = static_cast<int>(f);
  for (Front& front : fronts_)
    if (front.below > 0)
      front.parent = front_at[as_index(rows_[front.rows + as_index(front.width)])];
  values_.assign(values, 0.0);

  // Where every entry of the matrix goes.
  std::vector<std::vector<Entry>> of_front(fronts_.size());
  diagonal_.assign(as_index(lower.rows()), -1);
  for (int column = 0; column < lower.cols(); ++column)
    for (int k = lower.outerIndexPtr()[column]; k < lower.outerIndexPtr()[column + 1]; ++k) {
      const int a = place_[as_index(column)];
      const int b = place_[as_index(lower.innerIndexPtr()[k])];
      if (a == b) diagonal_[as_index(a)] = k;
      const auto f = as_index(front_at[as_index(std::min(a, b))]);
      const Front& front = fronts_[f];
      const auto begin = rows_.begin() + static_cast<std::ptrdiff_t>(front.rows);
      const auto end = begin + front.width + front.below;
      const int row = static_cast<int>(std::lower_bound(begin, end, std::max(a, b)) - begin);
      of_front[f].push_back(
          {k, (std::min(a, b) - front.first) * (front.width + front.below) + row});
    }
  entries_.clear();
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    fronts_[f].entries = entries_.size();
    entries_.insert(entries_.end(), of_front[f].begin(), of_front[f].end());
  }
}

bool FrontCholesky::factor(const SparseMatrix& lower) {
  std::ranges::fill(values_, 0.0);
  // What a front leaves to its parent is a lower triangle by columns of full height. The triangles
  // wait in one stack: in postorder those of a front's children are on top of it.
  std::vector<std::size_t> left(fronts_.size(), 0);  // where each begins
  std::vector<std::vector<int>> children(fronts_.size());
  std::vector<int> local(place_.size(), -1);
  std::vector<int> to;
  std::vector<double> packed;
  std::size_t top = 0;
  const double* matrix = lower.valuePtr();
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    const Front& front = fronts_[f];
    const int width = front.width;
    const int below = front.below;
    const int height = width + below;
    const auto high = as_index(height);
    double* panel = &values_[front.values];
    const std::size_t last = f + 1 < fronts_.size() ? fronts_[f + 1].entries : entries_.size();
    for (std::size_t e = front.entries; e < last; ++e)
      panel[entries_[e].at] += matrix[entries_[e].of_matrix];
    const std::size_t size = as_index(below) * as_index(below);
    if (waiting_.size() < top + size) waiting_.resize(top + size);
    double* rest = waiting_.data() + top;
    for (int j = 0; j < below; ++j)
      std::fill(rest + as_index(j) * as_index(below) + j, rest + as_index(j + 1) * as_index(below),
                0.0);
    const int* rows = &rows_[front.rows];
    for (int r = 0; r < height; ++r) local[as_index(rows[r])] = r;
    for (const int child : children[f]) {
      const Front& from = fronts_[as_index(child)];
      const double* update = waiting_.data() + left[as_index(child)];
      to.resize(as_index(from.below));
      for (int i = 0; i < from.below; ++i)
        to[as_index(i)] = local[as_index(rows_[from.rows + as_index(from.width + i)])];
      for (int j = 0; j < from.below; ++j) {
        const double* column = &update[as_index(j) * as_index(from.below)];
        const int c = to[as_index(j)];
        double* into = c < width ? panel + as_index(c) * high
                                 : rest + as_index(c - width) * as_index(below) - width;
        for (int i = j; i < from.below; ++i) into[to[as_index(i)]] += column[i];
      }
    }
    for (int begin = 0; begin < width; begin += block) {
      StopScope::end_if_stopped();
      const int end = std::min(begin + block, width);
      for (int low = begin; low < end; low += strip) {
        const int next = std::min(low + strip, end);
        for (int c = low; c < next; ++c) {
          double* column = panel + as_index(c) * high;
          for (int k = low; k < c; ++k) {
            const double* before = panel + as_index(k) * high;
            subtract_column(column, before, before[c], c, height);
          }
          const int own = diagonal_[as_index(front.first + c)];
          if (!(column[c] > 1e-14 * std::abs(matrix[own])) || !std::isfinite(column[c]))
            return false;
          const double root = std::sqrt(column[c]);
          const double inverse = 1.0 / root;
          column[c] = root;
          for (int r = c + 1; r < height; ++r) column[r] *= inverse;
        }
        if (next == end) break;
        pack(panel, height, next, low, next, packed);
        subtract({packed.data(), next - low, height - next, end - next,
                  panel + as_index(next) * high + as_index(next), high});
      }
      if (end == width) break;
      pack(panel, height, end, begin, end, packed);
      subtract({packed.data(), end - begin, height - end, width - end,
                panel + as_index(end) * high + as_index(end), high});
    }
    for (int begin = 0; begin < width && below > 0; begin += 2 * block) {
      const int end = std::min(begin + 2 * block, width);
      pack(panel, height, width, begin, end, packed);
      subtract({packed.data(), end - begin, below, below, rest, as_index(below)});
    }
    // The triangle takes the place of those of the children.
    left[f] = children[f].empty() ? top : left[as_index(children[f].front())];
    if (left[f] != top) std::copy(rest, rest + size, waiting_.data() + left[f]);
    top = left[f] + size;
    if (front.parent >= 0) children[as_index(front.parent)].push_back(static_cast<int>(f));
  }
  return true;
}

void FrontCholesky::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  const auto size = place_.size();
  x_.resize(size);
  for (std::size_t i = 0; i < size; ++i) x_[as_index(place_[i])] = b[static_cast<Eigen::Index>(i)];
  const auto gather = [&](const Front& front) {
    const int height = front.width + front.below;
    part_.resize(as_index(height));
    for (int r = 0; r < height; ++r)
      part_[as_index(r)] = x_[as_index(rows_[front.rows + as_index(r)])];
    return height;
  };
  for (const Front& front : fronts_) {
    const int height = gather(front);
    solve_down(&values_[front.values], front.width, height, part_.data());
    for (int r = 0; r < height; ++r)
      x_[as_index(rows_[front.rows + as_index(r)])] = part_[as_index(r)];
  }
  for (std::size_t f = fronts_.size(); f-- > 0;) {
    const Front& front = fronts_[f];
    const int height = gather(front);
    solve_up(&values_[front.values], front.width, height, part_.data());
    std::copy(part_.begin(), part_.begin() + front.width, x_.begin() + front.first);
  }
  x.resize(static_cast<Eigen::Index>(size));
  for (std::size_t i = 0; i < size; ++i) x[static_cast<Eigen::Index>(i)] = x_[as_index(place_[i])];
}

}  // namespace palpate
