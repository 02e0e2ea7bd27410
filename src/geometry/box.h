// Boxes along the axes, and how far places reach in a direction.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/vec3.h"

namespace palpate::geometry {

struct Box {
  Vec3 low = Vec3::Zero();  // m
  Vec3 high = Vec3::Zero();

  [[nodiscard]] Vec3 size() const { return high - low; }
  [[nodiscard]] double diagonal() const { return size().norm(); }
};

// At least one place is needed.
[[nodiscard]] inline Box box_of(std::span<const Vec3> places) {
  Box box{places.front(), places.front()};
  for (const Vec3& place : places) {
    box.low = box.low.cwiseMin(place);
    box.high = box.high.cwiseMax(place);
  }
  return box;
}

// The least and the largest coordinate of places along a direction, m.
[[nodiscard]] inline std::pair<double, double> reach_along(std::span<const Vec3> places,
                                                           const Vec3& direction) {
  std::pair<double, double> reach{HUGE_VAL, -HUGE_VAL};
  for (const Vec3& place : places) {
    reach.first = std::min(reach.first, place.dot(direction));
    reach.second = std::max(reach.second, place.dot(direction));
  }
  return reach;
}

}  // namespace palpate::geometry
