// A bound by blocks, and the largest eigenvalue of the mass-scaled stiffness.
#include "tissue/stable_step.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/numerics.h"
#include "tissue/springs.h"

namespace palpate::tissue {

double safe_frequency_squared(const Network& network) {
  // u.K u <= sum_i |u_i|^2 sum_j |K_ij| for the 3 x 3 blocks K_ij of each symmetric part of K. With
  // elongations the bound would be poor: in flat tetrahedra their stiffness is far above the K_ij.
  std::vector<double> sum(network.rest.size(), 0.0);
  const auto add = [&](int node, double sizes) { sum[as_index(node)] += sizes; };
  for (std::size_t s = 0; s < network.ends.size(); ++s)
    for (const int node : network.ends[s]) add(node, 2.0 * network.stiffness[s]);
  for (const CoupledSprings& six : network.coupled) {
    const ElementPulls pulls = element_pulls(network, six, network.direction);
    const Eigen::Matrix<double, 12, 6> forces = pulls.along * six.stiffness;
    for (Eigen::Index i = 0; i < 4; ++i)
      for (Eigen::Index j = 0; j < 4; ++j)
        add(pulls.corners[as_index(i)],
            (forces.middleRows<3>(3 * i) * pulls.along.middleRows<3>(3 * j).transpose()).norm());
  }
  std::vector<std::pair<int, Vec3>> changes;
  for (const SharedVolume& volume : network.volumes) {
    changes_of(network, volume, network.direction, changes);
    double all = 0.0;
    for (const auto& [node, change] : changes) all += change.norm();
    for (const auto& [node, change] : changes)
      add(node, std::abs(volume.stiffness) * change.norm() * all);
  }
  double bound = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i)
    bound = std::max(bound, sum[i] / network.node_mass[i]);
  return bound;
}

Vector scattered(Eigen::Index size) {
  Vector vector(size);
  std::uint64_t state = 1;  // of a linear congruential generator
  for (Eigen::Index i = 0; i < size; ++i) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    vector[i] = static_cast<double>(state >> 11) / 9007199254740992.0 - 0.5;
  }
  return vector;
}

double largest_frequency_squared(const Network& network, std::span<const char> held) {
  const Eigen::Index size = 3 * network.nodes();
  Vector scale(size);  // 1 / sqrt(m), 0 where held
  for (Eigen::Index d = 0; d < size; ++d)
    scale[d] = held[as_index(d)] != 0 ? 0.0 : 1.0 / std::sqrt(network.node_mass[as_index(d / 3)]);
  const BlockMatrix stiffness = stiffness_matrix(network);
  Vector force;
  const auto multiply = [&](const Vector& x, Vector& image) {
    stiffness.multiply(scale.cwiseProduct(x), force);
    image = scale.cwiseProduct(force);
  };
  // Relative error of the eigenvalue; the step's is half of it. On large bodies the last digits
  // take most of the iterations.
  constexpr Eigen::Index large = 6000;
  const double enough = size < large ? 1e-6 : 1e-4;
  const EigenPair found = largest_eigenpair(scattered(size).cwiseProduct(scale), enough, multiply);
  return std::min(safe_frequency_squared(network), found.value * (1.0 + enough));
}

}  // namespace palpate::tissue
