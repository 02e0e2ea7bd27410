// How long the frames of a press take, stage by stage.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace palpate::run {

// One frame: one time step of the scenario, its substeps included. All in s.
struct FrameTime {
  double collision = 0.0;    // detection once, over the mesh as it is deformed, its boxes refitted
  double force = 0.0;        // laws, curvatures, patches and balance, once: less detection
  double deformation = 0.0;  // all substeps of the mesh, under forces that are known
  double whole = 0.0;        // as `palpate run` takes it: contacts, mesh and energy, every substep

  [[nodiscard]] double sum() const { return collision + force + deformation; }
};

struct Bench {
  std::vector<FrameTime> frames;
  double force = 0.0;                // N, of the last frame: the work that was timed
  double displacement = 0.0;         // m, the greatest, of the mesh of `deformation`
  std::optional<std::string> wrong;  // where the press ended early, and why
};

// Presses to the deepest travel of the scene's programme in `frames` equal time steps, after a few
// that are not counted, with the scene's coupling, integrator and rings, on one thread. The stages
// are timed after the whole, on a mesh of their own that gets the same forces; with `rings` this
// mesh keeps the part around the first touch. Times come from the steady clock; all else is the
// same at every call. The scene has a specimen and a finger.
[[nodiscard]] Bench bench(const scene::Scene& scene, int frames);

// The value that `share` (0 to 1) of the values do not exceed, by nearest rank.
[[nodiscard]] double percentile(std::vector<double> values, double share);

}  // namespace palpate::run
