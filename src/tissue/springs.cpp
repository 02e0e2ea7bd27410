// Loops over springs in index order, because sums that reach files need a fixed order. FastSprings
// does the same in lanes and must give the same bits: change both together.
#include "tissue/springs.h"

#include <algorithm>
#include <cmath>

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
// rest. With one division, 1 / ((|r| + l) |r|):                               docs/theory.md (33)
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

void elongations(const Network& network, Kinematics kinematics, const Vector& displacement,
                 std::span<double> elongation) {
  for (std::size_t s = 0; s < network.ends.size(); ++s) {
    const auto [a, b] = network.ends[s];
    if (kinematics == Kinematics::linear) {
      elongation[s] = network.direction[s].dot(at(displacement, b) - at(displacement, a));
    } else {
      elongation[s] = stretched(network, kinematics, displacement, s).elongation;
    }
  }
}

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

double work(const Network& network, std::span<const double> elongation,
            std::span<const double> along) {
  std::vector<double> tension;
  return work(network, elongation, along, tension);
}

double work(const Network& network, std::span<const double> elongation,
            std::span<const double> along, std::vector<double>& tension) {
  tension.resize(elongation.size());
  tensions(network, elongation, tension);
  double sum = 0.0;
  for (std::size_t s = 0; s < tension.size(); ++s) sum += tension[s] * along[s];
  return sum;
}

void gather_forces(const Network& network, Kinematics kinematics, const Vector& displacement,
                   std::span<const double> tension, Vector& force) {
  force.setZero(3 * network.nodes());
  for (std::size_t s = 0; s < network.ends.size(); ++s) {
    const auto [a, b] = network.ends[s];
    Vec3 pull;
    if (kinematics == Kinematics::linear) {
      pull = tension[s] * network.direction[s];
    } else {
      const Stretched now = stretched(network, kinematics, displacement, s);
      pull = tension[s] * now.per_length * now.span;
    }
    force.segment<3>(3 * a) -= pull;
    force.segment<3>(3 * b) += pull;
  }
}

void directions(const Network& network, Kinematics kinematics, const Vector& displacement,
                std::span<Vec3> direction) {
  for (std::size_t s = 0; s < direction.size(); ++s)
    direction[s] = direction_of(network, kinematics, displacement, s);
}

namespace {

// Collects the entries of a matrix between free degrees of freedom.
class Entries {
 public:
  Entries(std::span<const char> held, std::size_t expected) : held_(held) {
    entries_.reserve(expected + held.size());
  }

  // The 3 x 3 block of two springs: the forces on the first one's ends as the second one stretches.
  void add_springs(const std::array<int, 2>& ends, const std::array<int, 2>& others,
                   const Eigen::Matrix3d& block) {
    for (std::size_t p = 0; p < 2; ++p)
      for (std::size_t q = 0; q < 2; ++q) add_block(ends[p], others[q], p == q ? 1.0 : -1.0, block);
  }

  [[nodiscard]] Eigen::SparseMatrix<double> matrix() {
    for (std::size_t d = 0; d < held_.size(); ++d)
      if (held_[d] != 0) entries_.emplace_back(static_cast<int>(d), static_cast<int>(d), 1.0);
    const auto size = static_cast<Eigen::Index>(held_.size());
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    return matrix;
  }

 private:
  void add_block(int row_node, int column_node, double sign, const Eigen::Matrix3d& block) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int row = 3 * row_node + i;
        const int column = 3 * column_node + j;
        if (held_[as_index(row)] == 0 && held_[as_index(column)] == 0)
          entries_.emplace_back(row, column, sign * block(i, j));
      }
  }

  std::span<const char> held_;
  std::vector<Eigen::Triplet<double>> entries_;
};

// Sets `shared`, one row per volume with its change per displacement, and `weights`, its stiffness.
void add_volumes(const Network& network, Kinematics kinematics, const Vector& displacement,
                 double factor, std::span<const char> held, SplitMatrix& matrix) {
  std::vector<Eigen::Triplet<double>> entries;
  matrix.weights.resize(static_cast<Eigen::Index>(network.volumes.size()));
  for (std::size_t v = 0; v < network.volumes.size(); ++v) {
    const SharedVolume& volume = network.volumes[v];
    matrix.weights[static_cast<Eigen::Index>(v)] = factor * volume.stiffness;
    for (std::size_t k = 0; k < volume.springs.size(); ++k) {
      const std::size_t s = as_index(volume.springs[k]);
      const Vec3 pull = volume.dilation[k] * direction_of(network, kinematics, displacement, s);
      for (int i = 0; i < 3; ++i)
        for (std::size_t end = 0; end < 2; ++end) {
          const int freedom = 3 * network.ends[s][end] + i;
          if (held[as_index(freedom)] == 0)
            entries.emplace_back(static_cast<int>(v), freedom, end == 0 ? -pull[i] : pull[i]);
        }
    }
  }
  matrix.shared.resize(matrix.weights.size(), matrix.local.cols());
  matrix.shared.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace

SplitMatrix tangent(const Network& network, Kinematics kinematics, const Vector& displacement,
                    double factor, std::span<const double> tension, std::span<const char> held) {
  Entries entries(held, 36 * network.ends.size() + 324 * network.coupled.size());
  for (std::size_t s = 0; s < network.ends.size(); ++s) {
    const Vec3 n = direction_of(network, kinematics, displacement, s);
    // d(tension n)/dr = k n n^T + tension / |r| (I - n n^T), or, with n = r / l of squared lengths,
    // k n n^T + tension / l I
    double across = 0.0;
    double along = factor * network.stiffness[s];
    if (kinematics == Kinematics::nonlinear) {
      across =
          std::max(0.0, tension[s]) * stretched(network, kinematics, displacement, s).per_length;
      along -= across;
    } else if (kinematics == Kinematics::squared) {
      across = std::max(0.0, tension[s]) / network.rest_length[s];
    }
    if (along == 0.0 && across == 0.0) continue;
    Eigen::Matrix3d block;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) block(i, j) = along * n[i] * n[j] + (i == j ? across : 0.0);
    entries.add_springs(network.ends[s], network.ends[s], block);
  }
  for (const CoupledSprings& six : network.coupled)
    for (std::size_t p = 0; p < 6; ++p)
      for (std::size_t q = 0; q < 6; ++q) {
        const std::size_t first = as_index(six.springs[p]);
        const std::size_t second = as_index(six.springs[q]);
        const double k = factor * six.stiffness(static_cast<int>(p), static_cast<int>(q));
        entries.add_springs(
            network.ends[first], network.ends[second],
            k * direction_of(network, kinematics, displacement, first) *
                direction_of(network, kinematics, displacement, second).transpose());
      }
  SplitMatrix matrix;
  matrix.local = entries.matrix();
  if (!network.volumes.empty())
    add_volumes(network, kinematics, displacement, factor, held, matrix);
  return matrix;
}

SplitMatrix stiffness_matrix(const Network& network, std::span<const char> held) {
  const std::vector<double> none(network.ends.size(), 0.0);
  return tangent(network, Kinematics::linear, Vector::Zero(3 * network.nodes()), 1.0, none, held);
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
