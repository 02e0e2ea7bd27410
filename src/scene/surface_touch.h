// Where a finger first touches a specimen without a mesh, and how the surface curves there.
#pragma once

#include <limits>
#include <string>

#include "geometry/curvature.h"
#include "geometry/smooth_surface.h"
#include "scenario/resolved.h"

namespace palpate::scene {

class SpecimenShapes;

// What a closed form knows of a specimen's surface. The force acts along the normal of the surface
// nearest to the sphere, as on a mesh.
struct SurfaceTouch {
  Vec3 low = Vec3::Zero();  // m, corners of the bounding box in the coordinates of the file
  Vec3 high = Vec3::Zero();
  Vec3 size = Vec3::Constant(std::numeric_limits<double>::infinity());  // m, of the bounding box
  // m, from the touch straight down to where the body ends, or the wall of a hollow one.
  double thickness = std::numeric_limits<double>::infinity();
  // m, from there straight down to what is held, over cavities and gaps, and what is tissue of it;
  // infinite above a side that is free.
  double to_base = std::numeric_limits<double>::infinity();
  double tissue_to_base = std::numeric_limits<double>::infinity();
  Vec3 lowest = Vec3::Zero();     // m, the lowest point of one sphere at first touch
  Vec3 position = Vec3::Zero();   // m, of the surface
  geometry::Curvature curvature;  // there, with the normal
  // m, from the touch to the nearest edge (convex crease) of a file's surface, 0 on one, to the end
  // of a lying cylinder or limb, or from the finger's way to the nearest side of a cuboid.
  double to_edge = std::numeric_limits<double>::infinity();
  double width = 1.0;      // of the contact at the deepest travel, as width_on_edge()
  bool one_sided = false;  // the curvature has StarStatus::one_sided
  // The mean of the normals around the touch, where the normal at `finger.at` alone says from which
  // side the press comes; else up.
  Vec3 around = Vec3::UnitZ();
  std::string cannot = {};   // why there is no curvature; empty if there is one
  std::string warning = {};  // on what was made of the file; empty if it is taken as it is
  bool nowhere = false;      // no model can press here: beside the body, or it is not sound
  std::string beside = {};   // the key of the place, if that is beside the body

  [[nodiscard]] bool known() const { return cannot.empty(); }
  [[nodiscard]] bool curved() const { return curvature.kappa_1 != 0.0 || curvature.kappa_2 != 0.0; }
  [[nodiscard]] bool tilted() const { return curvature.normal.z() < 1.0; }
  // Between the surface and the horizontal, degrees.
  [[nodiscard]] double inclination() const;

  // The indentation (m) and the normal after the finger has gone down vertically by `travel` (m),
  // on the quadric with these curvatures: exact on a flat, else to second order in the travel.
  //                                                                  docs/theory.md [inclined]
  struct Pressed {
    double depth;
    Vec3 normal;
  };
  [[nodiscard]] Pressed pressed(double radius, double travel) const;
};

// The curvature of a file's surface at a point, fitted over the contact at the deepest travel, or
// over `contact.curvature_rings` where they are larger: facets smaller than the contact are
// smoothed.
[[nodiscard]] geometry::CurvatureEstimate curvature_of_file(const geometry::SmoothSurface& surface,
                                                            const geometry::SurfacePoint& at,
                                                            const scenario::Resolved& scenario);

// How far the body reaches straight down from a point (m) of its surface, m.
[[nodiscard]] double thickness_under(const geometry::Surface& surface, const Vec3& point);

// How wide the contact on a sharp edge is across it, over that on a flat: where the undeformed
// sphere, at the deepest travel (m), overlaps sides with slopes s to it,
// x = R (sqrt(s^2 + 2 d/R) - s). `centre` is that of the sphere at first touch, m. 1 away from
// edges.                                                        docs/theory.md [edge_width]
[[nodiscard]] double width_on_edge(const geometry::SmoothSurface& surface, const Vec3& centre,
                                   double radius, double deepest);

// The touch of one sphere of `finger.radius` at `finger.x`, `finger.y`: in closed form for a
// parametric shape; for a file, on the file's triangles, with the quadric fit of the surface of a
// mesh. Nothing is meshed. Relative files are looked for in `folder`.
[[nodiscard]] SurfaceTouch surface_touch(const scenario::Resolved& scenario,
                                         const std::string& folder, SpecimenShapes& shapes);

}  // namespace palpate::scene
