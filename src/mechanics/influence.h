// The part's displacements under unit loads, each computed when first needed and then stored.
#pragma once

#include <algorithm>
#include <vector>

#include "base/stop_scope.h"
#include "base/vec3.h"
#include "mechanics/moving_part.h"

namespace palpate::mechanics {

class Influence {
 public:
  // The part must outlive this.
  Influence(MovingPart& part, Response response) : part_(&part), response_(response) {}

  // The displacement of node `at` along `direction` per newton along `push` on `node`, m/N. Both
  // numbers are 0 or above.
  [[nodiscard]] double between(const Vec3& direction, int at, const Vec3& push, int node) {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      if (push[axis] != 0.0)
        sum += push[axis] * direction.dot(column(3 * node + axis).segment<3>(3 * at));
    return sum;
  }

  // The displacement of every degree of freedom (m) under 1 N on the degree of freedom `freedom`.
  // Throws Stopped.
  [[nodiscard]] const integrate::Vector& column(int freedom) {
    if (known_.empty()) known_.resize(as_index(part_->freedoms()));
    integrate::Vector& known = known_[as_index(freedom)];
    if (known.size() == 0) {
      StopScope::end_if_stopped();
      unit_.setZero(part_->freedoms());
      unit_[freedom] = 1.0;
      part_->respond(response_, unit_, known);
    }
    return known;
  }

  // Computes the columns of these degrees of freedom together, which for large bodies in statics
  // takes a quarter of the time; allocates nothing if they are known.
  void ask(const std::vector<int>& freedoms) {
    if (known_.empty()) known_.resize(as_index(part_->freedoms()));
    const auto missing = [&](int freedom) { return known_[as_index(freedom)].size() == 0; };
    if ((response_ != Response::statics && response_ != Response::moving_statics) ||
        std::ranges::none_of(freedoms, missing))
      return;
    std::vector<int> asked;
    std::vector<integrate::Vector> units;
    for (std::size_t i = 0; i < freedoms.size(); ++i) {
      if (missing(freedoms[i])) {
        asked.push_back(freedoms[i]);
        units.emplace_back(integrate::Vector::Zero(part_->freedoms()))[freedoms[i]] = 1.0;
      }
      if (asked.empty() || (asked.size() < block_lanes && i + 1 < freedoms.size())) continue;
      std::vector<integrate::Vector> moved(asked.size());
      part_->respond(response_, units, moved);
      for (std::size_t k = 0; k < asked.size(); ++k)
        known_[as_index(asked[k])] = std::move(moved[k]);
      asked.clear();
      units.clear();
    }
  }

  // Computes the columns of all nodes of the surface, so that loads on the surface allocate and
  // solve nothing until forget(). Columns that would take more than 1 GB together are left to be
  // computed when needed.
  void ask_all() {
    constexpr double most_bytes = 1e9;
    const std::vector<int>& nodes = part_->nodes;
    const double each = sizeof(double) * static_cast<double>(part_->freedoms());
    if (3.0 * static_cast<double>(nodes.size()) * each > most_bytes) return;
    std::vector<int> freedoms;
    for (const int node : nodes)
      for (int axis = 0; node >= 0 && axis < 3; ++axis) freedoms.push_back(3 * node + axis);
    ask(freedoms);
    for (const int freedom : freedoms) (void)column(freedom);
  }

  // Writes the displacement (m) under `load` (N) to `sum`; cheap if the load has few entries.
  void to(const integrate::Vector& load, integrate::Vector& sum) {
    sum.setZero(load.size());
    for (Eigen::Index d = 0; d < load.size(); ++d)
      if (load[d] != 0.0) sum += load[d] * column(static_cast<int>(d));
  }

  // The displacement of node `at` per newton on `node`, m/N: one column per axis of the load.
  [[nodiscard]] Eigen::Matrix3d block(int at, int node) {
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    if (at >= 0 && node >= 0)
      for (int axis = 0; axis < 3; ++axis)
        block.col(axis) = column(3 * node + axis).segment<3>(3 * at);
    return block;
  }

  // Drops all stored displacements; call when the stiffness or the part changes.
  void forget() { known_.clear(); }

 private:
  MovingPart* part_;
  Response response_;
  integrate::Vector unit_;
  std::vector<integrate::Vector> known_;  // one per degree of freedom; empty: not computed yet
};

}  // namespace palpate::mechanics
