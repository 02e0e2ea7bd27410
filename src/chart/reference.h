// A reference solution of a press: `solid` on several meshes, extrapolated, and its inertia.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chart/design.h"
#include "chart/history.h"
#include "record/table.h"
#include "run/displaced_surface.h"

namespace palpate::chart {

struct ReferenceRow {
  int step = 0;                     // counted from 1
  double time = 0.0;                // s
  double travel = 0.0;              // m
  double slide = 0.0;               // m
  std::vector<double> forces = {};  // N, contact force of every level of a press that moves
  double force = 0.0;               // N, extrapolated
  double error = 0.0;               // N, bound of the change by further refinement
  double order = 0.0;               // observed order of convergence; 0: none
};

struct Reference {
  std::vector<ReferenceRow> rows;
  std::vector<std::string> warnings;    // sentences on the method and the remaining error
  std::string how;                      // at rest: the first of them, without its beginning
  bool moves = false;                   // with the tissue's inertia throughout
  std::optional<std::string> diverged;  // the reason why it could not be completed
};

// The most rows of a press without and with viscosity or inertia.
struct MostRows {
  double still = 40.0;
  double in_time = 1e6;
};

// Computes the reference of a press. Without inertia it is `solid` on three meshes, extrapolated,
// with its own error; a viscous contact follows its law of time. Where the estimated effect of
// inertia is more than a tenth of the tolerance, what it adds to an elastic press by coupled
// springs on a mesh with four times the scenario's nodes is included; its error is the difference
// to the scenario's own mesh; without such meshes and for slides the estimate counts as an error.
// Where the scenario names an integrator with inertia, or inertia reaches the tolerance: coupled
// springs with volumes averaged at nodes on three meshes, by backward differences whose steps
// shrink with the cells, extrapolated; with `resolved` contact on graded cells if one sphere
// presses a cuboid of one tissue (only a half or a quarter of it if the scene is symmetric). Says
// its stage by set_doing(). Throws InputError if there is nothing to refine (uniform tests,
// half-spaces, slides at a constant force; with inertia ready meshes and steps to a force),
// Stopped, and like scene::build().                                  docs/theory.md
// [extrapolation], [solid_force]
[[nodiscard]] Reference refer(const Asked& asked, std::size_t of_case, const MostRows& most = {});

// The displaced surface of a press at rest by `solid` on two meshes. No pieces for uniform tests
// and half-spaces, where the estimated effect of inertia reaches the tolerance, and where `solid`
// finds no mesh or no equilibrium. Throws InputError and Stopped.
[[nodiscard]] run::SurfaceReference refer_surface(const Asked& asked, std::size_t of_case);

// One row per moment: case, step, time_s, travel_mm, slide_mm, contact_force_N, error_N, order, and
// the forces of the levels, level_1_N...
[[nodiscard]] record::Table reference_table(
    const std::vector<std::pair<std::string, Reference>>& cases);

// The result of case `of_case` with further settings, and the nodes of its mesh (0 without one).
// Throws MeshError if the run diverges, Stopped, and like with_settings() and scene::build().
struct Ran {
  History moments;
  int nodes = 0;
};
[[nodiscard]] Ran run_with(const Asked& asked, std::size_t of_case,
                           const std::vector<std::string>& settings);

}  // namespace palpate::chart
