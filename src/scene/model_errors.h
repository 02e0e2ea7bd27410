// The error that every rung of the ladder is expected to have in a scene.
#pragma once

#include "scene/estimates.h"

namespace palpate::scene {

// In a press, from its estimates; all errors are fractions of the force.       docs/theory.md (69)
class ModelErrors {
 public:
  // `asked` is the case resolved with the strongest model. All arguments outlive this object.
  ModelErrors(const scenario::Scenario& given, const scenario::Resolved& asked,
              const SurfaceTouch& touch, const Estimates& estimates)
      : given_(given), asked_(asked), touch_(touch), e_(estimates) {}

  // Of a rung with what the scenario gives it, and with what was found where the scenario leaves a
  // key open.
  [[nodiscard]] double of(const scenario::Rung& rung, const scenario::Found& found) const;

  // The part of it that the mesh causes; 0 without one. Where the mesh is refined, at most what
  // refining leaves.
  [[nodiscard]] double of_mesh(const scenario::Rung& rung) const;

  // An effect of inertia that is left out. It counts from a fifth of the tolerance on, as depth and
  // viscosity do.
  [[nodiscard]] double counted(double inertia) const;

  // Whether the rungs of this scenario can use the factor of a deep press.
  [[nodiscard]] bool has_depth_ratio() const;

  // Whether the tissue's inertia affects the force on a mesh.
  [[nodiscard]] bool moves() const;

 private:
  [[nodiscard]] double of_size(const scenario::Rung& rung, const scenario::Found& found) const;
  [[nodiscard]] double of_depth(const scenario::Found& found) const;
  [[nodiscard]] double of_overhang() const;
  [[nodiscard]] double of_waves(const scenario::Rung& rung, const scenario::Found& found) const;

  const scenario::Scenario& given_;
  const scenario::Resolved& asked_;
  const SurfaceTouch& touch_;
  const Estimates& e_;
};

// Whether the scenario's mesh is not refined, and has cells that are coarse compared with the
// thickness.
[[nodiscard]] bool coarse_mesh(const scenario::Resolved& scenario, const SurfaceTouch& touch);

}  // namespace palpate::scene
