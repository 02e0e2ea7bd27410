// Where a body is held from below, for estimates that make no mesh.
#pragma once

#include <optional>

#include "geometry/surface.h"

namespace palpate::scene {

// The ellipse with the area's centre and second moments, seen from above, of the skin that is held:
// its flat underside, or else what lies below `base_height` (m; by default a tenth of the height
// above the lowest point).
struct Footing {
  double level = 0.0;                   // m, the body's lowest point
  Eigen::Vector2d centre{0.0, 0.0};     // m
  Eigen::Vector2d direction{1.0, 0.0};  // of semi_axes[0]; the other is across
  Eigen::Vector2d semi_axes{0.0, 0.0};  // m

  // What a rigid footing of this form on a half-space adds to the compliance of a contact at
  // `position` (m) with the surface's `normal`: times the contact's radius (m), over the tangent
  // compliance 1 / (2 a E*) of that contact.                              docs/theory.md (68)
  struct Compliance {
    double sinking = 0.0;  // 1/m
    double rocking = 0.0;  // 1/m
  };
  [[nodiscard]] Compliance under(const Vec3& position, const Vec3& normal) const;
};

[[nodiscard]] Footing footing(const geometry::Surface& surface, std::optional<double> base_height);

}  // namespace palpate::scene
