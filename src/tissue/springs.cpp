// Loops over springs in index order: the sums that reach files have one order.
#include "tissue/springs.h"

#include <algorithm>
#include <cmath>

namespace palpate::tissue {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

Vec3 at(const Vector& vector, int node) { return vector.segment<3>(3 * node); }

// The vector from the first end to the second, deformed.
Vec3 span_of(const Network& network, const Vector& displacement, std::size_t s) {
  const auto [a, b] = network.ends[s];
  return network.rest[index(b)] - network.rest[index(a)] + at(displacement, b) -
         at(displacement, a);
}

Vec3 direction_of(const Network& network, Kinematics kinematics, const Vector& displacement,
                  std::size_t s) {
  if (kinematics == Kinematics::linear) return network.direction[s];
  const Vec3 span = span_of(network, displacement, s);
  return span / std::sqrt(span.squaredNorm());
}

}  // namespace

void elongations(const Network& network, Kinematics kinematics, const Vector& displacement,
                 std::span<double> elongation) {
  for (std::size_t s = 0; s < network.ends.size(); ++s) {
    const auto [a, b] = network.ends[s];
    if (kinematics == Kinematics::linear) {
      elongation[s] = network.direction[s].dot(at(displacement, b) - at(displacement, a));
    } else {
      // |r| - l from the difference of squares, which does not cancel for small displacements:
      // (|r|^2 - l^2) / (|r| + l) with |r|^2 - l^2 = d . (2 l n + d)
      const Vec3 change = at(displacement, b) - at(displacement, a);
      const double rest = network.rest_length[s];
      const double squares = change.dot(2.0 * rest * network.direction[s] + change);
      elongation[s] = squares / (std::sqrt(rest * rest + squares) + rest);
    }
  }
}

void gather_forces(const Network& network, Kinematics kinematics, const Vector& displacement,
                   std::span<const double> tension, Vector& force) {
  force.setZero(3 * network.nodes());
  for (std::size_t s = 0; s < network.ends.size(); ++s) {
    const auto [a, b] = network.ends[s];
    const Vec3 pull = tension[s] * direction_of(network, kinematics, displacement, s);
    force.segment<3>(3 * a) -= pull;
    force.segment<3>(3 * b) += pull;
  }
}

void elongation_rates(const Network& network, Kinematics kinematics, const Vector& displacement,
                      const Vector& velocity, std::span<double> rate) {
  for (std::size_t s = 0; s < network.ends.size(); ++s) {
    const auto [a, b] = network.ends[s];
    rate[s] =
        direction_of(network, kinematics, displacement, s).dot(at(velocity, b) - at(velocity, a));
  }
}

SparseMatrix tangent(const Network& network, Kinematics kinematics, const Vector& displacement,
                     std::span<const double> slope, std::span<const double> tension,
                     std::span<const char> held) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(36 * network.ends.size() + held.size());
  const auto add = [&](int row, int column, double value) {
    if (held[index(row)] == 0 && held[index(column)] == 0) entries.emplace_back(row, column, value);
  };
  for (std::size_t s = 0; s < network.ends.size(); ++s) {
    const auto [a, b] = network.ends[s];
    const Vec3 n = direction_of(network, kinematics, displacement, s);
    // d(tension n)/dr = slope n n^T + tension / |r| (I - n n^T)
    double across = 0.0;
    if (kinematics == Kinematics::nonlinear) {
      const Vec3 span = span_of(network, displacement, s);
      across = std::max(0.0, tension[s]) / std::sqrt(span.squaredNorm());
    }
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double value = (slope[s] - across) * n[i] * n[j] + (i == j ? across : 0.0);
        add(3 * a + i, 3 * a + j, value);
        add(3 * b + i, 3 * b + j, value);
        add(3 * a + i, 3 * b + j, -value);
        add(3 * b + i, 3 * a + j, -value);
      }
    }
  }
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] != 0) entries.emplace_back(static_cast<int>(d), static_cast<int>(d), 1.0);
  SparseMatrix matrix(3 * network.nodes(), 3 * network.nodes());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

bool inverted(const geometry::TetMesh& mesh, const Vector& displacement) {
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    const auto place = [&](int node) -> Vec3 {
      return mesh.nodes[index(node)] + at(displacement, node);
    };
    const Vec3 origin = place(a);
    if ((place(b) - origin).cross(place(c) - origin).dot(place(d) - origin) <= 0.0) return true;
  }
  return false;
}

}  // namespace palpate::tissue
