// Lanczos on the mass-scaled stiffness, matrix-free.
#include "tissue/stable_step.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace palpate::tissue {

double safe_frequency_squared(const Network& network, std::span<const double> stiffness) {
  std::vector<double> sum(network.rest.size(), 0.0);
  for (std::size_t s = 0; s < network.ends.size(); ++s)
    for (const int node : network.ends[s]) sum[static_cast<std::size_t>(node)] += stiffness[s];
  double bound = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i)
    bound = std::max(bound, 2.0 * sum[i] / network.node_mass[i]);
  return bound;
}

namespace {

// A vector without preferred directions, the same on every machine (a linear congruence).
Vector scattered(Eigen::Index size) {
  Vector vector(size);
  std::uint64_t state = 1;
  for (Eigen::Index i = 0; i < size; ++i) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    vector[i] = static_cast<double>(state >> 11) / 9007199254740992.0 - 0.5;
  }
  return vector;
}

}  // namespace

double largest_frequency_squared(const Network& network, std::span<const double> stiffness,
                                 std::span<const char> held) {
  const Eigen::Index size = 3 * network.nodes();
  Vector scale(size);  // 1 / sqrt(m), 0 where held
  for (Eigen::Index d = 0; d < size; ++d)
    scale[d] = held[static_cast<std::size_t>(d)] != 0
                   ? 0.0
                   : 1.0 / std::sqrt(network.node_mass[static_cast<std::size_t>(d / 3)]);

  std::vector<double> tension(network.ends.size());
  Vector force;
  const auto multiply = [&](const Vector& x) -> Vector {
    const Vector u = scale.cwiseProduct(x);
    elongations(network, Kinematics::linear, u, tension);
    for (std::size_t s = 0; s < tension.size(); ++s) tension[s] *= stiffness[s];
    gather_forces(network, Kinematics::linear, u, tension, force);
    return scale.cwiseProduct(force);
  };

  const double safe = safe_frequency_squared(network, stiffness);
  constexpr Eigen::Index most_steps = 300;
  const Eigen::Index steps = std::min(size, most_steps);
  Eigen::MatrixXd basis(size, steps);
  Vector alpha(steps);
  Vector beta(steps);
  Vector next = scattered(size).cwiseProduct(scale);
  next.normalize();
  for (Eigen::Index k = 0; k < steps; ++k) {
    basis.col(k) = next;
    Vector image = multiply(next);
    alpha[k] = next.dot(image);
    for (int twice = 0; twice < 2; ++twice)
      for (Eigen::Index j = 0; j <= k; ++j) image -= basis.col(j).dot(image) * basis.col(j);
    beta[k] = image.norm();
    const bool last = k + 1 == steps || beta[k] <= 1e-14 * safe;
    if (k % 10 == 9 || last) {
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
      ritz.computeFromTridiagonal(alpha.head(k + 1), beta.head(k));
      const double largest = ritz.eigenvalues()[k];
      const double residual = beta[k] * std::abs(ritz.eigenvectors()(k, k));
      if (residual <= 1e-10 * largest || last) return std::min(safe, largest + residual);
    }
    next = image / beta[k];
  }
  return safe;
}

}  // namespace palpate::tissue
