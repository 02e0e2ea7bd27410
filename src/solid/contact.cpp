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
      own.areas[q] = at.weight * first.cross(second).norm();
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

std::optional<Contact::Overlap> Contact::overlap(const Vec3& place, const Ball& ball) {
  const Vec3 from = place - ball.centre;
  // Only the lower half of a ball is met, of a cup its upper half.
  if (ball.hollow ? from.z() <= 0.0 : from.z() >= 0.0) return std::nullopt;
  const double distance = from.norm();
  const double depth = ball.hollow ? distance - ball.radius : ball.radius - distance;
  if (depth <= 0.0) return std::nullopt;
  const double sign = ball.hollow ? -1.0 : 1.0;
  return Overlap{depth, sign / distance * from, sign / distance};
}

template <class Visit>
void Contact::for_each(const Vector& displacement, std::span<const Ball> balls,
                       const Visit& visit) const {
  for (const Own& face : faces_) {
    std::array<Vec3, 6> moved;
    Vec3 middle = face.middle;
    double most = 0.0;
    for (std::size_t a = 0; a < 6; ++a) {
      moved[a] = displacement.segment<3>(3 * face.nodes[a]);
      most = std::max(most, moved[a].norm());
    }
    for (std::size_t b = 0; b < balls.size(); ++b) {
      const double far = (middle - balls[b].centre).norm();
      if (balls[b].hollow ? far + face.reach + most < balls[b].radius
                          : far > balls[b].radius + face.reach + most)
        continue;
      for (std::size_t q = 0; q < face_points; ++q) {
        Vec3 place = face.places[q];
        for (std::size_t a = 0; a < 6; ++a) place += rule()[q].values[a] * moved[a];
        if (const auto found = overlap(place, balls[b])) visit(face, q, place, b, *found);
      }
    }
  }
}

void Contact::add(const Vector& displacement, std::span<const Ball> balls, double steepest,
                  Vector& force, Eigen::SparseMatrix<double>& stiffness,
                  std::vector<Met>& met) const {
  met.assign(balls.size(), {});
  double* values = stiffness.valuePtr();
  for_each(displacement, balls,
           [&](const Own& face, std::size_t q, const Vec3&, std::size_t b, const Overlap& here) {
             const double pressure = stiffness_ * here.depth;
             const double area = face.areas[q];
             Met& own = met[b];
             own.force += area * pressure * here.normal;
             own.work += area * pressure * here.depth;
             own.area += area;
             own.peak = std::max(own.peak, pressure);
             const std::array<double, 6>& n = rule()[q].values;
             for (std::size_t a = 0; a < 6; ++a)
               force.segment<3>(3 * face.nodes[a]) -= n[a] * area * pressure * here.normal;
             const double bend = area * std::min(pressure, steepest) * here.bend;
             const Eigen::Matrix3d change =
                 (area * stiffness_ + bend) * here.normal * here.normal.transpose() -
                 bend * Eigen::Matrix3d::Identity();
             const int* entry = face.entries.data();
             for (std::size_t r = 0; r < 18; ++r)
               for (std::size_t c = 0; c <= r; ++c, ++entry)
                 if (*entry >= 0)
                   values[*entry] +=
                       n[r / 3] * n[c / 3] *
                       change(static_cast<Eigen::Index>(r % 3), static_cast<Eigen::Index>(c % 3));
           });
}

double Contact::energy(const Vector& displacement, std::span<const Ball> balls) const {
  double sum = 0.0;
  for_each(displacement, balls,
           [&](const Own& face, std::size_t q, const Vec3&, std::size_t, const Overlap& here) {
             sum += 0.5 * face.areas[q] * stiffness_ * here.depth * here.depth;
           });
  return sum;
}

}  // namespace palpate::solid
