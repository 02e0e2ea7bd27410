// Equilibrium of several contacts that deform each other's tissue: their indentation depths.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "contact/layer.h"

namespace palpate::contact {

// Force of a contact as a function of its depth, 0 for h <= 0: either
//   coefficient * h^(3/2)                                               docs/theory.md [hertz]
// or the force of a flat layer times `share`; both times `part`, which is below 1 where several
// contacts share one place, and is the factor [deep] in a deep press.
struct PointLaw {
  double coefficient = 0.0;  // N/m^(3/2)
  const LayerContact* layer =
      nullptr;  // replaces the other force if not null; must outlive the law
  double share = 1.0;
  double part = 1.0;

  [[nodiscard]] double force(double depth) const;      // N
  [[nodiscard]] double stiffness(double depth) const;  // dF/dh, N/m
  [[nodiscard]] double last_depth() const;             // m, the greatest valid depth
};

// The depth h >= 0 (m) with h + compliance * F(h) = approach (m). `compliance` (m/N) is negative if
// the body is stiffer than the half-space that the law assumes. Empty if there is no solution, or
// only one beyond last_depth().                      docs/theory.md [one_contact]
[[nodiscard]] std::optional<double> penetration(const PointLaw& law, double approach,
                                                double compliance);

// The depths h_i (m) with h_i + sum_j C_ij F_j(h_j) = approach_i where h_i > 0; h_i = 0 where the
// left side would exceed the approach. `compliance` is n x n, m/N; `depths` is a first guess and
// receives the solution. Returns false if there is none.     docs/theory.md [contacts]
[[nodiscard]] bool balance(std::span<const PointLaw> laws, std::span<const double> approaches,
                           const Eigen::Ref<const Eigen::MatrixXd>& compliance,
                           std::span<double> depths);

// Computes the forces f >= 0 (N) with gaps g = gap + compliance f >= 0 (m), one of the two being
// zero at every point. `compliance` is n x n, m/N, symmetric and positive definite, so that the
// solution is unique. `pressed` is a first guess of the points in contact and receives the points
// that are; `force` receives f. Returns false if the compliance is not positive definite.
//                                                                     docs/theory.md [unilateral]
// Block principal pivoting: all points with the wrong sign change their state at once, or one at a
// time when their number no longer falls, which terminates (Judice and Pires 1994, Computers &
// Operations Research 21, 587; Murty 1974, Opsearch 11, 38).
[[nodiscard]] bool press_apart(const Eigen::MatrixXd& compliance, const Eigen::VectorXd& gap,
                               std::vector<char>& pressed, Eigen::VectorXd& force);

}  // namespace palpate::contact
