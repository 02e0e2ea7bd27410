// The mesh's answer to unit loads, found when first asked for and kept.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "contact/patch.h"
#include "integrate/body.h"
#include "run/pair_table.h"

namespace palpate::run {

class Influence {
 public:
  // The displacement (m) under a load (N), both one entry a degree of freedom.
  using Respond = std::function<void(const integrate::Vector& load, integrate::Vector& moved)>;

  explicit Influence(Respond respond) : respond_(std::move(respond)) {}

  // The displacement of node `at` along `direction` per newton of a load along `push` that is
  // spread over nodes, m/N. Nodes below 0 neither move nor take load.
  [[nodiscard]] double between(const Vec3& direction, int at, const Vec3& push,
                               std::span<const int> nodes, std::span<const double> shares,
                               Eigen::Index freedoms) {
    if (at < 0) return 0.0;
    double sum = 0.0;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (nodes[k] >= 0) sum += shares[k] * between(direction, at, push, nodes[k], freedoms);
    return sum;
  }

  // The same of a load on one node. Both are 0 or above.
  [[nodiscard]] double between(const Vec3& direction, int at, const Vec3& push, int node,
                               Eigen::Index freedoms) {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      if (push[axis] != 0.0)
        sum += push[axis] * direction.dot(column(3 * node + axis, freedoms).segment<3>(3 * at));
    return sum;
  }

  // The displacement of every degree of freedom under 1 N there, m.
  [[nodiscard]] const integrate::Vector& column(int freedom, Eigen::Index freedoms) {
    if (known_.empty()) known_.resize(static_cast<std::size_t>(freedoms));
    integrate::Vector& known = known_[static_cast<std::size_t>(freedom)];
    if (known.size() == 0) {
      unit_.setZero(freedoms);
      unit_[freedom] = 1.0;
      respond_(unit_, known);
    }
    return known;
  }

  // Asks for all that loads on the skin may want to know; `nodes` are its vertices', -1 left out.
  // From then on nothing is allocated, and nothing solved, until forget(); but where all of it
  // would be more than `most` bytes it is left to be asked for as it is wanted, and false.
  bool ask_all(std::span<const int> nodes, Eigen::Index freedoms, double most) {
    kept.make_room(nodes.size());
    const double each = static_cast<double>(sizeof(double)) * static_cast<double>(freedoms);
    if (3.0 * static_cast<double>(nodes.size()) * each > most) return false;
    for (const int node : nodes)
      for (int axis = 0; node >= 0 && axis < 3; ++axis) (void)column(3 * node + axis, freedoms);
    return true;
  }

  // The displacement under a load that few degrees of freedom carry, m.
  void to(const integrate::Vector& load, integrate::Vector& sum) {
    sum.setZero(load.size());
    for (Eigen::Index d = 0; d < load.size(); ++d)
      if (load[d] != 0.0) sum += load[d] * column(static_cast<int>(d), load.size());
  }

  // How node `at` moves by a newton on `node` along each axis, m/N: one column an axis of the load.
  [[nodiscard]] Eigen::Matrix3d block(int at, int node, Eigen::Index freedoms) {
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    if (at >= 0 && node >= 0)
      for (int axis = 0; axis < 3; ++axis)
        block.col(axis) = column(3 * node + axis, freedoms).segment<3>(3 * at);
    return block;
  }

  // What is answered has changed.
  void forget() {
    known_.clear();
    kept.forget();
  }

  PairTable kept;  // of a single contact's readings

 private:
  Respond respond_;
  integrate::Vector unit_;
  std::vector<integrate::Vector> known_;  // one a degree of freedom; empty: not asked for yet
};

}  // namespace palpate::run
