// The vector type of all rooms: three doubles.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>  // cross
#include <cmath>
#include <string>

#include "base/index.h"
#include "base/text.h"

namespace palpate {

using Vec3 = Eigen::Vector3d;

// rad, from 0 to pi; 0 if one of the vectors is zero.
[[nodiscard]] inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// "(1, 0, -2)", rounded; numbers below 1e-9 of the vector's length are 0.
[[nodiscard]] inline std::string vector_text(const Vec3& vector, int digits = 4) {
  const double rounding = 1e-9 * vector.norm();
  std::string text;
  for (const double number : vector)
    text += (text.empty() ? "(" : ", ") +
            rounded_text(std::abs(number) <= rounding ? 0.0 : number, digits);
  return text + ")";
}

}  // namespace palpate
