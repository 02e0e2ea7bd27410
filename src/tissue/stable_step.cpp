// Lanczos iterations for the mass-scaled stiffness without an assembled matrix.
#include "tissue/stable_step.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace palpate::tissue {

namespace {

using Springs = std::span<const int>;

// The nodes of some springs, each once.
std::vector<int> nodes_of(const Network& network, Springs springs) {
  std::vector<int> nodes;
  for (const int spring : springs)
    for (const int node : network.ends[as_index(spring)]) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// The elongation of each spring per displacement of a node: 3 x springs, one column per spring.
Eigen::Matrix3Xd lengthening(const Network& network, Springs springs, int node) {
  Eigen::Matrix3Xd columns = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(springs.size()));
  for (std::size_t k = 0; k < springs.size(); ++k) {
    const auto spring = as_index(springs[k]);
    const auto& [a, b] = network.ends[spring];
    if (node == b) columns.col(static_cast<Eigen::Index>(k)) = network.direction[spring];
    if (node == a) columns.col(static_cast<Eigen::Index>(k)) = -network.direction[spring];
  }
  return columns;
}

}  // namespace

double safe_frequency_squared(const Network& network) {
  // u.K u <= sum_i |u_i|^2 sum_j |K_ij| for the 3 x 3 blocks K_ij of each symmetric part of K. With
  // elongations the bound would be poor: in flat tetrahedra their stiffness is far above the K_ij.
  std::vector<double> sum(network.rest.size(), 0.0);
  const auto add = [&](int node, double sizes) { sum[as_index(node)] += sizes; };
  for (std::size_t s = 0; s < network.ends.size(); ++s)
    for (const int node : network.ends[s]) add(node, 2.0 * network.stiffness[s]);
  for (const CoupledSprings& six : network.coupled) {
    const std::vector<int> corners = nodes_of(network, six.springs);
    for (const int i : corners)
      for (const int j : corners)
        add(i, (lengthening(network, six.springs, i) * six.stiffness *
                lengthening(network, six.springs, j).transpose())
                   .norm());
  }
  for (const SharedVolume& volume : network.volumes) {
    const Eigen::Map<const Vector> dilation(volume.dilation.data(),
                                            static_cast<Eigen::Index>(volume.dilation.size()));
    const std::vector<int> nodes = nodes_of(network, volume.springs);
    std::vector<double> size;  // of the volume's gradient at each node, 1/m
    double all = 0.0;
    for (const int node : nodes) {
      size.push_back((lengthening(network, volume.springs, node) * dilation).norm());
      all += size.back();
    }
    for (std::size_t k = 0; k < nodes.size(); ++k)
      add(nodes[k], std::abs(volume.stiffness) * size[k] * all);
  }
  double bound = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i)
    bound = std::max(bound, sum[i] / network.node_mass[i]);
  return bound;
}

namespace {

// A vector without preferred directions (a linear congruence), the same on every machine.
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

double largest_frequency_squared(const Network& network, std::span<const char> held) {
  const Eigen::Index size = 3 * network.nodes();
  Vector scale(size);  // 1 / sqrt(m), 0 where held
  for (Eigen::Index d = 0; d < size; ++d)
    scale[d] = held[as_index(d)] != 0 ? 0.0 : 1.0 / std::sqrt(network.node_mass[as_index(d / 3)]);

  std::vector<double> elongation(network.ends.size());
  std::vector<double> tension(network.ends.size());
  Vector force;
  const auto multiply = [&](const Vector& x) -> Vector {
    const Vector u = scale.cwiseProduct(x);
    elongations(network, Kinematics::linear, u, elongation);
    tensions(network, elongation, tension);
    gather_forces(network, Kinematics::linear, u, tension, force);
    return scale.cwiseProduct(force);
  };

  const double safe = safe_frequency_squared(network);
  constexpr Eigen::Index most_steps = 300;
  const Eigen::Index steps = std::min(size, most_steps);
  // Every step is made orthogonal to all earlier ones, so large bodies stop sooner; the residual,
  // which is added, shortens their time step by at most half of `enough`.
  constexpr Eigen::Index large = 30000;
  const double enough = size < large ? 1e-10 : 1e-4;
  std::vector<Vector> basis;
  Vector alpha(steps);
  Vector beta(steps);
  Vector next = scattered(size).cwiseProduct(scale);
  next.normalize();
  for (Eigen::Index k = 0; k < steps; ++k) {
    basis.push_back(next);
    Vector image = multiply(next);
    alpha[k] = next.dot(image);
    for (int twice = 0; twice < 2; ++twice)
      for (const Vector& one : basis) image -= one.dot(image) * one;
    beta[k] = image.norm();
    const bool last = k + 1 == steps || beta[k] <= 1e-14 * safe;
    if (k % 10 == 9 || last) {
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
      ritz.computeFromTridiagonal(alpha.head(k + 1), beta.head(k));
      const double largest = ritz.eigenvalues()[k];
      const double residual = beta[k] * std::abs(ritz.eigenvectors()(k, k));
      if (residual <= enough * largest || last) return std::min(safe, largest + residual);
    }
    next = image / beta[k];
  }
  return safe;
}

}  // namespace palpate::tissue
