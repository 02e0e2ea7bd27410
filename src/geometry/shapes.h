// The shapes that a scenario can name instead of a file, and their surfaces.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "geometry/body.h"
#include "geometry/curvature.h"
#include "geometry/shape_loops.h"
#include "geometry/surface.h"

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

// A round disc, standing: its axis is along z, its flat ends are at z = 0 and z = height. The
// default is what a biopsy punch of 12 mm takes.
struct Disc {
  double radius = 0.006;
  double height = 0.005;
};

// The upper leg: circular sections along y, slightly tapered, with a bone on its axis and skin all
// around. Regions: 0 skin with the fat under it, 1 muscle, 2 bone; all extend to the flat end
// faces. A region with thickness or radius 0 is excluded.
struct LayeredLimb {
  double length = 0.350;
  double radius = 0.090;      // at y = 0
  double end_radius = 0.065;  // at y = length
  double skin_thickness = 0.012;
  double bone_radius = 0.016;
};

using Shape = std::variant<Cuboid, Cylinder, Ellipsoid, Ligament, BoneShaft, LayeredLimb, Disc>;

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

// The outermost surface of a shape along y as a sweep; empty for other shapes.
[[nodiscard]] std::optional<Sweep> outer_sweep(const Shape& shape);

// The axis normal to the flat ends of a round shape, 0 to 2: y but for a disc.
[[nodiscard]] int axis_of(const Shape& shape);
// Whether the flat ends of a test between platens are those at the shape's bottom and top; bars
// lie.
[[nodiscard]] bool stands(const Shape& shape);

// The size of the shape's bounding box along x, y and z, m.
[[nodiscard]] Vec3 extent(const Shape& shape);

// The last part of an index finger, 179 triangles: axis along x with the tip at +x, the flatter pad
// towards -z, the nail side towards +z, mirror-symmetric in y, open at its base in the plane x = 0.
// It is scaled so that it encloses `volume` (m^3, above 0) with the base closed. The proportions
// are 18 mm breadth to 15 mm depth to 26 mm length. The breadth is the middle of the 16 to 20 mm
// that K. Dandekar, B. I. Raju and M. A. Srinivasan give for human fingertips (J. Biomech. Eng.
// 125, 2003); depth and length are assumed. Shape: docs/theory.md [fingertip].
[[nodiscard]] Surface fingertip(double volume);

// The surface with its rim closed by triangles around a new vertex at the mean of the rim; flat if
// the rim is plane. For volume, centre of gravity and drawing. `open` has one rim; a surface
// without a rim is returned unchanged.
[[nodiscard]] Surface with_closed_base(const Surface& open);

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

}  // namespace palpate::geometry
