// The shapes that a scenario can name instead of a file, and their surfaces.
#pragma once

#include <optional>
#include <variant>

#include "geometry/body.h"
#include "geometry/shape_loops.h"

namespace palpate::geometry {

// All lengths are in m. The bounding box of every shape starts at the origin.

struct Cuboid {
  Vec3 size{0.060, 0.060, 0.030};
};

// Its axis is along y, its lowest line at z = 0.
struct Cylinder {
  double radius = 0.030;
  double length = 0.080;
};

// Full axes along x, y and z. The default is the size of a man's head: breadth 154 and length 199
// mm of the 2012 survey of the US Army (Gordon et al. 2014, NATICK/TR-15/007), height assumed.
struct Ellipsoid {
  Vec3 size{0.154, 0.199, 0.230};
};

// A strap along y with rounded edges, a fifth wider and thicker at its ends than in the middle. The
// default is a patellar ligament: 44 mm long (Exp Ther Med 2013; 5: 917, men of 15 to 24), 27 mm
// wide in the middle (Knee 2019, 32 specimens), thickness assumed.
struct Ligament {
  double length = 0.044;
  double width = 0.027;      // in the middle
  double thickness = 0.005;  // in the middle
};

// A round shaft along y that flares towards its ends.
struct BoneShaft {
  double length = 0.200;
  double radius = 0.014;  // in the middle
  double end_radius = 0.022;
};

// The upper leg: circular sections along y, slightly tapered, with a bone on its axis and skin all
// around. Regions: 0 skin with the fat under it, 1 muscle, 2 bone; all extend to the flat end
// faces. A region with thickness or radius 0 is left out.
struct LayeredLimb {
  double length = 0.350;
  double radius = 0.090;      // at y = 0
  double end_radius = 0.065;  // at y = length
  double skin_thickness = 0.012;
  double bone_radius = 0.016;
};

using Shape = std::variant<Cuboid, Cylinder, Ellipsoid, Ligament, BoneShaft, LayeredLimb>;

// The shape's closed surfaces with edges of about `spacing`. The vertices are on the shape, so that
// the enclosed volume is slightly too small where the shape is round. Throws MeshError for a limb
// whose bone and skin leave no room for muscle.
[[nodiscard]] Body sampled(const Shape& shape, const Spacing& spacing);

// The point of the shape's nearest round surface, outer or between its regions, at about `point`,
// which is near that surface and not on the axis of a bar. Flat ends and cuboids give `point`.
[[nodiscard]] Vec3 onto(const Shape& shape, const Vec3& point);

// The same on one of a bar's round surfaces, which are numbered from outside; the number of the one
// that is nearest to a point. Other shapes have one.
[[nodiscard]] Vec3 onto(const Shape& shape, const Vec3& point, int surface);
[[nodiscard]] int nearest_surface(const Shape& shape, const Vec3& point);

// The outermost surface of a shape along y as a sweep; empty for a cuboid and an ellipsoid.
[[nodiscard]] std::optional<Sweep> outer_sweep(const Shape& shape);

// The size of the shape's bounding box along x, y and z, m.
[[nodiscard]] Vec3 extent(const Shape& shape);

}  // namespace palpate::geometry
