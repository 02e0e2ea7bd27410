// What the size of a body changes of the force of a formula, by one coarse mesh of the body.
#pragma once

#include <string>
#include <vector>

#include "scenario/resolved.h"
#include "scene/estimates.h"
#include "scene/surface_touch.h"

namespace palpate::scene {
class SpecimenShapes;
}

namespace palpate::run {

// Whether the finger has several spheres that each press with their own force. Hertz's law knows
// nothing of the dents that they make for each other.
[[nodiscard]] bool each_presses(const scenario::Resolved& scenario);

// By the energy coupling on some 150 nodes, or on the mesh of a file, under a rigid finger at the
// deepest travel; of one sphere, unless each presses.              docs/theory.md [estimates]
struct SizeEffect {
  double change = 0.0;  // of the formula's force, relative
  double error = 0.0;   // the mesh's own, a fraction of its force
  double softer = 0.0;  // the change, or that of Hertz's force where no formula applies
  double moving = 0.0;  // m^3, what moves as far as the body is softer by that            [swing]
  double lag = 0.0;     // the part of that by which the body lags behind in the press   [swing]
  int nodes = 0;        // 0 if there is no mesh, or no solution on it
};

// The places of the finger beside the first touch: start, middle and end of every slide, m.
[[nodiscard]] std::vector<Vec3> finger_way(const scenario::Resolved& scenario);

// The formula is Hertz's where the surface's curvature is known, else the change is 0; on a cuboid
// of several flat layers it is their exact law [sides], so that the change is that of the sides. At
// the place that changes most along slides. Kept in `shapes` for travels and Poisson's ratios
// nearby: travels are rounded up by less than sqrt(2), and ratios are interpolated. `seconds` is
// the time of the quickest press, infinite at rest.
[[nodiscard]] SizeEffect size_effect(const scenario::Resolved& scenario, const std::string& folder,
                                     const scene::SurfaceTouch& touch, double seconds,
                                     scene::SpecimenShapes& shapes);

// How far the body yields under a force that has Hertz's depth, over that: as a spring behind the
// contact.
[[nodiscard]] double yields(const SizeEffect& size);

// By how much such a body swings about its static force, relative to it, where the finger starts
// at its rate: its mass on what it yields beyond the formula, behind the spring of the contact.
//                                                                   docs/theory.md [swing]
[[nodiscard]] double swing(const SizeEffect& size, const scene::Estimates& estimates,
                           const scene::SurfaceTouch& touch,
                           const scenario::Resolved::Tissue& tissue);

}  // namespace palpate::run
