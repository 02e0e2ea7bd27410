// The strongest rung on refined meshes, extrapolated: what other answers are measured by.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "record/table.h"
#include "scenario/family.h"

namespace palpate::run {

struct ReferenceLevel {
  int nodes = 0;
  double spacing = 0.0;           // of the contact radius, or of the first level's
  double cells_per_radius = 0.0;  // at the deepest travel; 0 where the contact is not resolved
};

struct ReferenceRow {
  int step = 0;                     // counted from 1
  double time = 0.0;                // s
  double travel = 0.0;              // m
  double slide = 0.0;               // m
  std::vector<double> forces = {};  // N, contact force of every level
  double force = 0.0;               // N, extrapolated
  double error = 0.0;               // N, that refinement may still change
  double order = 0.0;               // observed; 0: none
  double by_sphere = 1.0;           // times the force with the sphere's normals, on the first level
};

struct Reference {
  std::vector<ReferenceLevel> levels;
  std::vector<ReferenceRow> rows;
  std::vector<std::string> remarks;     // sentences on what was done, and on what stays open
  std::optional<std::string> diverged;  // why a level did not come to its end
};

// Coupled springs with a volume term averaged at nodes, on `levels` (2 or more) meshes:
//   `resolved` on graded cells where one sphere presses a cuboid of one tissue, over a half or a
//   quarter of it where the scene is its own mirror image,
//   `consistent` on ever finer meshes otherwise.
// Without inertia, unless the scenario names an integrator that has it or estimates say that it
// matters; then by backward differences whose steps shrink with the cells. `told` hears of every
// level. Throws InputError where there is nothing to refine, and what scene::build() throws.
// docs/theory.md (77), (78)
[[nodiscard]] Reference refer(const scenario::Case& one, const scenario::Family& family, int levels,
                              const std::atomic<bool>& stop,
                              const std::function<void(const std::string&)>& told);

// One row a moment: case, step, time_s, travel_mm, slide_mm, contact_force_N, error_N, order, the
// levels' level_1_N..., and sphere_over_skin where contact is resolved.
[[nodiscard]] record::Table reference_table(
    const std::vector<std::pair<std::string, Reference>>& cases);

}  // namespace palpate::run
