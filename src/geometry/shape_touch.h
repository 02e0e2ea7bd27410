// Where a sphere that is lowered onto a parametric shape first touches it, in closed form.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/curvature.h"
#include "geometry/shapes.h"

namespace palpate::geometry {

struct ShapeTouch {
  Vec3 position = Vec3::Zero();  // m, on the shape
  Curvature curvature;           // there, with the outward normal
  bool on_edge = false;          // on the rim of an end face, or beside the top of a cuboid
};

// Lowers a sphere of `radius` (m) vertically at (x, y) onto the outermost surface of a shape. The
// result's position and curvature are without meaning on an edge. Empty if the sphere passes beside
// the shape.                                                        docs/theory.md [from_above]
[[nodiscard]] std::optional<ShapeTouch> touch_from_above(const Shape& shape, double x, double y,
                                                         double radius);

// The curvature of the surface f = 0 from the gradient of f, which points outwards, and its second
// derivatives.                                                       docs/theory.md [level_set]
[[nodiscard]] Curvature level_curvature(const Vec3& gradient, const Eigen::Matrix3d& second);

}  // namespace palpate::geometry
