// Sums the blocks of tetrahedra and volumes by edges, and orders the edges.
#include "tissue/edge_form.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/index.h"

namespace palpate::tissue {
namespace {

// What is left of terms that cancel, over their size.
constexpr double rounding = 1e-11;

// The sum over a network's parts at one spring.
struct Sum {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();  // minus the block of its ends, N/m
  double size = 0.0;                                // the largest entries of all parts, N/m
  void add(const Eigen::Matrix3d& part) {
    block += part;
    size += part.cwiseAbs().maxCoeff();
  }
};

// Adds the blocks between the corners of a tetrahedron: of a and b with a < b
//   -K_ab = -sum over s at a, t at b of (+-) (+-) C_st d_s d_t^T,  + at the end that s points to.
void add_six(const Network& network, const CoupledSprings& six, std::vector<Sum>& sums) {
  std::array<int, 4> corners{};
  std::array<std::array<std::size_t, 2>, 6> at{};  // corners of each spring
  std::size_t found = 0;
  for (std::size_t s = 0; s < 6; ++s)
    for (std::size_t end = 0; end < 2; ++end) {
      const int node = network.ends[as_index(six.springs[s])][end];
      std::size_t c = 0;
      while (c < found && corners[c] != node) ++c;
      if (c == found) corners[found++] = node;
      at[s][end] = c;
    }
  // The force at each corner per elongation of each spring.
  std::array<std::array<Vec3, 6>, 4> pull;
  for (auto& corner : pull) corner.fill(Vec3::Zero());
  for (std::size_t s = 0; s < 6; ++s) {
    const Vec3& along = network.direction[as_index(six.springs[s])];
    for (std::size_t t = 0; t < 6; ++t) {
      const Vec3 force = six.stiffness(static_cast<int>(s), static_cast<int>(t)) * along;
      pull[at[s][0]][t] -= force;
      pull[at[s][1]][t] += force;
    }
  }
  for (std::size_t s = 0; s < 6; ++s) {
    const auto [a, b] = at[s];
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    for (std::size_t t = 0; t < 6; ++t) {
      const Vec3& along = network.direction[as_index(six.springs[t])];
      if (at[t][0] == b) block += pull[a][t] * along.transpose();
      if (at[t][1] == b) block -= pull[a][t] * along.transpose();
    }
    sums[as_index(six.springs[s])].add(block);
  }
}

std::vector<Sum> blocks_of(const Network& network) {
  std::vector<Sum> sums(network.ends.size());
  for (std::size_t s = 0; s < sums.size(); ++s)
    if (network.stiffness[s] != 0.0)
      sums[s].add(network.stiffness[s] * network.direction[s] * network.direction[s].transpose());
  for (const CoupledSprings& six : network.coupled) add_six(network, six, sums);
  return sums;
}

// How an edge changes the volumes at its ends. An edge between tissues has several.
struct Entry {
  std::size_t spring = 0;
  std::array<std::int32_t, 2> slots{};
  std::array<Vec3, 2> change{Vec3::Zero(), Vec3::Zero()};
  std::array<double, 2> size{};  // of the largest change in the slot
  bool first = true;             // of the edge: has its block
};

class Entries {
 public:
  explicit Entries(const Network& network)
      : network_(network), all_(network.ends.size()), next_(network.ends.size(), -1) {
    for (std::size_t s = 0; s < all_.size(); ++s) all_[s] = {.spring = s, .slots = {none, none}};
    const auto nodes = network.rest.size();
    std::vector<Vec3> slope(nodes, Vec3::Zero());  // d theta / du of every node, m^2
    std::vector<char> taken(nodes, 0);
    weight_.assign(nodes, 0.0);
    for (const SharedVolume& volume : network.volumes) {
      const auto center = as_index(volume.node);
      std::int32_t slot = volume.node;
      if (taken[center] != 0) {
        slot = static_cast<std::int32_t>(weight_.size());
        weight_.push_back(0.0);
      }
      taken[center] = 1;
      weight_[as_index(slot)] = volume.stiffness / (volume.volume * volume.volume);
      add(volume, slot, slope);
    }
    const auto last = static_cast<std::int32_t>(weight_.size());
    weight_.push_back(0.0);
    for (Entry& entry : all_)
      for (std::int32_t& slot : entry.slots)
        if (slot == none) slot = last;
  }

  std::vector<Entry>& all() { return all_; }
  std::vector<double>& weight() { return weight_; }

 private:
  static constexpr std::int32_t none = -1;

  void add(const SharedVolume& volume, std::int32_t slot, std::vector<Vec3>& slope) {
    for (std::size_t k = 0; k < volume.springs.size(); ++k) {
      const auto s = as_index(volume.springs[k]);
      const Vec3 pull = (volume.volume * volume.dilation[k]) * network_.direction[s];
      slope[as_index(network_.ends[s][0])] -= pull;
      slope[as_index(network_.ends[s][1])] += pull;
    }
    double largest = 0.0;
    for (const int s : volume.springs)
      for (const int node : network_.ends[as_index(s)])
        largest = std::max(largest, slope[as_index(node)].squaredNorm());
    largest = std::sqrt(largest);
    for (const int s : volume.springs) {
      const auto& [a, b] = network_.ends[as_index(s)];
      if (a == volume.node) put(as_index(s), 0, slot, slope[as_index(b)], largest);
      if (b == volume.node) put(as_index(s), 1, slot, -slope[as_index(a)], largest);
    }
    for (const int s : volume.springs)
      for (const int node : network_.ends[as_index(s)]) slope[as_index(node)].setZero();
  }

  // In the first entry of the spring that has room at this end.
  void put(std::size_t spring, std::size_t end, std::int32_t slot, const Vec3& change,
           double size) {
    std::size_t at = spring;
    while (all_[at].slots[end] != none) {
      if (next_[at] < 0) {
        next_[at] = static_cast<std::int32_t>(all_.size());
        next_.push_back(-1);
        all_.push_back({.spring = spring, .slots = {none, none}, .first = false});
      }
      at = as_index(next_[at]);
    }
    all_[at].slots[end] = slot;
    all_[at].change[end] = change;
    all_[at].size[end] = size;
  }

  const Network& network_;
  std::vector<Entry> all_;
  std::vector<std::int32_t> next_;  // entry of the same edge, or -1
  std::vector<double> weight_;
};

// The part of a block that is a x.
Vec3 turn_of(const Eigen::Matrix3d& block) {
  return 0.5 *
         Vec3(block(2, 1) - block(1, 2), block(0, 2) - block(2, 0), block(1, 0) - block(0, 1));
}

// Edges that follow each other should not share a node, whose force would have to be stored and
// loaded between them; but they should be near each other in memory. So of sixteen nodes the first
// edges are taken, then the second ones.
void order(const Network& network, std::vector<Entry>& entries) {
  using Key = std::tuple<int, int, int, std::size_t>;
  std::vector<int> count(network.rest.size(), 0);
  std::vector<Key> keys;
  keys.reserve(entries.size());
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const int node = network.ends[entries[e].spring][0];
    keys.emplace_back(node / 16, count[as_index(node)]++, node, e);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Entry> sorted;
  sorted.reserve(entries.size());
  for (const Key& key : keys) sorted.push_back(entries[std::get<3>(key)]);
  entries.swap(sorted);
}

}  // namespace

bool EdgeForm::alike(const EdgeForm& other) const {
  return inner == other.inner && ends == other.ends && slots == other.slots &&
         change == other.change && weight.size() == other.weight.size();
}

bool has_edge_form(const Network& network) {
  return std::ranges::all_of(network.volumes, [](const auto& volume) { return volume.node >= 0; });
}

EdgeForm edge_form(const Network& network) {
  const std::vector<Sum> sums = blocks_of(network);
  Entries entries(network);
  std::vector<Entry> inner;
  std::vector<Entry> outer;
  std::vector<char> several(sums.size(), 0);
  for (const Entry& entry : entries.all())
    if (!entry.first) several[entry.spring] = 1;
  const bool volumes = !network.volumes.empty();
  for (const Entry& entry : entries.all()) {
    const auto& [a, b] = network.ends[entry.spring];
    const Sum& sum = sums[entry.spring];
    const bool own = !volumes || (entry.slots[0] == a && entry.slots[1] == b);
    const bool same = (entry.change[0] - entry.change[1]).norm() <=
                      rounding * std::min(entry.size[0], entry.size[1]);
    const bool straight = turn_of(sum.block).norm() <= rounding * sum.size;
    (own && same && straight && several[entry.spring] == 0 ? inner : outer).push_back(entry);
  }
  order(network, inner);
  order(network, outer);
  EdgeForm form;
  form.inner = inner.size();
  if (volumes) form.weight = std::move(entries.weight());
  const auto put = [](std::vector<double>& to, const Vec3& values) {
    to.insert(to.end(), values.begin(), values.end());
  };
  for (const std::vector<Entry>* edges : {&inner, &outer})
    for (const Entry& entry : *edges) {
      const auto& ends = network.ends[entry.spring];
      form.ends.insert(form.ends.end(), ends.begin(), ends.end());
      const Eigen::Matrix3d block =
          entry.first ? sums[entry.spring].block : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
      const auto mean = [&](int i, int j) { return 0.5 * (block(i, j) + block(j, i)); };
      for (const double value :
           {block(0, 0), mean(0, 1), mean(0, 2), mean(1, 2), block(1, 1), block(2, 2)})
        form.block.push_back(value);
      if (edges == &inner) {
        put(form.change, 0.5 * (entry.change[0] + entry.change[1]));
        continue;
      }
      form.slots.insert(form.slots.end(), entry.slots.begin(), entry.slots.end());
      for (const Vec3& change : entry.change) put(form.change, change);
      put(form.turn, turn_of(block));
    }
  return form;
}

}  // namespace palpate::tissue
