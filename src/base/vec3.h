// The vector type of all rooms: three doubles.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>  // cross
#include <cmath>

#include "base/index.h"

namespace palpate {

using Vec3 = Eigen::Vector3d;

// rad, from 0 to pi; 0 if one of the vectors is zero.
[[nodiscard]] inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace palpate
