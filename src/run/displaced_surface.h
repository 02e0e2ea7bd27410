// How a press displaces the surface around it, and how far that is from the solid's.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/vec3.h"
#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// A small piece of the surface that the finger may meet.
struct DisplacedPiece {
  Vec3 place = Vec3::Zero();         // m, its middle at rest
  Vec3 displacement = Vec3::Zero();  // m
  double area = 0.0;                 // m^2, at rest
};

struct SurfaceReference {
  // The pieces within four contact radii of the first touch; none where `solid` has no equilibrium.
  std::vector<DisplacedPiece> pieces;
  double error = 0.0;  // surface_error() of a coarser mesh
};

// The displaced surface of a scene of the model `solid` at the deepest travel, before any slide.
// Throws MeshError and Stopped.
[[nodiscard]] SurfaceReference displaced_by_solid(const scene::Scene& scene);

// The error of the displaced surface at the deepest travel: the root mean square of the difference
// over the area of the pieces, divided by their largest displacement. The record must have been run
// with `output.tissue`. Nothing if it ended early, has no mesh, or slides before that travel.
[[nodiscard]] std::optional<double> surface_error(const record::CaseRecord& record,
                                                  std::span<const DisplacedPiece> reference);

}  // namespace palpate::run
