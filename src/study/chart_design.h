// Which variants of a scenario a chart measures.
//
// Not every combination: a base, single variations of it, and the products that matter.
//   base                    what `auto` takes, and the scenario as it stands where that differs
//   rung x mesh             hertz, layer; mass_spring and coupled_springs on the scenario's mesh, a
//                           quarter and four times its nodes (a ready mesh stays as it is)
//   rung x coupling         both mesh rungs with every coupling, on the scenario's mesh, and
//                           `resolved` on cells that are graded for it where the body is a cuboid
//   integrator x time step  every integrator of scenario::words, with its own step, with 1/4, 1 and
//                           4 ms in one substep each, explicit ones also at half their limit
//   rings                   2, 3, 5 (else all)
// The last two are of the mesh rung that `auto` takes, or of mass_spring where it takes none; all
// but the third use the scenario's integrator, or quasi_static where inertia does not matter.
// A uniform test has no couplings and no rings.
#pragma once

#include <string>
#include <vector>

#include "scenario/family.h"

namespace palpate::study {

// A scenario file and what was set on the command line, read.
struct Asked {
  std::string path;
  std::string text;
  std::vector<std::string> settings;
  scenario::Family family;
};

// Reads a scenario for a chart. Throws InputError where it cannot be read, has more than 8 cases,
// sweeps what the chart varies itself, or presses to a force, which ends elsewhere in every
// variant.
[[nodiscard]] Asked read_for_chart(const std::string& path,
                                   const std::vector<std::string>& settings);

struct Variant {
  std::size_t of_case = 0;
  std::string group;                  // a line of the table above
  std::string name;                   // for people, one of its kind in its case
  std::vector<std::string> settings;  // `key=value`, what `--set` would say
};

// The variants of a case, in the table's order, without those that settle on the very scenario of
// one before. Throws as scene::build() does where the base itself cannot be built.
[[nodiscard]] std::vector<Variant> design(const Asked& asked, std::size_t of_case);

// The scenario with more settings, as a family of this one case. Throws InputError where it is
// refused.
[[nodiscard]] scenario::Family with_settings(const Asked& asked, std::size_t of_case,
                                             const std::vector<std::string>& settings);

// The rows of the variant that has the fewest, s apart; those of all others lie there too, where
// the programme's steps are whole numbers of it long.
[[nodiscard]] double coarsest_interval(const scenario::Scenario& scenario);

// The steps' integrator of the mesh rungs where a variant does not say its own.
[[nodiscard]] scenario::Solver::Integrator base_integrator(const scenario::Scenario& scenario);

// The word of one of scenario::words for a model, coupling or integrator.
[[nodiscard]] std::string word_of(scenario::Solver::Model model);
[[nodiscard]] std::string word_of(scenario::Solver::Integrator integrator);
[[nodiscard]] std::string word_of(contact::Coupling coupling);

}  // namespace palpate::study
