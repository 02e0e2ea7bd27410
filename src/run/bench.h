// Measures the run time of the frames of a press, stage by stage.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace palpate::run {

// Run times of one frame, that is one time step of the scenario, in all of its substeps together.
// All in s.
struct FrameTime {
  double collision = 0.0;  // detection, with the refit of the boxes if it sees the deformed surface
  double force = 0.0;      // laws, curvatures, patches and contact equations, no detection
  double deformation = 0.0;  // the mesh alone, under given forces
  double whole = 0.0;        // the frame as in `palpate run`: contacts, mesh, energy

  [[nodiscard]] double sum() const { return collision + force + deformation; }
  // Energy balance and passing on of states; below 0 where the stages alone find colder caches.
  [[nodiscard]] double other() const { return whole - sum(); }
};

struct Bench {
  std::vector<FrameTime> frames;
  double force = 0.0;                // N, on the finger in the last frame
  double displacement = 0.0;         // m, the largest of the mesh that timed `deformation`
  std::optional<std::string> wrong;  // why the press ended early; empty if it did not
};

// Presses to the deepest travel of the scene's loading history in equal time steps on one thread:
// 50 frames that are not counted, then `frames`, with the scene's coupling, integrator and rings.
// The stages are timed afterwards on a second mesh under the same forces; with `solver.rings` its
// moving part stays that of the first touch. All results but the times are reproducible. The scene
// must have a specimen and a finger.
[[nodiscard]] Bench bench(const scene::Scene& scene, int frames);

// The smallest value that is not exceeded by the fraction `share` (0 to 1) of the values.
[[nodiscard]] double percentile(std::vector<double> values, double share);

}  // namespace palpate::run
