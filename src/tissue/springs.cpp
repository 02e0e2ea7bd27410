// Loops over springs in index order, because sums that reach files need a fixed order. SpringLoop
// does the same for a few springs at a time.
#include "tissue/springs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace palpate::tissue {
namespace {

Vec3 at(const Vector& vector, int node) { return vector.segment<3>(3 * node); }

// The present span of a spring, for kinematics other than linear.
struct Stretched {
  Vec3 span;          // m, from the first end to the second
  double elongation;  // m
  double per_length;  // 1/m: direction = per_length * span
};

// |r|^2 - l^2 = d . (2 r_0 + d) does not cancel for a small change d of the span r, which is r_0 at
// rest. With one division, 1 / ((|r| + l) |r|):                       docs/theory.md [elongation]
//   nonlinear  e = (|r|^2 - l^2) / (|r| + l),  n = r / |r|
//   squared    e = (|r|^2 - l^2) / (2 l),      n = r / l
// Inlined, because returning vectors through memory took five times as long.
[[gnu::always_inline]] inline Stretched stretched(const Network& network, Kinematics kinematics,
                                                  const Vector& displacement, std::size_t s) {
  const auto [a, b] = network.ends[s];
  const Vec3 change = at(displacement, b) - at(displacement, a);
  const Vec3 at_rest = network.rest[as_index(b)] - network.rest[as_index(a)];
  const double rest = network.rest_length[s];
  const double squares = change.dot(2.0 * at_rest + change);
  if (kinematics == Kinematics::squared) {
    const double inverse = 1.0 / rest;
    return {at_rest + change, 0.5 * squares * inverse, inverse};
  }
  const double length = std::sqrt(rest * rest + squares);
  const double inverse = 1.0 / ((length + rest) * length);
  return {at_rest + change, squares * (length * inverse), (length + rest) * inverse};
}

[[gnu::always_inline]] inline Vec3 direction_of(const Network& network, Kinematics kinematics,
                                                const Vector& displacement, std::size_t s) {
  if (kinematics == Kinematics::linear) return network.direction[s];
  const Stretched now = stretched(network, kinematics, displacement, s);
  return now.per_length * now.span;
}

}  // namespace

void tensions(const Network& network, std::span<const double> elongation,
              std::span<double> tension) {
  for (std::size_t s = 0; s < tension.size(); ++s)
    tension[s] = network.stiffness[s] * elongation[s];
  for (const CoupledSprings& six : network.coupled)
    for (int i = 0; i < 6; ++i) {
      double sum = 0.0;
      for (int j = 0; j < 6; ++j)
        sum += six.stiffness(i, j) * elongation[as_index(six.springs[as_index(j)])];
      tension[as_index(six.springs[as_index(i)])] += sum;
    }
  for (const SharedVolume& volume : network.volumes) {
    double dilation = 0.0;
    for (std::size_t k = 0; k < volume.springs.size(); ++k)
      dilation += volume.dilation[k] * elongation[as_index(volume.springs[k])];
    for (std::size_t k = 0; k < volume.springs.size(); ++k)
      tension[as_index(volume.springs[k])] += volume.stiffness * dilation * volume.dilation[k];
  }
}

void directions(const Network& network, Kinematics kinematics, const Vector& displacement,
                std::span<Vec3> direction) {
  for (std::size_t s = 0; s < direction.size(); ++s)
    direction[s] = direction_of(network, kinematics, displacement, s);
}

void changes_of(const Network& network, const SharedVolume& volume, std::span<const Vec3> direction,
                std::vector<std::pair<int, Vec3>>& changes) {
  changes.clear();
  for (std::size_t k = 0; k < volume.springs.size(); ++k) {
    const std::size_t s = as_index(volume.springs[k]);
    const Vec3 pull = volume.dilation[k] * direction[s];
    changes.emplace_back(network.ends[s][0], -pull);
    changes.emplace_back(network.ends[s][1], pull);
  }
  std::stable_sort(changes.begin(), changes.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::size_t kept = 0;
  for (std::size_t i = 1; i < changes.size(); ++i)
    if (changes[i].first == changes[kept].first)
      changes[kept].second += changes[i].second;
    else
      changes[++kept] = changes[i];
  if (!changes.empty()) changes.resize(kept + 1);
}

ElementPulls element_pulls(const Network& network, const CoupledSprings& six,
                           std::span<const Vec3> direction) {
  ElementPulls pulls;
  Eigen::Index found = 0;
  for (Eigen::Index s = 0; s < 6; ++s) {
    const auto spring = as_index(six.springs[as_index(s)]);
    for (std::size_t end = 0; end < 2; ++end) {
      const int node = network.ends[spring][end];
      Eigen::Index c = 0;
      while (c < found && pulls.corners[as_index(c)] != node) ++c;
      if (c == found) pulls.corners[as_index(found++)] = node;
      pulls.along.block<3, 1>(3 * c, s) = end == 0 ? Vec3(-direction[spring]) : direction[spring];
    }
  }
  return pulls;
}

BlockMatrix tangent(const Network& network, Kinematics kinematics, const Vector& displacement,
                    double factor, std::span<const double> tension) {
  BlockMatrix matrix(network.nodes(), network.ends);
  std::vector<Vec3> along(network.ends.size());
  directions(network, kinematics, displacement, along);
  for (std::size_t s = 0; s < network.ends.size(); ++s) {
    const Vec3& n = along[s];
    // d(tension n)/dr = k n n^T + tension / |r| (I - n n^T), or, with n = r / l of squared lengths,
    // k n n^T + tension / l I
    double across = 0.0;
    double stretching = factor * network.stiffness[s];
    if (kinematics == Kinematics::nonlinear) {
      across =
          std::max(0.0, tension[s]) * stretched(network, kinematics, displacement, s).per_length;
      stretching -= across;
    } else if (kinematics == Kinematics::squared) {
      across = std::max(0.0, tension[s]) / network.rest_length[s];
    }
    if (stretching == 0.0 && across == 0.0) continue;
    Eigen::Matrix3d block;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        block(i, j) = stretching * (n[i] * n[j]) + (i == j ? across : 0.0);
    const auto& [a, b] = network.ends[s];
    matrix.add(a, a, block);
    matrix.add(b, b, block);
    matrix.add(a, b, -block);
  }
  for (const CoupledSprings& six : network.coupled) {
    const ElementPulls pulls = element_pulls(network, six, along);
    const Eigen::Matrix<double, 12, 6> forces = factor * (pulls.along * six.stiffness);
    for (Eigen::Index i = 0; i < 4; ++i)
      for (Eigen::Index j = 0; j < 4; ++j)
        matrix.add(pulls.corners[as_index(i)], pulls.corners[as_index(j)],
                   forces.middleRows<3>(3 * i) * pulls.along.middleRows<3>(3 * j).transpose());
  }
  std::vector<std::pair<int, Vec3>> changes;
  for (const SharedVolume& volume : network.volumes) {
    changes_of(network, volume, along, changes);
    matrix.add_shared(changes, factor * volume.stiffness);
  }
  return matrix;
}

BlockMatrix stiffness_matrix(const Network& network) {
  return tangent(network, Kinematics::linear, Vector(), 1.0, {});
}

bool inverted(const geometry::TetMesh& mesh, const Vector& displacement) {
  // The displaced nodes once: a node is a corner of about two dozen tetrahedra.
  std::vector<Vec3> places(mesh.nodes);
  for (std::size_t n = 0; n < places.size(); ++n)
    places[n] += displacement.segment<3>(3 * static_cast<Eigen::Index>(n));
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    const Vec3& origin = places[as_index(a)];
    const Vec3 first = places[as_index(b)] - origin;
    const Vec3 second = places[as_index(c)] - origin;
    if (first.cross(second).dot(places[as_index(d)] - origin) <= 0.0) return true;
  }
  return false;
}

}  // namespace palpate::tissue
