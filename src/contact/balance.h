// Several contacts that press each other's tissue: which penetrations balance.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "contact/layer.h"

namespace palpate::contact {

// How a contact's force grows with its depth, 0 for h <= 0: Hertz's coefficient * h^(3/2), with the
// factor 1 + deep_root sqrt(h) + deep h of a deep press, or that of a flat layer, times a part
// where several contacts share one place.
struct PointLaw {
  double coefficient = 0.0;                                  // N/m^(3/2)
  double deep_root = 0.0, deep = 0.0;                        // 1/sqrt(m), 1/m
  double deepest = std::numeric_limits<double>::infinity();  // m, that the factor is known to
  const LayerContact* layer = nullptr;                       // instead; must outlive the law
  double share = 1.0;
  double part = 1.0;

  [[nodiscard]] double force(double depth) const;      // N
  [[nodiscard]] double stiffness(double depth) const;  // dF/dh, N/m
  [[nodiscard]] double last_depth() const;             // m, that the law knows
};

// The penetration h >= 0 with h + compliance * F(h) = approach, in m. `compliance` (m/N) may be
// negative, as on a body that is stiffer than the half-space in it; nothing where then no
// penetration balances, or only one beyond the law's last depth.
[[nodiscard]] std::optional<double> penetration(const PointLaw& law, double approach,
                                                double compliance);

// The penetrations h_i with h_i + sum_j C_ij F_j(h_j) = approach_i wherever h_i > 0; h_i = 0 where
// the left side would be more. `compliance` is n x n, m/N; `depths` holds a first guess and then
// the answer. False where nothing balances.                             docs/theory.md (15)
[[nodiscard]] bool balance(std::span<const PointLaw> laws, std::span<const double> approaches,
                           const Eigen::Ref<const Eigen::MatrixXd>& compliance,
                           std::span<double> depths);

}  // namespace palpate::contact
