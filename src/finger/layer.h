// The finger as a flat layer of equal spheres.
#pragma once

#include <vector>

#include "base/vec3.h"
#include "geometry/surface.h"

namespace palpate::finger {

// Equal spheres in one plane parallel to the pad: all touch a flat tissue at the same depth.
struct Layer {
  double radius = 0.0;        // m, of each sphere
  double density = 0.0;       // kg/m^3
  std::vector<Vec3> centres;  // m, relative to the layer's centre of gravity; z = 0

  [[nodiscard]] double mass() const;  // kg, of all spheres
};

inline constexpr int most_spheres = 64;

// Replaces the finger of mass M by `count` spheres (1 to 64) of mass M/n and radius (3 M / (4 pi
// rho n))^(1/3) with the same centre of gravity. Their centres are in the plane through it,
// mirror-symmetric in y and as far apart as possible within the finger's outline seen along z, with
// the spheres inside where they fit. Spheres overlap, because spheres of the whole mass do not fit
// side by side. `fingertip` is a surface as from geometry::fingertip: pad facing -z, symmetric in
// y, convex seen along z, open at one rim or closed. `density` in kg/m^3.
//                                                    Chen 2007 eq. (5); docs/theory.md [spheres]
[[nodiscard]] Layer pack(const geometry::Surface& fingertip, double density, int count);

// Which property several spheres share with the single sphere that they replace.
enum class Calibration {
  mass,   // Chen 2007: the total force on a flat is n^(5/6) times as large
  force,  // the total force on a flat equals that of the single sphere at the same depth
};

// The factor on E* of each of `count` spheres.               docs/theory.md [calibration]
[[nodiscard]] double modulus_factor(Calibration calibration, int count);

}  // namespace palpate::finger
