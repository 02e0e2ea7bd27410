// Which variants of a scenario a chart measures.
//
// Groups of variants (not every combination):
//   base                    what palpate chooses where model, mesh, coupling, integrator, steps and
//                           rings are left open, and the scenario unchanged if that differs
//   model x mesh             every model but `solid`; those with a mesh on the scenario's mesh and
//                           on meshes with a quarter and four times its nodes (a ready mesh is not
//                           changed)
//   model x coupling         models with a mesh, with every coupling, on the scenario's mesh; one
//                           sphere on a cuboid of one tissue also `resolved` on graded cells
//   integrator x time step  every integrator with its default step and with 1/4, 1 and 4 ms in one
//                           substep each; explicit ones also at half their stability limit
//   rings                   2, 3, 5 (all other variants: the whole specimen)
// The last two groups use the model that `auto` chooses or, if that has no mesh, the first model
// with a mesh. Groups 2, 3 and 5 use base_integrator(). A uniform test lacks groups 3 and 5.
#pragma once

#include <string>
#include <vector>

#include "scenario/family.h"

namespace palpate::scene {
class SpecimenShapes;
}

namespace palpate::chart {

// A scenario file with the settings of the command line.
struct Asked {
  std::string path;
  std::string text;
  std::vector<std::string> settings;
  scenario::Family family;
  // What `contact.depth = "auto"` becomes in the cases, as `model = "auto"` has it: for every
  // variant but the scenario as it stands.
  std::vector<scenario::Contact::Depth> depths = {};
};

// Reads a scenario. Throws InputError if it is invalid.
[[nodiscard]] Asked read_asked(const std::string& path, const std::vector<std::string>& settings);
// Reads a scenario for a chart. Throws InputError if it is invalid, has more than 8 cases, sweeps a
// key that the chart varies, or presses to a force (every variant would end at another travel).
[[nodiscard]] Asked read_for_chart(const std::string& path,
                                   const std::vector<std::string>& settings);
// The same, of a text that was read from `path`.
[[nodiscard]] Asked read_for_chart(const std::string& path, const std::string& text,
                                   const std::vector<std::string>& settings);

// Throws InputError with `sentence` at the first step to a force, which would end at another travel
// in every variant and on every mesh.
void refuse_forces(const scenario::Family& family, const std::string& sentence);

// Case `of_case` with further settings, as a family of one case. Throws InputError if invalid.
[[nodiscard]] scenario::Family with_settings(const Asked& asked, std::size_t of_case,
                                             const std::vector<std::string>& settings);

struct Variant {
  std::size_t of_case = 0;
  std::string group;                  // first column of the table above
  std::string name;                   // unique in its case
  std::vector<std::string> settings;  // `key=value`, as for `--set`
};

// The variants of a case, in the order of the table, without those that result in the same resolved
// scenario as an earlier one. `shapes` keeps the meshes made for it. Throws like run::choose().
[[nodiscard]] std::vector<Variant> design(const Asked& asked, std::size_t of_case,
                                          scene::SpecimenShapes& shapes);

// The longest output interval of all variants, s. At these times all variants have rows if the
// steps of the loading history are multiples of it.
[[nodiscard]] double coarsest_interval(const scenario::PlainScenario& scenario);

// The integrator of variants that do not name one: the scenario's, else `quasi_static` for a press
// in which inertia does not matter, without nodal drag, else `central_difference`.
[[nodiscard]] scenario::Solver::Integrator base_integrator(const scenario::Case& one);

// The setting for a mesh with about `factor` times as many nodes; empty for a ready mesh.
[[nodiscard]] std::string mesh_setting(const scenario::Scenario& scenario, double factor);

// `solver.model=WORD`.
[[nodiscard]] std::string model_setting(scenario::Model model);

// The word for a model, an integrator or a coupling in scenarios.
[[nodiscard]] std::string word_of(scenario::Model model);
[[nodiscard]] std::string word_of(scenario::Solver::Integrator integrator);
[[nodiscard]] std::string word_of(contact::Coupling coupling);

}  // namespace palpate::chart
