// A reference solution of a press: the strongest model on several meshes, extrapolated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "record/table.h"
#include "scenario/family.h"

namespace palpate::chart {

struct ReferenceRow {
  int step = 0;                     // counted from 1
  double time = 0.0;                // s
  double travel = 0.0;              // m
  double slide = 0.0;               // m
  std::vector<double> forces = {};  // N, contact force of every level
  double force = 0.0;               // N, extrapolated
  double error = 0.0;               // N, bound of the change by further refinement
  double order = 0.0;               // observed order of convergence; 0: none
  double by_sphere = 1.0;           // force along the sphere's normals over the surface's
};

struct Reference {
  std::vector<ReferenceRow> rows;
  bool moves = false;                   // with the tissue's inertia
  std::vector<std::string> remarks;     // sentences on the method and the remaining error
  std::optional<std::string> diverged;  // the reason why a level could not be completed
};

// Computes the reference of a press. Without inertia it is `solid` on three meshes, extrapolated,
// with its own error; a viscous contact follows its law of time. Where the scenario names an
// integrator with inertia, or inertia reaches the tolerance: coupled springs with volumes averaged
// at nodes on `levels` (2 or more) meshes, by backward differences whose steps shrink with the
// cells, extrapolated; with `resolved` contact on graded cells if one sphere presses a cuboid of
// one tissue (only a half or a quarter of it if the scene is symmetric). Says its level by
// set_doing(). Throws InputError if there is nothing to refine (uniform tests,
// half-spaces, slides at a constant force; with inertia ready meshes and steps to a force),
// Stopped, and like scene::build().
//                                                     docs/theory.md [extrapolation], [solid_force]
[[nodiscard]] Reference refer(const scenario::Case& one, const scenario::Family& family,
                              int levels);

// One row per moment: case, step, time_s, travel_mm, slide_mm, contact_force_N, error_N, order,
// sphere_over_skin (1 if contact is not resolved), and the forces of the levels, level_1_N...
[[nodiscard]] record::Table reference_table(
    const std::vector<std::pair<std::string, Reference>>& cases);

}  // namespace palpate::chart
