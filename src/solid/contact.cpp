// Sums over faces and points in their order.
#include "solid/contact.h"

#include <algorithm>
#include <cmath>

namespace palpate::solid {
namespace {

struct FacePoint {
  std::array<double, 6> values{};
  std::array<double, 6> along_1{}, along_2{};  // derivatives
  double weight = 0.0;                         // of the area of 1/2
};

// Values and derivatives of the six functions of a face.
FacePoint face_point(double x, double y, double weight) {
  const std::array<double, 3> l{1.0 - x - y, x, y};
  constexpr std::array<double, 3> dx{-1.0, 1.0, 0.0};
  constexpr std::array<double, 3> dy{-1.0, 0.0, 1.0};
  FacePoint at{.weight = weight};
  for (std::size_t i = 0; i < 3; ++i) {
    at.values[i] = l[i] * (2.0 * l[i] - 1.0);
    at.along_1[i] = (4.0 * l[i] - 1.0) * dx[i];
    at.along_2[i] = (4.0 * l[i] - 1.0) * dy[i];
    const std::size_t j = (i + 1) % 3;
    at.values[3 + i] = 4.0 * l[i] * l[j];
    at.along_1[3 + i] = 4.0 * (l[i] * dx[j] + l[j] * dx[i]);
    at.along_2[3 + i] = 4.0 * (l[i] * dy[j] + l[j] * dy[i]);
  }
  return at;
}

// Radon's rule with seven points, exact to degree five.
const std::array<FacePoint, 7>& rule() {
  static const std::array<FacePoint, 7> all = [] {
    const double root = std::sqrt(15.0);
    std::array<FacePoint, 7> found;
    std::size_t k = 0;
    found[k++] = face_point(1.0 / 3.0, 1.0 / 3.0, 9.0 / 80.0);
    for (const double sign : {-1.0, 1.0}) {
      const double a = (6.0 + sign * root) / 21.0;
      const double w = (155.0 + sign * root) / 2400.0;
      found[k++] = face_point(a, a, w);
      found[k++] = face_point(1.0 - 2.0 * a, a, w);
      found[k++] = face_point(a, 1.0 - 2.0 * a, w);
    }
    return found;
  }();
  return all;
}

}  // namespace

std::optional<Indenter::Meeting> Indenter::at(const Vec3& place) const {
  const auto& [c_1, c_2] = curvature;
  const double c = 0.5 * (c_1 + c_2);
  const Vec3 own = place - pole;
  const double upright = 1.0 - c * own.z();
  if (upright <= 0.0) return std::nullopt;
  const Vec3 down(c_1 * own.x(), c_2 * own.y(), -upright);
  const double inside =
      2.0 * own.z() - c_1 * own.x() * own.x() - c_2 * own.y() * own.y() - c * own.z() * own.z();
  const double length = down.norm();
  return Meeting{inside / (length + (c_1 == c_2 ? 1.0 : length)), down / length, c / length};
}

std::optional<double> Indenter::gap(const Vec3& place) const {
  const auto& [c_1, c_2] = curvature;
  const Vec3 own = place - pole;
  const double q = c_1 * own.x() * own.x() + c_2 * own.y() * own.y();
  const double root = 1.0 - 0.5 * (c_1 + c_2) * q;
  if (root < 0.0) return std::nullopt;
  return q / (1.0 + std::sqrt(root)) - own.z();
}

bool Indenter::near(const Vec3& place, double reach) const {
  const auto& [c_1, c_2] = curvature;
  const Vec3 own = place - pole;
  const double least = std::min(c_1, c_2);
  const double aside = own.head<2>().norm() + (least > 0.0 ? -reach : reach);
  const double lowest = least > 0.0 ? 0.5 * least * std::max(0.0, aside) * std::max(0.0, aside)
                                    : least * aside * aside;
  return own.z() + reach > lowest;
}

Contact::Contact(const Elements& elements, std::span<const OuterFace> faces, double stiffness)
    : stiffness_(stiffness) {
  const std::vector<Vec3>& nodes = elements.mesh().nodes;
  for (const OuterFace& face : faces) {
    Own own{.nodes = face.nodes};
    const auto node = [&](std::size_t a) -> const Vec3& { return nodes[as_index(own.nodes[a])]; };
    own.middle = (node(0) + node(1) + node(2)) / 3.0;
    for (std::size_t a = 0; a < 6; ++a)
      own.reach = std::max(own.reach, (node(a) - own.middle).norm());
    for (std::size_t q = 0; q < face_points; ++q) {
      const FacePoint& at = rule()[q];
      Vec3 first = Vec3::Zero();
      Vec3 second = Vec3::Zero();
      for (std::size_t a = 0; a < 6; ++a) {
        own.places[q] += at.values[a] * node(a);
        first += at.along_1[a] * node(a);
        second += at.along_2[a] * node(a);
      }
      const Vec3 across = first.cross(second);
      own.areas[q] = at.weight * across.norm();
      own.normals[q] = across.normalized();
    }
    std::size_t k = 0;
    for (std::size_t r = 0; r < 18; ++r)
      for (std::size_t c = 0; c <= r; ++c) {
        const int row = elements.unknown(3 * own.nodes[r / 3] + static_cast<int>(r % 3));
        const int column = elements.unknown(3 * own.nodes[c / 3] + static_cast<int>(c % 3));
        own.entries[k++] = row < 0 || column < 0
                               ? -1
                               : elements.entry(std::max(row, column), std::min(row, column));
      }
    faces_.push_back(own);
  }
}

template <class Visit>
void Contact::for_each(const Vector& displacement, std::span<const Indenter> indenters,
                       const Visit& visit) const {
  for (const Own& face : faces_) {
    std::array<Vec3, 6> moved;
    double most = 0.0;
    for (std::size_t a = 0; a < 6; ++a) {
      moved[a] = displacement.segment<3>(3 * face.nodes[a]);
      most = std::max(most, moved[a].norm());
    }
    for (std::size_t i = 0; i < indenters.size(); ++i) {
      if (!indenters[i].near(face.middle, face.reach + most)) continue;
      for (std::size_t q = 0; q < face_points; ++q) {
        Vec3 change = Vec3::Zero();
        for (std::size_t a = 0; a < 6; ++a) change += rule()[q].values[a] * moved[a];
        const auto found = indenters[i].at(face.places[q] + change);
        if (!found) continue;
        const double s = indenters[i].share;
        const double depth = s * found->depth + (1.0 - s) * face.normals[q].dot(change);
        if (depth <= 0.0) continue;
        visit(face, q, i,
              Overlap{depth, s * found->normal - (1.0 - s) * face.normals[q], found->normal,
                      s * found->bend});
      }
    }
  }
}

void Contact::add(const Vector& displacement, std::span<const Indenter> indenters, double steepest,
                  Vector& force, Eigen::SparseMatrix<double>& stiffness,
                  std::vector<Met>& met) const {
  met.assign(indenters.size(), {});
  double* values = stiffness.valuePtr();
  for_each(displacement, indenters,
           [&](const Own& face, std::size_t q, std::size_t i, const Overlap& here) {
             const double pressure = stiffness_ * here.depth;
             const double area = face.areas[q];
             Met& own = met[i];
             own.force += area * pressure * here.push;
             own.work += area * pressure * here.depth;
             own.area += area;
             own.peak = std::max(own.peak, pressure);
             const std::array<double, 6>& n = rule()[q].values;
             for (std::size_t a = 0; a < 6; ++a)
               force.segment<3>(3 * face.nodes[a]) -= n[a] * area * pressure * here.push;
             const double bend = area * std::min(pressure, steepest) * here.bend;
             const Eigen::Matrix3d change =
                 area * stiffness_ * here.push * here.push.transpose() +
                 bend * (here.normal * here.normal.transpose() - Eigen::Matrix3d::Identity());
             const int* entry = face.entries.data();
             for (std::size_t r = 0; r < 18; ++r)
               for (std::size_t c = 0; c <= r; ++c, ++entry)
                 if (*entry >= 0)
                   values[*entry] +=
                       n[r / 3] * n[c / 3] *
                       change(static_cast<Eigen::Index>(r % 3), static_cast<Eigen::Index>(c % 3));
           });
}

double Contact::energy(const Vector& displacement, std::span<const Indenter> indenters) const {
  double sum = 0.0;
  for_each(displacement, indenters,
           [&](const Own& face, std::size_t q, std::size_t, const Overlap& here) {
             sum += 0.5 * face.areas[q] * stiffness_ * here.depth * here.depth;
           });
  return sum;
}

}  // namespace palpate::solid
