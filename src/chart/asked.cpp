// Reads scenarios for a chart, and sets the keys of its variants.
#include "chart/asked.h"

#include "base/files.h"
#include "run/choose.h"
#include "scenario/find.h"
#include "scenario/integrators.h"
#include "scene/scene.h"

namespace palpate::chart {
namespace {

using Settings = std::vector<std::string>;

constexpr std::size_t most_cases = 8;

// The keys that a chart varies.
constexpr const char* own_keys[] = {"solver.model",    "solver.integrator", "solver.time_step",
                                    "solver.substeps", "solver.rings",      "contact.coupling",
                                    "tissue.mesh",     "output.interval"};

void refuse_own_keys(const scenario::Family& family) {
  for (const scenario::Setting& swept : family.design.settings(0))
    for (const char* own : own_keys)
      if (swept.key == own || swept.key.starts_with(std::string(own) + "."))
        throw InputError(swept.value.place,
                         "`" + swept.key + "` is swept, and `palpate chart` varies `" + own +
                             "` itself; set it to one value, with `[sweep]` without it");
}

}  // namespace

Settings left_open(const scenario::Scenario& scenario) {
  const scenario::Solver& solver = scenario.solver;
  Settings open;
  if (solver.model) open.emplace_back("solver.model=auto");
  if (solver.integrator) open.emplace_back("solver.integrator=auto");
  if (solver.time_step) open.emplace_back("solver.time_step=auto");
  if (solver.substeps) open.emplace_back("solver.substeps=auto");
  if (solver.rings) open.emplace_back("solver.rings=all");
  const scenario::Mesh& mesh = scenario.tissue.mesh;
  if (!std::holds_alternative<scenario::MeshFile>(mesh) &&
      !std::holds_alternative<scenario::HalfSpace>(scenario.tissue.shape) &&
      !refinement(mesh).refine)
    open.push_back(std::string("tissue.mesh={kind='") +
                   std::visit([](const auto& kind) { return kind.word.word; },
                              scenario::mesh_left_open(scenario)) +
                   "',refine=true}");
  if (!scenario.uniform() && scenario.contact.coupling != contact::Coupling::consistent) {
    open.emplace_back("contact.coupling=consistent");
    // Only `consistent` takes the viscosity of the tissue into the contact by default.
    if (scenario.contact.viscosity == scenario::Contact::Viscosity::none)
      open.emplace_back("contact.viscosity=none");
  }
  return open;
}

scenario::Case opened(const Asked& asked, std::size_t of_case) {
  Settings all = asked.settings;
  for (const std::string& one : left_open(asked.family.cases[of_case].scenario)) all.push_back(one);
  return scenario::parse_case(asked.text, asked.path, all, of_case).cases.front();
}

void refuse_forces(const scenario::Family& family, std::span<const scenario::Step> steps,
                   const std::string& sentence) {
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (const auto* indent = std::get_if<scenario::Indent>(&steps[i]);
        indent != nullptr && indent->to.second)
      throw InputError(place_of(family.document, "step." + std::to_string(i + 1) + ".to"),
                       sentence);
}

Asked read_for_chart(const std::string& path, const Settings& settings) {
  const std::string found = scenario::find(path);
  return read_for_chart(found, read_text(found), settings);
}

Asked read_for_chart(const std::string& path, const std::string& text, const Settings& settings) {
  Asked asked{path, text, settings, scenario::parse(text, path, settings)};
  const scenario::Family& family = asked.family;
  if (family.cases.size() > most_cases)
    throw InputError(place_of(family.document, "sweep"),
                     "`palpate chart` measures up to " + std::to_string(most_cases) +
                         " cases, and `sweep` makes " + std::to_string(family.cases.size()) +
                         "; give shorter lists");
  refuse_own_keys(family);
  refuse_forces(
      family, family.base.steps,
      "a step to a force ends elsewhere in every variant, and `palpate chart` compares forces at "
      "equal travels; give a travel");
  for (std::size_t i = 0; i < family.cases.size(); ++i) {
    const scene::Choice choice = run::choose(family.cases[i]);
    // The reference of a press with inertia is linear elasticity on a mesh.
    const bool still = !choice.chosen.meshed() || !about(choice.chosen.solver.integrator).inertia;
    asked.depths.push_back(still ? run::choose(opened(asked, i)).chosen.contact.depth
                                 : scenario::Contact::Depth::hertz);
  }
  return asked;
}

scenario::Family with_settings(const Asked& asked, std::size_t of_case, const Settings& settings) {
  Settings all = asked.settings;
  all.insert(all.end(), settings.begin(), settings.end());
  scenario::Family family = scenario::parse_case(asked.text, asked.path, all, of_case);
  family.cases.front().name = asked.family.cases[of_case].name;
  scenario::Scenario& scenario = family.cases.front().scenario;
  scenario::Contact& contact = scenario.contact;
  const bool as_it_stands = settings.empty() && scenario.solver.model;
  if (!as_it_stands && !contact.depth && !contact::mesh_is_tissue(contact.coupling))
    contact.depth = asked.depths[of_case];
  return family;
}

}  // namespace palpate::chart
