// Masses and springs from tetrahedra. Loops over springs run in index order, because sums that
// reach files need a fixed order; SpringLoop does the same for a few springs at a time.
#include "tissue/network.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "base/numerics.h"

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
  std::ranges::stable_sort(changes, [](const auto& a, const auto& b) { return a.first < b.first; });
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

std::vector<double> node_volumes(const geometry::TetMesh& mesh, std::span<const double> weight) {
  std::vector<double> volumes(mesh.nodes.size(), 0.0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const double quarter = 0.25 * geometry::signed_volume(mesh, static_cast<int>(t)) *
                           weight[as_index(mesh.region(static_cast<int>(t)))];
    for (const int node : mesh.tetrahedra[t]) volumes[as_index(node)] += quarter;
  }
  return volumes;
}

Network make_network(const geometry::TetMesh& mesh, std::span<const double> density,
                     std::vector<double> stiffness) {
  Network network;
  network.rest = mesh.nodes;
  network.node_mass = node_volumes(mesh, density);
  network.ends = geometry::edges(mesh);
  network.stiffness = std::move(stiffness);
  for (const auto& [a, b] : network.ends) {
    const Vec3 span = mesh.nodes[as_index(b)] - mesh.nodes[as_index(a)];
    network.rest_length.push_back(span.norm());
    network.direction.emplace_back(span / span.norm());
  }
  return network;
}

namespace {

// Copies the couplings that can load a moving node of the part. Those excluded cannot be strained:
// both ends of their springs are held or outside. If a tetrahedron has a moving corner, all its
// springs are in the part. A volume may be averaged around a node that is in the edge or just
// outside it; some of its springs are then missing, and these do not change their length.
void restrict_couplings(const Network& whole, const std::vector<int>& node_number, Part& part) {
  std::vector<int> number(whole.ends.size(), -1);
  for (std::size_t s = 0; s < part.springs.size(); ++s)
    number[as_index(part.springs[s])] = static_cast<int>(s);
  const auto in_part = [&](int spring) { return number[as_index(spring)]; };
  const auto moves = [&](int spring) {
    const auto& [a, b] = part.network.ends[as_index(spring)];
    return part.edge[as_index(a)] == 0 || part.edge[as_index(b)] == 0;
  };
  for (const CoupledSprings& six : whole.coupled) {
    CoupledSprings kept{.springs = {}, .stiffness = six.stiffness};
    std::ranges::transform(six.springs, kept.springs.begin(), in_part);
    if (std::ranges::all_of(kept.springs, [](int s) { return s >= 0; }))
      part.network.coupled.push_back(kept);
  }
  for (const SharedVolume& volume : whole.volumes) {
    SharedVolume kept{
        .springs = {}, .dilation = {}, .stiffness = volume.stiffness, .volume = volume.volume};
    for (std::size_t k = 0; k < volume.springs.size(); ++k) {
      const int spring = in_part(volume.springs[k]);
      if (spring < 0) continue;
      kept.springs.push_back(spring);
      kept.dilation.push_back(volume.dilation[k]);
    }
    if (kept.springs.size() == volume.springs.size() && volume.node >= 0)
      kept.node = node_number[as_index(volume.node)];
    if (std::ranges::any_of(kept.springs, moves)) part.network.volumes.push_back(std::move(kept));
  }
}

}  // namespace

void reach_around(const Network& whole, std::span<const int> start, int rings, Reach& reach) {
  auto& [inside, moving] = reach;
  inside.assign(whole.rest.size(), 0);
  for (const int node : start) inside[as_index(node)] = 1;
  for (int ring = 0; ring <= rings; ++ring) {
    moving = inside;
    for (const auto& [a, b] : whole.ends) {
      if (moving[as_index(a)] != 0) inside[as_index(b)] = 1;
      if (moving[as_index(b)] != 0) inside[as_index(a)] = 1;
    }
  }
}

bool spans(const Part& part, const Reach& reach) {
  std::size_t next = 0;
  for (std::size_t n = 0; n < reach.inside.size(); ++n) {
    const bool known = next < part.nodes.size() && part.nodes[next] == static_cast<int>(n);
    if (known != (reach.inside[n] != 0)) return false;
    if (known && (part.edge[next++] != 0) != (reach.moving[n] == 0)) return false;
  }
  return true;
}

Part part_around(const Network& whole, std::span<const int> start, int rings) {
  Reach reach;
  reach_around(whole, start, rings, reach);
  const auto& [inside, moving] = reach;
  Part part;
  std::vector<int> number(whole.rest.size(), -1);
  for (std::size_t n = 0; n < inside.size(); ++n) {
    if (inside[n] == 0) continue;
    number[n] = static_cast<int>(part.nodes.size());
    part.nodes.push_back(static_cast<int>(n));
    part.edge.push_back(moving[n] == 0 ? 1 : 0);
    part.network.rest.push_back(whole.rest[n]);
    part.network.node_mass.push_back(whole.node_mass[n]);
  }
  for (std::size_t s = 0; s < whole.ends.size(); ++s) {
    const auto& [a, b] = whole.ends[s];
    const int first = number[as_index(a)];
    const int second = number[as_index(b)];
    if (first < 0 || second < 0) continue;
    part.springs.push_back(static_cast<int>(s));
    part.network.ends.push_back({first, second});
    part.network.rest_length.push_back(whole.rest_length[s]);
    part.network.direction.push_back(whole.direction[s]);
    part.network.stiffness.push_back(whole.stiffness[s]);
  }
  restrict_couplings(whole, number, part);
  return part;
}

Part whole_part(const Network& whole) {
  Part part;
  part.nodes.resize(whole.rest.size());
  std::iota(part.nodes.begin(), part.nodes.end(), 0);
  part.springs.resize(whole.ends.size());
  std::iota(part.springs.begin(), part.springs.end(), 0);
  part.edge.assign(whole.rest.size(), 0);
  part.network = whole;
  return part;
}

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
