// Three numbers in space: the vector type of every room.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>  // cross

namespace palpate {

using Vec3 = Eigen::Vector3d;

}  // namespace palpate
