// Conjugate gradients, for one or several right-hand sides in one pass over a matrix.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/index.h"
#include "base/stop_scope.h"

namespace palpate {

// Entry `lane` of number d is at [lanes d + lane].
struct GradientVectors {
  Eigen::VectorXd right;  // b
  Eigen::VectorXd x;      // where iterations start, and the result
  Eigen::VectorXd r, p, image;
};

// Solves A x = b for a symmetric positive definite A. `multiply(x, y)` is y = A x, and
// `precondition(r, z)` is z = C r with a symmetric positive definite C that is near the inverse of
// A. `squared_error(lane, decrease, r.z)` gets by how much the squared error fell in an iteration,
// in the energy norm |x|^2 = x A x, and returns an estimate of it, negative if it has none yet.
// Iterations end where it is below `tolerance`^2 times the squared norm of the solution; `error`
// grows to its root over that norm. Returns false if A is seen not to be positive definite, or
// after `most` iterations.                                              Hestenes and Stiefel 1952
template <std::size_t lanes, class Multiply, class Precondition, class SquaredError>
[[nodiscard]] bool conjugate_gradients(GradientVectors& v, double tolerance, std::size_t most,
                                       const Multiply& multiply, const Precondition& precondition,
                                       const SquaredError& squared_error, double& error) {
  using Lanes = std::array<double, lanes>;
  const auto dot = [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    Lanes sums{};
    for (Eigen::Index i = 0; i < a.size(); i += static_cast<Eigen::Index>(lanes))
      for (std::size_t l = 0; l < lanes; ++l) {
        const Eigen::Index k = i + static_cast<Eigen::Index>(l);
        sums[l] += a[k] * b[k];
      }
    return sums;
  };
  const auto add_scaled = [](const Lanes& factor, const Eigen::VectorXd& a, Eigen::VectorXd& to) {
    for (Eigen::Index i = 0; i < a.size(); i += static_cast<Eigen::Index>(lanes))
      for (std::size_t l = 0; l < lanes; ++l) {
        const Eigen::Index k = i + static_cast<Eigen::Index>(l);
        to[k] += factor[l] * a[k];
      }
  };
  multiply(v.x, v.image);
  v.r = v.right - v.image;
  precondition(v.r, v.p);
  Lanes rest = dot(v.r, v.p);
  std::array<bool, lanes> done{};
  for (std::size_t l = 0; l < lanes; ++l) done[l] = rest[l] == 0.0;
  for (std::size_t i = 0; !std::all_of(done.begin(), done.end(), std::identity{}); ++i) {
    if (i == most) return false;
    StopScope::end_if_stopped();
    multiply(v.p, v.image);
    const Lanes work = dot(v.p, v.image);
    Lanes length{};
    Lanes shrink{};
    for (std::size_t l = 0; l < lanes; ++l) {
      if (done[l]) continue;
      if (!(work[l] > 0.0) || !std::isfinite(work[l])) return false;
      length[l] = rest[l] / work[l];
      shrink[l] = -length[l];
    }
    add_scaled(length, v.p, v.x);
    add_scaled(shrink, v.image, v.r);
    precondition(v.r, v.image);
    const Lanes next = dot(v.r, v.image);
    const Lanes energy = dot(v.right, v.x);  // x A x at the solution
    Lanes turn{};
    for (std::size_t l = 0; l < lanes; ++l) {
      if (done[l]) continue;
      const double squared = squared_error(l, length[l] * rest[l], next[l]);
      done[l] = next[l] == 0.0 ||
                (squared >= 0.0 && squared <= tolerance * tolerance * std::abs(energy[l]));
      if (done[l] && squared > 0.0)
        error = std::max(error, std::sqrt(squared / std::abs(energy[l])));
      turn[l] = next[l] / rest[l];
    }
    add_scaled(turn, v.p, v.image);
    v.p.swap(v.image);
    rest = next;
  }
  return true;
}

}  // namespace palpate
