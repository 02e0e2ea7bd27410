// Where spheres touch a surface that deforms.
#pragma once

#include <span>
#include <vector>

#include "geometry/smooth_surface.h"

namespace palpate::contact {

// Finds every contact of a sphere: the feet of the perpendiculars from its centre that are nearer
// than its radius, each once, also where the sphere has sunk in deep or came in one long move.
//
// The surface is searched where it is now (a tree of boxes, refitted as it moves). The foot is then
// taken on the surface at rest, from the centre carried back by the surface's displacement there:
// on the deformed surface the nearest point is not unique, because under a contact the surface
// takes the very shape of the sphere.                               docs/decisions.md, 29
class Detector {
 public:
  explicit Detector(const geometry::SmoothSurface& surface);

  // The surface's vertices have moved by these displacements, m, one a vertex.
  void refit(std::span<const Vec3> displacement);

  // From now on find() allocates nothing but what it grows of `feet`.
  void make_room() { near_.reserve(surface_->surface().triangles.size()); }

  // The contacts of a sphere (m), in the order of their triangles. `displacement` may be empty:
  // the surface at rest.
  void find(const Vec3& centre, double radius, std::span<const Vec3> displacement,
            std::vector<geometry::SmoothSurface::Foot>& feet);

 private:
  // Whether no neighbour of this triangle is nearer to the centre.
  [[nodiscard]] bool nearest_around(const geometry::Near& near) const;

  const geometry::SmoothSurface* surface_;
  geometry::BoxTree tree_;
  std::vector<Vec3> moved_;
  std::vector<geometry::Near> near_;
};

// The displacement of a surface point, m.
[[nodiscard]] Vec3 displacement_at(const geometry::Surface& surface,
                                   const geometry::SurfacePoint& point,
                                   std::span<const Vec3> displacement);

}  // namespace palpate::contact
