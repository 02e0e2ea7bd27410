// The finger as one flat layer of equal spheres.
#pragma once

#include <vector>

#include "base/vec3.h"
#include "geometry/surface.h"

namespace palpate::finger {

// Equal spheres whose centres lie in one plane parallel to the pad, so that all of them touch a
// flat tissue at the same depth.
struct Layer {
  double radius = 0.0;        // m, of each sphere
  double density = 0.0;       // kg/m^3
  std::vector<Vec3> centres;  // m, from the layer's centre of gravity; z = 0

  [[nodiscard]] double mass() const;  // kg, of all spheres
};

inline constexpr int most_spheres = 64;

// The finger's mass M in `count` spheres (1 to 64) of equal mass M/n, so of radius
// (3 M / (4 pi rho n))^(1/3), with the finger's centre of gravity:   Chen 2007 eq. (5)
// in the plane through it, spread as far apart as the finger's outline seen along z allows with the
// spheres inside where they fit, and mirror-symmetric in y.          docs/theory.md (28)
// Spheres overlap: a layer of the whole mass does not fit beside one another. `fingertip` is as
// geometry::fingertip makes it: pad facing -z, symmetric in y, convex seen along z, open at one
// rim or closed. `density` in kg/m^3.
[[nodiscard]] Layer pack(const geometry::Surface& fingertip, double density, int count);

// The smallest distance between two centres, m; infinite for one sphere.
[[nodiscard]] double smallest_spacing(const Layer& layer);

// What equal spheres keep of the sphere that they replace.
enum class Calibration {
  mass,   // the paper's: they press a flat n^(5/6) times as hard
  force,  // they press a flat as the one sphere does at the same depth
};

// The factor on E* of each of `count` spheres.                        docs/theory.md (29)
[[nodiscard]] double modulus_factor(Calibration calibration, int count);

}  // namespace palpate::finger
