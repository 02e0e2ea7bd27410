// Lanczos iterations for the mass-scaled stiffness without an assembled matrix.
#include "tissue/stable_step.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "tissue/springs.h"

namespace palpate::tissue {

namespace {

using SpringRange = std::span<const int>;

// The nodes of some springs, each once.
std::vector<int> nodes_of(const Network& network, SpringRange springs) {
  std::vector<int> nodes;
  for (const int spring : springs)
    for (const int node : network.ends[as_index(spring)]) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
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
    const ElementPulls pulls = element_pulls(network, six, network.direction);
    const Eigen::Matrix<double, 12, 6> forces = pulls.along * six.stiffness;
    for (Eigen::Index i = 0; i < 4; ++i)
      for (Eigen::Index j = 0; j < 4; ++j)
        add(pulls.corners[as_index(i)],
            (forces.middleRows<3>(3 * i) * pulls.along.middleRows<3>(3 * j).transpose()).norm());
  }
  for (const SharedVolume& volume : network.volumes) {
    const std::vector<int> nodes = nodes_of(network, volume.springs);
    std::vector<Vec3> gradients(nodes.size(), Vec3::Zero());  // of the volume, 1/m
    for (std::size_t k = 0; k < volume.springs.size(); ++k) {
      const auto spring = as_index(volume.springs[k]);
      const Vec3 pull = volume.dilation[k] * network.direction[spring];
      for (std::size_t end = 0; end < 2; ++end) {
        const auto node = std::lower_bound(nodes.begin(), nodes.end(), network.ends[spring][end]);
        Vec3& gradient = gradients[as_index(node - nodes.begin())];
        gradient += end == 0 ? Vec3(-pull) : pull;
      }
    }
    double all = 0.0;
    for (const Vec3& gradient : gradients) all += gradient.norm();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      add(nodes[k], std::abs(volume.stiffness) * gradients[k].norm() * all);
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

// The largest eigenvalue of a symmetric tridiagonal matrix with this diagonal and these positive
// numbers beside it, and the last component of its unit eigenvector.
struct LargestPair {
  double value = 0.0;
  double last = 1.0;
};
LargestPair largest_pair(const std::vector<double>& alpha, const std::vector<double>& beta) {
  const std::size_t size = alpha.size();
  // Above all eigenvalues exactly if all pivots of `value` minus the matrix are positive.
  const auto above = [&](double value) {
    double pivot = value - alpha[0];
    for (std::size_t i = 1; i < size && pivot > 0.0; ++i)
      pivot = value - alpha[i] - beta[i - 1] * beta[i - 1] / pivot;
    return pivot > 0.0;
  };
  double low = *std::max_element(alpha.begin(), alpha.end());
  double high = low;
  for (std::size_t i = 0; i < size; ++i)
    high = std::max(high, alpha[i] + (i > 0 ? beta[i - 1] : 0.0) + (i + 1 < size ? beta[i] : 0.0));
  while (high - low > 1e-14 * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (above(middle) ? high : low) = middle;
  }
  LargestPair pair{.value = high};
  // The eigenvector from where it is largest, upwards and downwards by factors of either end's
  // elimination: a recurrence from one end alone would lose small components to rounding.
  //                                       twisted factors, Dhillon and Parlett 2004
  std::vector<double> from_top(size);
  std::vector<double> from_bottom(size);
  for (std::size_t i = 0; i < size; ++i)
    from_top[i] = high - alpha[i] - (i > 0 ? beta[i - 1] * beta[i - 1] / from_top[i - 1] : 0.0);
  for (std::size_t i = size; i-- > 0;)
    from_bottom[i] =
        high - alpha[i] - (i + 1 < size ? beta[i] * beta[i] / from_bottom[i + 1] : 0.0);
  std::size_t twist = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size; ++i)
    if (const double gap = std::abs(from_top[i] + from_bottom[i] - (high - alpha[i]));
        gap < least) {
      least = gap;
      twist = i;
    }
  double squares = 1.0;
  double component = 1.0;
  for (std::size_t i = twist; i-- > 0;) {
    component *= beta[i] / from_top[i];
    squares += component * component;
  }
  component = 1.0;
  for (std::size_t i = twist; i + 1 < size; ++i) {
    component *= beta[i] / from_bottom[i + 1];
    squares += component * component;
  }
  pair.last = component / std::sqrt(squares);
  return pair;
}

}  // namespace

// Without reorthogonalisation: rounding makes Lanczos find an eigenvalue several times, but none
// above the largest.                                                               Paige 1980
double largest_frequency_squared(const Network& network, std::span<const char> held) {
  const Eigen::Index size = 3 * network.nodes();
  Vector scale(size);  // 1 / sqrt(m), 0 where held
  for (Eigen::Index d = 0; d < size; ++d)
    scale[d] = held[as_index(d)] != 0 ? 0.0 : 1.0 / std::sqrt(network.node_mass[as_index(d / 3)]);

  const BlockMatrix stiffness = stiffness_matrix(network);
  const double safe = safe_frequency_squared(network);
  constexpr std::size_t most_steps = 1000;
  // Relative error of the eigenvalue; the step's is half of it. On large bodies the last digits
  // take most of the iterations.
  constexpr Eigen::Index large = 6000;
  const double enough = size < large ? 1e-6 : 1e-4;
  std::vector<double> alpha;
  std::vector<double> beta;
  Vector before;
  Vector scaled;
  Vector image;
  Vector next = scattered(size).cwiseProduct(scale);
  next.normalize();
  for (std::size_t k = 0; k < most_steps; ++k) {
    scaled = scale.cwiseProduct(next);
    stiffness.multiply(scaled, image);
    image = scale.cwiseProduct(image);
    if (k > 0) image -= beta.back() * before;
    alpha.push_back(next.dot(image));
    image -= alpha.back() * next;
    beta.push_back(image.norm());
    const bool last = beta.back() <= 1e-14 * safe;
    if (k % 5 == 4 || last) {
      const LargestPair ritz = largest_pair(alpha, beta);
      const double residual = beta.back() * ritz.last;
      if (residual <= enough * ritz.value || last) return std::min(safe, ritz.value + residual);
    }
    before = next;
    next = image / beta.back();
  }
  return safe;
}

}  // namespace palpate::tissue
