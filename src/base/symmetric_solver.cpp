// Factors of small matrices, conjugate gradients for up to four right-hand sides of large ones.
#include "base/symmetric_solver.h"

namespace palpate {
namespace {

// Measured on blocks of 8000 to 176 000 nodes: half and twice as many take longer.
constexpr std::size_t group_size = 60;

// The group of every node. A new group begins where the groups before left off, so that few nodes
// are enclosed by others; those that are join a neighbour.
std::vector<int> groups(const BlockMatrix::Neighbours& rows, int& count) {
  const std::size_t nodes = rows.start.size() - 1;
  std::vector<int> group(nodes, -1);
  std::vector<int> border;  // nodes beside finished groups, in the order in which they were met
  std::size_t next = 0;     // of `border`
  std::vector<int> members;
  count = 0;
  for (std::size_t first = 0; first < nodes;) {
    int seed = -1;
    while (next < border.size() && seed < 0)
      if (const int node = border[next++]; group[as_index(node)] < 0) seed = node;
    if (seed < 0) {  // the body's first node, or that of a part of it
      if (group[first] >= 0) {
        ++first;
        continue;
      }
      seed = static_cast<int>(first);
    }
    members.assign(1, seed);
    group[as_index(seed)] = count;
    int beside = -1;
    for (std::size_t m = 0; m < members.size(); ++m) {
      const std::size_t node = as_index(members[m]);
      for (int k = rows.start[node]; k < rows.start[node + 1]; ++k) {
        const int neighbour = rows.each[as_index(k)].node;
        int& of_neighbour = group[as_index(neighbour)];
        if (of_neighbour >= 0 && of_neighbour != count) beside = of_neighbour;
        if (of_neighbour >= 0) continue;
        if (members.size() == group_size) {
          border.push_back(neighbour);
          continue;
        }
        of_neighbour = count;
        members.push_back(neighbour);
      }
    }
    if (members.size() < group_size / 4 && beside >= 0)
      for (const int node : members) group[as_index(node)] = beside;
    else
      ++count;
  }
  return group;
}

}  // namespace

bool CoarseCorrection::prepare(const BlockMatrix& matrix, std::span<const char> held) {
  int count = 0;
  const std::vector<int> group_of = groups(matrix.neighbours(), count);
  const auto group = [&](int node) { return group_of[as_index(node)]; };
  // A group whose nodes are all held in one direction is held in it.
  std::vector<char> groups_held(3 * as_index(count), 1);
  free_.clear();
  unknown_.clear();
  for (std::size_t d = 0; d < held.size(); ++d) {
    if (held[d] != 0) continue;
    free_.push_back(static_cast<int>(d));
    unknown_.push_back(3 * group_of[d / 3] + static_cast<int>(d % 3));
    groups_held[as_index(unknown_.back())] = 0;
  }

  std::vector<std::array<int, 2>> pairs;
  const auto pair = [&](int a, int b) {
    if (a != b) pairs.push_back({std::min(a, b), std::max(a, b)});
  };
  const BlockRows& rows = matrix.rows();
  const auto each = [](const BlockRows& all, std::size_t row, const auto& with) {
    for (int k = all.start[row]; k < all.start[row + 1]; ++k) with(all.column[as_index(k)], k);
  };
  for (std::size_t n = 0; n < group_of.size(); ++n)
    each(rows, n, [&](int other, int) { pair(group_of[n], group(other)); });
  std::vector<std::vector<std::pair<int, Vec3>>> changes(matrix.weights().size());  // by groups
  for (std::size_t v = 0; v < changes.size(); ++v) {
    std::vector<std::pair<int, Vec3>>& own = changes[v];
    each(matrix.shared(), v, [&](int node, int k) {
      Vec3 change = matrix.change(k);
      for (int axis = 0; axis < 3; ++axis)
        if (held[as_index(3 * node + axis)] != 0) change[axis] = 0.0;
      const auto same =
          std::ranges::find_if(own, [&](const auto& entry) { return entry.first == group(node); });
      if (same == own.end())
        own.emplace_back(group(node), change);
      else
        same->second += change;
    });
    for (const auto& [a, unused] : own)
      for (const auto& [b, unused_too] : own) pair(a, b);
  }
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());

  BlockMatrix coarse(count, pairs);
  for (std::size_t n = 0; n < group_of.size(); ++n)
    each(rows, n, [&](int other, int k) {
      BlockMatrix::Block kept = matrix.block(k);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          if (held[3 * n + as_index(i)] != 0 || held[as_index(3 * other + j)] != 0)
            kept(i, j) = 0.0;
      coarse.add(group_of[n], group(other), kept);
      if (other != static_cast<int>(n)) coarse.add(group(other), group_of[n], kept.transpose());
    });
  for (std::size_t v = 0; v < changes.size(); ++v)
    for (const auto& [a, change] : changes[v])
      for (const auto& [b, other] : changes[v])
        coarse.add(a, b, matrix.weights()[v] * change * other.transpose());
  load_.resize(3 * count);
  return factors_.factor(coarse.split(groups_held));
}

void CoarseCorrection::add(const Eigen::VectorXd& r, std::size_t lanes, std::size_t stride,
                           Eigen::VectorXd& z) {
  const auto for_free = [&](const auto& with) {
    for (std::size_t f = 0; f < free_.size(); ++f)
      for (std::size_t l = 0; l < stride; ++l)
        with(stride * as_index(free_[f]) + l, gathered_[stride * as_index(unknown_[f]) + l]);
  };
  gathered_.assign(stride * as_index(load_.size()), 0.0);
  for_free([&](std::size_t i, double& sum) { sum += r[static_cast<Eigen::Index>(i)]; });
  for (std::size_t l = 0; l < lanes; ++l) {
    for (Eigen::Index u = 0; u < load_.size(); ++u) load_[u] = gathered_[stride * as_index(u) + l];
    factors_.solve(load_, moved_);
    for (Eigen::Index u = 0; u < load_.size(); ++u) gathered_[stride * as_index(u) + l] = moved_[u];
  }
  for_free([&](std::size_t i, double moved) { z[static_cast<Eigen::Index>(i)] += moved; });
}

namespace {

// How the squared error of one solution falls. The squared error at an iteration is the sum of all
// later decreases, of which the next ones are known some iterations later.
class Decrease {
 public:
  void add(double decrease) { sums_.push_back(sums_.back() + decrease); }
  // The squared error as it was a window ago, and a bound of the present one; negative at first.
  [[nodiscard]] double before_window() const {
    const std::size_t now = sums_.size() - 1;
    const std::size_t window = 10 + now / 4;  // long enough where convergence halts for a while
    return now < window ? -1.0 : sums_[now] - sums_[now - window];
  }

 private:
  std::vector<double> sums_{0.0};
};

}  // namespace

bool SymmetricSolver::prepare(BlockMatrix matrix, std::vector<char> held) {
  matrix_ = std::move(matrix);
  held_ = std::move(held);
  error_ = 0.0;
  factors_.reset();
  if (static_cast<Eigen::Index>(held_.size()) < large) {
    factors_.emplace();
    return factors_->factor(matrix_.split(held_));
  }
  const Vector diagonal = matrix_.diagonal();
  inverse_diagonal_.setZero(static_cast<Eigen::Index>(held_.size()));
  for (Eigen::Index d = 0; d < diagonal.size(); ++d) {
    if (held_[as_index(d)] != 0) continue;
    if (!(diagonal[d] > 0.0) || !std::isfinite(diagonal[d])) return false;
    inverse_diagonal_[d] = 1.0 / diagonal[d];
  }
  coarse_.emplace();
  return coarse_->prepare(matrix_, held_);
}

bool SymmetricSolver::solve(std::span<const Vector> b, std::span<Vector> x) {
  if (!factors_) {
    for (std::size_t first = 0; first < b.size(); first += block_lanes) {
      const std::size_t count = std::min(block_lanes, b.size() - first);
      if (!iterate(b.subspan(first, count), x.subspan(first, count))) return false;
    }
    return true;
  }
  for (std::size_t k = 0; k < b.size(); ++k) precondition(b[k], x[k]);
  return true;
}

void SymmetricSolver::precondition(const Vector& r, Vector& z) {
  if (!factors_) {
    z = inverse_diagonal_.cwiseProduct(r);
    return coarse_->add(r, 1, 1, z);
  }
  unheld_ = r;
  for (std::size_t d = 0; d < held_.size(); ++d)
    if (held_[d] != 0) unheld_[static_cast<Eigen::Index>(d)] = 0.0;
  factors_->solve(unheld_, z);
}

bool SymmetricSolver::iterate(std::span<const Vector> b, std::span<Vector> x) {
  constexpr auto lanes = static_cast<Eigen::Index>(block_lanes);
  const auto size = static_cast<Eigen::Index>(held_.size());
  using Columns = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, lanes, Eigen::RowMajor>>;
  vectors_.right.setZero(lanes * size);
  vectors_.x.setZero(lanes * size);
  for (std::size_t l = 0; l < b.size(); ++l) {
    const auto lane = static_cast<Eigen::Index>(l);
    for (Eigen::Index d = 0; d < size; ++d) {
      if (held_[as_index(d)] != 0) continue;
      vectors_.right[lanes * d + lane] = b[l][d];
      if (x[l].size() == size) vectors_.x[lanes * d + lane] = x[l][d];
    }
  }
  std::array<Decrease, block_lanes> decreases;
  // Where a degree of freedom is held, `inverse_diagonal_` is 0, so that its direction stays 0.
  // Rounding keeps conjugate gradients from ending after as many iterations as there are unknowns.
  const bool solved = conjugate_gradients<block_lanes>(
      vectors_, tolerance_, as_index(10 * size),
      [&](const Vector& from, Vector& to) { matrix_.multiply_lanes(from, to); },
      [&](const Vector& r, Vector& z) {
        z.resize(r.size());
        for (Eigen::Index d = 0; d < size; ++d)
          z.segment<lanes>(lanes * d) = inverse_diagonal_[d] * r.segment<lanes>(lanes * d);
        coarse_->add(r, b.size(), block_lanes, z);
      },
      [&](std::size_t lane, double decrease, double) {
        decreases[lane].add(decrease);
        return decreases[lane].before_window();
      },
      error_);
  if (!solved) return false;
  for (std::size_t l = 0; l < b.size(); ++l)
    x[l] = Columns(vectors_.x.data(), size, lanes).col(static_cast<Eigen::Index>(l));
  return true;
}

}  // namespace palpate
