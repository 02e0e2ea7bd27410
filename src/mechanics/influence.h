// The mesh's displacements under unit loads, each computed when first needed and then stored.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "contact/patch.h"
#include "integrate/body.h"
#include "mechanics/pair_table.h"

namespace palpate::mechanics {

class Influence {
 public:
  // Computes the displacement (m) under a load (N), both with one entry per degree of freedom.
  using Respond = std::function<void(const integrate::Vector& load, integrate::Vector& moved)>;

  explicit Influence(Respond respond) : respond_(std::move(respond)) {}

  // The displacement of node `at` along `direction` per newton along `push` on `node`, m/N. Both
  // numbers are 0 or above.
  [[nodiscard]] double between(const Vec3& direction, int at, const Vec3& push, int node,
                               Eigen::Index freedoms) {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      if (push[axis] != 0.0)
        sum += push[axis] * direction.dot(column(3 * node + axis, freedoms).segment<3>(3 * at));
    return sum;
  }

  // The displacement of every degree of freedom (m) under 1 N on the degree of freedom `freedom`.
  [[nodiscard]] const integrate::Vector& column(int freedom, Eigen::Index freedoms) {
    if (known_.empty()) known_.resize(as_index(freedoms));
    integrate::Vector& known = known_[as_index(freedom)];
    if (known.size() == 0) {
      unit_.setZero(freedoms);
      unit_[freedom] = 1.0;
      respond_(unit_, known);
    }
    return known;
  }

  // Computes the columns of all `nodes` of the skin (-1 is skipped), so that loads on the skin
  // allocate and solve nothing until forget(). Returns false, and leaves the columns to be computed
  // when needed, if they would take more than `most` bytes.
  bool ask_all(std::span<const int> nodes, Eigen::Index freedoms, double most) {
    kept.make_room(nodes.size());
    const double each = static_cast<double>(sizeof(double)) * static_cast<double>(freedoms);
    if (3.0 * static_cast<double>(nodes.size()) * each > most) return false;
    for (const int node : nodes)
      for (int axis = 0; node >= 0 && axis < 3; ++axis) (void)column(3 * node + axis, freedoms);
    return true;
  }

  // Writes the displacement (m) under `load` (N) to `sum`; cheap if the load has few entries.
  void to(const integrate::Vector& load, integrate::Vector& sum) {
    sum.setZero(load.size());
    for (Eigen::Index d = 0; d < load.size(); ++d)
      if (load[d] != 0.0) sum += load[d] * column(static_cast<int>(d), load.size());
  }

  // The displacement of node `at` per newton on `node`, m/N: one column per axis of the load.
  [[nodiscard]] Eigen::Matrix3d block(int at, int node, Eigen::Index freedoms) {
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    if (at >= 0 && node >= 0)
      for (int axis = 0; axis < 3; ++axis)
        block.col(axis) = column(3 * node + axis, freedoms).segment<3>(3 * at);
    return block;
  }

  // Drops all stored displacements; call when the stiffness changes.
  void forget() {
    known_.clear();
    kept.forget();
  }

  PairTable kept;  // pairs of vertices of recent contacts

 private:
  Respond respond_;
  integrate::Vector unit_;
  std::vector<integrate::Vector> known_;  // one per degree of freedom; empty: not computed yet
};

}  // namespace palpate::mechanics
