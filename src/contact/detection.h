// Finds the contacts of spheres with a deforming surface.
#pragma once

#include <span>
#include <vector>

#include "geometry/smooth_surface.h"

namespace palpate::contact {

// Finds every contact of a sphere once: the perpendiculars from its centre to the surface that are
// shorter than its radius. Spheres that are deep inside or came in one long move are found too. The
// search uses the deformed surface (a tree of boxes, refitted as the surface moves). The foot is
// then computed on the undeformed surface, from the centre minus the surface's displacement there:
// on the deformed surface the nearest point is not unique, because under a contact the surface
// takes the shape of the sphere.                                              docs/decisions.md, 29
class Detector {
 public:
  explicit Detector(const geometry::SmoothSurface& surface);

  // Sets the displacements of the surface's vertices, m, one per vertex.
  void refit(std::span<const Vec3> displacement);

  // After this, find() allocates memory only for `feet`.
  void make_room() { near_.reserve(surface_->surface().triangles.size()); }

  // Finds the contacts of a sphere (m), in the order of their triangles. `displacement` is that of
  // refit(), or empty for the undeformed surface.
  void find(const Vec3& centre, double radius, std::span<const Vec3> displacement,
            std::vector<geometry::SmoothSurface::ClosestPoint>& feet);

 private:
  // Whether no neighbouring triangle is nearer to the centre.
  [[nodiscard]] bool nearest_around(const geometry::Near& near) const;

  const geometry::SmoothSurface* surface_;
  geometry::BoxTree tree_;
  std::vector<Vec3> moved_;
  std::vector<geometry::Near> near_;
};

}  // namespace palpate::contact
