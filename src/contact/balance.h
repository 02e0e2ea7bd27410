// Several contacts that press each other's tissue: which penetrations balance.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace palpate::contact {

// A contact of force F(h) = coefficient * h^(3/2), 0 for h <= 0: every Hertz contact is one.
struct PointLaw {
  double coefficient = 0.0;  // N/m^(3/2)

  [[nodiscard]] double force(double depth) const;      // N
  [[nodiscard]] double stiffness(double depth) const;  // dF/dh, N/m
};

// The penetration h >= 0 with h + compliance * F(h) = approach, in m. `compliance` (m/N) may be
// negative, as on a layer that is stiffer than the half-space in it; nothing where then no
// penetration balances.
[[nodiscard]] std::optional<double> penetration(const PointLaw& law, double approach,
                                                double compliance);

// The penetrations h_i with h_i + sum_j C_ij F_j(h_j) = approach_i wherever h_i > 0; h_i = 0 where
// the left side would be more. `compliance` is n x n, m/N; `depths` holds a first guess and then
// the answer. False where nothing balances.                             docs/theory.md (15)
[[nodiscard]] bool balance(std::span<const PointLaw> laws, std::span<const double> approaches,
                           const Eigen::MatrixXd& compliance, std::span<double> depths);

}  // namespace palpate::contact
