// Sums over tetrahedra in index order, so that results do not depend on anything else.
#include "tissue/neo_hookean.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace palpate::tissue {
namespace {

using Eigen::Matrix3d;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

// dP = mu J^(-2/3) (dF - 2/3 (A:dF) (F - I1/3 A) - 2/3 (F:dF) A + I1/3 A dF^T A)
//      + (p + k J) J (A:dF) A - p J A dF^T A,    A = F^-T, p the pressure from all volumes;
// matrices as vectors, column after column.                              docs/theory.md (97)
Matrix9d stress_change(const Matrix3d& f, const Matrix3d& a, double j, double shear, double bulk,
                       double pressure) {
  const double scaled = shear / std::cbrt(j * j);
  const double first = f.squaredNorm();  // I1
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> of_f(f.data());
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> of_a(a.data());
  Matrix9d change = scaled * Matrix9d::Identity();
  change -= (2.0 / 3.0 * scaled) * (of_f * of_a.transpose() + of_a * of_f.transpose());
  change += (2.0 / 9.0 * scaled * first + (pressure + bulk * j) * j) * of_a * of_a.transpose();
  const double across = scaled * first / 3.0 - pressure * j;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l)  // A dF^T A has the part A_il A_kj of dF_kl in its entry i, j
      for (int i = 0; i < 3; ++i)
        for (int m = 0; m < 3; ++m) change(i + 3 * m, k + 3 * l) += across * a(i, l) * a(k, m);
  return change;
}

void leave_out_negative(Matrix9d& change) {
  const Eigen::SelfAdjointEigenSolver<Matrix9d> modes(change);
  if (modes.eigenvalues()[0] >= 0.0) return;
  change = modes.eigenvectors() * modes.eigenvalues().cwiseMax(0.0).asDiagonal() *
           modes.eigenvectors().transpose();
}

}  // namespace

NeoHookean::NeoHookean(const geometry::TetMesh& mesh, std::span<const Isotropic> tissues,
                       double own_share)
    : freedoms_(3 * static_cast<Eigen::Index>(mesh.nodes.size())) {
  std::map<std::pair<int, int>, int> number;  // of node and region: index into averages_
  tetrahedra_.reserve(mesh.tetrahedra.size());
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) {
    Tetrahedron one;
    one.corners = mesh.tetrahedra[as_index(t)];
    one.volume = geometry::signed_volume(mesh, t);
    Matrix3d edges;
    for (int i = 0; i < 3; ++i)
      edges.col(i) =
          mesh.nodes[as_index(one.corners[as_index(i) + 1])] - mesh.nodes[as_index(one.corners[0])];
    one.gradients.bottomRows<3>() = edges.inverse();
    one.gradients.row(0) = -one.gradients.bottomRows<3>().colwise().sum();
    const Isotropic& tissue = tissues[as_index(mesh.region(t))];
    const double bulk = bulk_modulus(tissue);
    one.shear = shear_modulus(tissue);
    one.own_bulk = std::min(bulk, own_share * one.shear);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto [found, added] =
          number.try_emplace({one.corners[i], mesh.region(t)}, static_cast<int>(averages_.size()));
      if (added) averages_.push_back({.bulk = bulk - one.own_bulk});
      one.averages[i] = found->second;
      averages_[as_index(found->second)].volume += one.volume;
    }
    tetrahedra_.push_back(one);
  }
}

double NeoHookean::energy(const Vector& displacement) {
  double sum = 0.0;
  for (Average& average : averages_) average.ratio = 0.0;
  for (Tetrahedron& one : tetrahedra_) {
    one.stretch.setIdentity();
    for (int i = 0; i < 4; ++i)
      one.stretch += displacement.segment<3>(3 * one.corners[as_index(i)]) * one.gradients.row(i);
    one.ratio = one.stretch.determinant();
    if (!(one.ratio > 0.0)) return std::numeric_limits<double>::infinity();
    one.inverse = one.stretch.inverse().transpose();
    const double invariant = one.stretch.squaredNorm() / std::cbrt(one.ratio * one.ratio);
    sum += 0.5 * one.volume *
           (one.shear * (invariant - 3.0) + one.own_bulk * (one.ratio - 1.0) * (one.ratio - 1.0));
    for (const int average : one.averages)
      averages_[as_index(average)].ratio +=
          one.volume / averages_[as_index(average)].volume * one.ratio;
  }
  for (const Average& average : averages_)
    sum += 0.125 * average.volume * average.bulk * (average.ratio - 1.0) * (average.ratio - 1.0);
  return sum;
}

// Of its own volume and, by quarters, of those around its corners, Pa.
double NeoHookean::pressure(const Tetrahedron& one) const {
  double pressure = one.own_bulk * (one.ratio - 1.0);
  for (const int average : one.averages)
    pressure +=
        0.25 * averages_[as_index(average)].bulk * (averages_[as_index(average)].ratio - 1.0);
  return pressure;
}

void NeoHookean::force(Vector& force) const {
  force.setZero(freedoms_);
  for (const Tetrahedron& one : tetrahedra_) {
    const double scaled = one.shear / std::cbrt(one.ratio * one.ratio);
    const Matrix3d stress = scaled * (one.stretch - one.stretch.squaredNorm() / 3.0 * one.inverse) +
                            pressure(one) * one.ratio * one.inverse;
    for (int i = 0; i < 4; ++i)
      force.segment<3>(3 * one.corners[as_index(i)]) +=
          one.volume * stress * one.gradients.row(i).transpose();
  }
}

SplitMatrix NeoHookean::stiffness(std::span<const char> held, bool bounded) const {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<Eigen::Triplet<double>> shared;
  entries.reserve(144 * tetrahedra_.size() + held.size());
  shared.reserve(48 * tetrahedra_.size());
  for (const Tetrahedron& one : tetrahedra_) {
    Matrix9d change = one.volume * stress_change(one.stretch, one.inverse, one.ratio, one.shear,
                                                 one.own_bulk, pressure(one));
    if (bounded) leave_out_negative(change);
    // dF = sum of u_i g_i^T
    Eigen::Matrix<double, 9, 12> strain = Eigen::Matrix<double, 9, 12>::Zero();
    for (int i = 0; i < 4; ++i)
      for (int l = 0; l < 3; ++l)
        for (int k = 0; k < 3; ++k) strain(k + 3 * l, 3 * i + k) = one.gradients(i, l);
    const Eigen::Matrix<double, 12, 12> block = strain.transpose() * change * strain;
    const Eigen::Matrix<double, 4, 3> grown =
        one.ratio * one.gradients * one.inverse.transpose();  // dJ / du
    for (int i = 0; i < 12; ++i) {
      const int row = 3 * one.corners[as_index(i / 3)] + i % 3;
      if (held[as_index(row)] != 0) continue;
      for (int j = 0; j < 12; ++j) {
        const int column = 3 * one.corners[as_index(j / 3)] + j % 3;
        if (held[as_index(column)] == 0) entries.emplace_back(row, column, block(i, j));
      }
      for (const int average : one.averages)
        shared.emplace_back(average, row,
                            one.volume / averages_[as_index(average)].volume * grown(i / 3, i % 3));
    }
  }
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] != 0) entries.emplace_back(static_cast<int>(d), static_cast<int>(d), 1.0);
  SplitMatrix matrix;
  matrix.local.resize(freedoms_, freedoms_);
  matrix.local.setFromTriplets(entries.begin(), entries.end());
  matrix.weights.resize(static_cast<Eigen::Index>(averages_.size()));
  for (std::size_t v = 0; v < averages_.size(); ++v)
    matrix.weights[static_cast<Eigen::Index>(v)] = 0.25 * averages_[v].volume * averages_[v].bulk;
  matrix.shared.resize(matrix.weights.size(), freedoms_);
  matrix.shared.setFromTriplets(shared.begin(), shared.end());
  return matrix;
}

}  // namespace palpate::tissue
