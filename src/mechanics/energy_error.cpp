// The mesh's own error in what a body sinks beyond a half-space: docs/theory.md (12).
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/energy_coupling.h"

namespace palpate::mechanics {

using integrate::Vector;

namespace {

// The longest edge over the distance on which the rest varies, up to which the estimate sees what a
// tetrahedron misses.
constexpr double seen_width = 0.45;

}  // namespace

// Zienkiewicz and Zhu 1992: the stress is recovered at the nodes by a linear fit over the
// tetrahedra around them, of one tissue at a time; the error is the energy of the difference.
void EnergyCoupling::find_errors(const contact::Patch& patch, const Vector& interpolated,
                                 int region, const Home& home, BeyondHalfSpace& result) const {
  const Vector& rest = result.rest;
  using Stress = Eigen::Matrix<double, 6, 1>;  // xx yy zz xy xz yz
  const std::size_t count = elements_.size();
  std::vector<Stress> stresses(count);
  std::vector<double> dilations(count);
  std::vector<double> shared(count_around_.size(), 0.0);  // around (node, region)
  std::vector<double> volumes(count_around_.size(), 0.0);
  double whole = 0.0;
  for (std::size_t t = 0; t < count; ++t) {
    const Element& element = elements_[t];
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Index first = 3 * mesh_.tetrahedra[t][k];
      Vec3 moved = rest.segment<3>(first);
      if (mesh_.regions[t] != region) moved += interpolated.segment<3>(first);
      gradient += moved * element.gradients.row(static_cast<Eigen::Index>(k));
    }
    dilations[t] = gradient.trace();
    whole += element.volume;
    for (const int at : around_[t]) {
      shared[as_index(at)] += element.volume * dilations[t];
      volumes[as_index(at)] += element.volume;
    }
    const double shear = tissues_[as_index(mesh_.regions[t])].shear_modulus;
    const double mean = 2.0 / 3.0 * dilations[t];
    const auto deviator = [&](int i, int j) {
      return shear * (gradient(i, j) + gradient(j, i) - (i == j ? mean : 0.0));
    };
    stresses[t] << deviator(0, 0), deviator(1, 1), deviator(2, 2), deviator(0, 1), deviator(0, 2),
        deviator(1, 2);
  }
  const double scale = std::cbrt(whole / static_cast<double>(count));
  std::vector<Eigen::Matrix4d> left(count_around_.size(), Eigen::Matrix4d::Zero());
  std::vector<Eigen::Matrix<double, 4, 6>> right(count_around_.size(),
                                                 Eigen::Matrix<double, 4, 6>::Zero());
  for (std::size_t t = 0; t < count; ++t) {
    const Tissue& tissue = tissues_[as_index(mesh_.regions[t])];
    double pressure = tissue.own_bulk * dilations[t];
    for (const int at : around_[t])
      pressure += 0.25 * tissue.shared_bulk * shared[as_index(at)] / volumes[as_index(at)];
    stresses[t].head<3>().array() += pressure;
    const auto& corners = mesh_.tetrahedra[t];
    Vec3 centre = Vec3::Zero();
    for (const int node : corners) centre += 0.25 * mesh_.nodes[as_index(node)];
    for (std::size_t k = 0; k < 4; ++k) {
      Eigen::Vector4d basis;
      basis << 1.0, (centre - mesh_.nodes[as_index(corners[k])]) / scale;
      left[as_index(around_[t][k])] += basis * basis.transpose();
      right[as_index(around_[t][k])] += basis * stresses[t].transpose();
    }
  }
  std::vector<Stress> nodal(count_around_.size());
  for (std::size_t i = 0; i < nodal.size(); ++i) {
    constexpr int fewest = 8;  // tetrahedra for a linear fit; otherwise their mean
    const double number = left[i](0, 0);
    if (count_around_[i] < fewest) {
      nodal[i] = right[i].row(0).transpose() / number;
      continue;
    }
    const Eigen::Matrix4d ridged = left[i] + 1e-9 * number * Eigen::Matrix4d::Identity();
    nodal[i] = (ridged.ldlt().solve(right[i])).row(0).transpose();
  }
  // Twice the energy of a stress, J per m^3.
  const auto density = [&](std::size_t t, Stress stress) {
    const Tissue& tissue = tissues_[as_index(mesh_.regions[t])];
    const double pressure = stress.head<3>().sum() / 3.0;
    stress.head<3>().array() -= pressure;
    const double shear = (stress.head<3>().squaredNorm() + 2.0 * stress.tail<3>().squaredNorm()) /
                         (2.0 * tissue.shear_modulus);
    return shear + pressure * pressure / (tissue.own_bulk + tissue.shared_bulk);
  };
  result.errors.assign(count, 0.0);
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t q = 0; q < 4; ++q) {  // four points, degree 2
      constexpr double far = 0.13819660112501051;
      Stress difference = -stresses[t];
      for (std::size_t k = 0; k < 4; ++k)
        difference += (k == q ? 1.0 - 3.0 * far : far) * nodal[as_index(around_[t][k])];
      result.errors[t] += 0.25 * elements_[t].volume * density(t, difference);
    }
    result.error += result.errors[t];
  }
  // The rest of the displacement varies over the distance from the contact and, at the contact,
  // over that to the next boundary. Of what wider tetrahedra miss, the estimate sees a part only.
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < mesh_.nodes.size(); ++n)
    if (held_[3 * n + 2] != 0 || home.other[n] != 0)
      nearest = std::min(nearest, (mesh_.nodes[n] - patch.position).norm());
  nearest = std::max(nearest, 0.5 * patch.radius());
  for (std::size_t t = 0; t < count; ++t) {
    const auto node = [&](std::size_t k) -> const Vec3& {
      return mesh_.nodes[as_index(mesh_.tetrahedra[t][k])];
    };
    double longest = 0.0;
    for (const auto& [a, b] : geometry::corner_edges)
      longest = std::max(longest, (node(as_index(a)) - node(as_index(b))).norm());
    const Vec3 centre = 0.25 * (node(0) + node(1) + node(2) + node(3));
    const double ratio = longest / (seen_width * ((centre - patch.position).norm() + nearest));
    const double unseen = std::max(0.0, ratio * ratio - 1.0) * result.errors[t];
    result.doubt += unseen;
    result.errors[t] += unseen;
  }
  // A boundary moved outwards by d lowers the compliance by d times the density of energy there.
  for (const Face& face : home.faces) {
    const std::size_t t = as_index(face.tetrahedron);
    const double change = std::abs(face.cut_off) * density(t, stresses[t]);
    result.doubt += change;
    result.errors[t] += change;
  }
}

// Of a curved triangle, by three points.
double EnergyCoupling::cut_off(const Face& face) const {
  const auto& corners = skin_->surface().triangles[as_index(face.triangle)];
  const auto vertex = [&](std::size_t k) -> const Vec3& {
    return skin_->surface().vertices[as_index(corners[k])];
  };
  const Vec3 twice_area = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) {
    geometry::SurfacePoint at{.triangle = face.triangle, .weights = Vec3::Constant(0.5)};
    at.weights[k] = 0.0;  // the middles of the sides: exact to degree 2
    sum += (skin_->position(at) - skin_->flat_position(at)).dot(twice_area) / 6.0;
  }
  return sum;
}

}  // namespace palpate::mechanics
