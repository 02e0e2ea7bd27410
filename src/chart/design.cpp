// Makes variants as texts of settings, so that they pass the same checks as `--set`.
#include "chart/design.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/fields.h"
#include "base/files.h"
#include "base/text.h"
#include "run/choose.h"
#include "run/refined_mesh.h"
#include "scenario/integrators.h"
#include "scenario/programme.h"
#include "scenario/words.h"
#include "scene/estimates.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"
#include "scene/time_plan.h"

namespace palpate::chart {
namespace {

using scenario::Model;
using Integrator = scenario::Solver::Integrator;
using Settings = std::vector<std::string>;
using scenario::Scenario;
namespace words = scenario::words;

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

constexpr double mesh_factors[] = {0.25, 4.0};        // times the scenario's number of nodes
constexpr double time_steps_ms[] = {0.25, 1.0, 4.0};  // a haptic frame is 1 ms
constexpr int ring_counts[] = {2, 3, 5};
constexpr Integrator moving = Integrator::central_difference;
constexpr double cells_a_contact_radius = 3.5;  // `resolved` requires 3

std::string text_of_cells(const char* kind, const std::array<int, 3>& cells, double grading) {
  std::string text = std::string("tissue.mesh={kind='") + kind + "',cells=[";
  for (std::size_t axis = 0; axis < 3; ++axis)
    text += (axis > 0 ? "," : "") + std::to_string(cells[axis]);
  text += "]";
  if (grading != 1.0) text += ",grading=" + number_text(grading);
  return text + "}";
}

std::array<int, 3> scaled(std::array<int, 3> cells, double factor) {
  for (int& cell : cells)
    cell = std::max(1, static_cast<int>(std::lround(cell * std::cbrt(factor))));
  return cells;
}

// The setting for cells of which `smallest` lie in a contact radius (m) under the finger, and which
// grow with the distance from it; empty unless one sphere presses a cuboid of one tissue without a
// ready mesh.
std::string graded_mesh_setting(const Scenario& scenario, double radius, double smallest) {
  const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape);
  if (box == nullptr || !scenario.regions.empty() || scenario.finger.spheres != 1 ||
      std::holds_alternative<scenario::MeshFile>(scenario.tissue.mesh))
    return "";
  const double place[] = {scenario.finger.x.value_or(0.5 * box->size[0]),
                          scenario.finger.y.value_or(0.5 * box->size[1]), box->size[2]};
  std::array<int, 3> cells{};
  double farthest = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double units = 0.0;  // a cell at distance d is sqrt(1 + (d/a)^2) times the smallest one
    for (const double length : {place[axis], box->size[axis] - place[axis]}) {
      units += std::asinh(length / radius);
      farthest = std::max(farthest, length);
    }
    cells[axis] = static_cast<int>(std::ceil(units * smallest));
  }
  const double grading = std::sqrt(1.0 + farthest * farthest / (radius * radius));
  return text_of_cells("mirrored", cells, std::round(10.0 * grading) / 10.0);
}

// The smallest common multiple of output interval and step, both in ms, below ten intervals; if
// there is none, the multiple of the step that is nearest to the interval.
double rows_of(double step_ms, double interval_ms) {
  for (int times = 1; times < 10; ++times) {
    const double pieces = times * interval_ms / step_ms;
    if (pieces > 0.5 && std::abs(pieces - std::round(pieces)) < 1e-9 * pieces)
      return times * interval_ms;
  }
  return std::max(1.0, std::round(interval_ms / step_ms)) * step_ms;
}

// Settings for time steps of this length (ms) without substeps; `interval` in s.
Settings one_step(double step_ms, double interval) {
  const double rows_ms = rows_of(step_ms, 1e3 * interval);
  Settings settings{"solver.time_step=" + number_text(step_ms) + " ms", "solver.substeps=1"};
  if (std::abs(rows_ms - 1e3 * interval) > 1e-9 * rows_ms)
    settings.push_back("output.interval=" + rounded_text(rows_ms, 12) + " ms");
  return settings;
}

// The settings that leave to palpate what it chooses by itself: model, coupling, mesh and steps.
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

// Case `of_case` with these.
scenario::Case opened(const Asked& asked, std::size_t of_case) {
  Settings all = asked.settings;
  for (const std::string& one : left_open(asked.family.cases[of_case].scenario)) all.push_back(one);
  return scenario::parse_case(asked.text, asked.path, all, of_case).cases.front();
}

class Designer {
 public:
  Designer(const Asked& asked, std::size_t of_case, scene::SpecimenShapes& shapes)
      : asked_(asked),
        case_(of_case),
        one_(asked.family.cases[of_case]),
        base_(one_.scenario),
        shapes_(shapes) {
    meshed_ = run::choose(opened(asked, of_case)).chosen.solver.model;
    if (!scenario::traits(meshed_).meshed())
      meshed_ =
          std::ranges::find_if(scenario::model_table, std::mem_fn(&scenario::ModelTraits::meshed))
              ->of;
    integrator_ = word_of(base_integrator(one_));
  }

  std::vector<Variant> all() {
    const Settings open = left_open(base_);
    add("base", "auto", open);
    if (!open.empty()) add("base", "as it stands", {});
    for (const scenario::ModelTraits& traits : scenario::model_table)
      if (traits.meshed() && !traits.solid)
        meshes(traits.of);
      else if (!traits.solid)
        formulas(traits.of);
    for (const scenario::ModelTraits& traits : scenario::model_table)
      if (traits.meshed() && !traits.solid && !base_.uniform()) couplings(traits.of);
    if (!compresses(base_)) integrators();
    if (!base_.uniform())
      for (const int rings : ring_counts)
        add("rings", word_of(meshed_) + ", " + std::to_string(rings) + " rings",
            joined_to(settings_of(meshed_), {"solver.rings=" + std::to_string(rings)}));
    return variants_;
  }

 private:
  static Settings joined_to(Settings settings, const Settings& more) {
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
  }

  // `auto` finds out that a press is deep; a model that is given has to be told.
  [[nodiscard]] Settings given(Model model, contact::Coupling coupling) const {
    Settings settings{model_setting(model)};
    if (asked_.depths[case_] == scenario::Contact::Depth::neo_hookean && !base_.contact.depth &&
        !contact::mesh_is_tissue(coupling))
      settings.emplace_back("contact.depth=neo_hookean");
    return settings;
  }
  [[nodiscard]] Settings given(Model model) const { return given(model, base_.contact.coupling); }

  [[nodiscard]] Settings settings_of(Model model) const {
    return joined_to(given(model), {"solver.integrator=" + integrator_});
  }

  // The resolved scenario of a variant as text; the settings themselves if they are invalid.
  [[nodiscard]] std::string settled(const Settings& settings) const {
    try {
      const auto family = with_settings(asked_, case_, settings);
      const scenario::Case& one = family.cases.front();
      Scenario chosen = scenario::answered(one, run::choose(one, shapes_).chosen);
      return fields_as_toml([&](FieldVisitor& visitor) { fields(visitor, chosen); });
    } catch (const InputError&) {
      return joined(settings, "\n");
    }
  }

  void add(const std::string& group, const std::string& name, const Settings& settings) {
    if (seen_.insert(settled(settings)).second) variants_.push_back({case_, group, name, settings});
  }

  void formulas(Model model) { add("model x mesh", word_of(model), given(model)); }

  void meshes(Model model) {
    add("model x mesh", word_of(model), settings_of(model));
    for (const double factor : mesh_factors)
      if (const std::string mesh = mesh_setting(base_, factor); !mesh.empty())
        add("model x mesh", word_of(model) + ", nodes x " + number_text(factor),
            joined_to(settings_of(model), {mesh}));
  }

  void couplings(Model model) {
    const auto coupled = [&](contact::Coupling coupling) {
      return joined_to(given(model, coupling), {"solver.integrator=" + integrator_,
                                                "contact.coupling=" + word_of(coupling)});
    };
    using contact::Coupling;
    for (const Coupling coupling :
         {Coupling::one_way, Coupling::series, Coupling::consistent, Coupling::resolved})
      add("model x coupling", word_of(model) + ", " + word_of(coupling), coupled(coupling));
    const std::string mesh = graded_mesh_setting(base_, run::choose(one_).expected.contact_radius,
                                                 cells_a_contact_radius);
    if (!mesh.empty())
      add("model x coupling", word_of(model) + ", resolved on graded cells",
          joined_to(coupled(Coupling::resolved), {mesh}));
  }

  // Whether the force depends on the motion of the mesh, so that steps change it.
  [[nodiscard]] bool steps_matter() const {
    if (base_.uniform() || contact::mesh_is_tissue(base_.contact.coupling)) return true;
    try {
      const auto family = with_settings(
          asked_, case_, {model_setting(meshed_), "solver.integrator=" + word_of(moving)});
      return scene::inertia_reaches_force(run::choose(family.cases.front(), shapes_).chosen);
    } catch (const InputError&) {
      return true;  // the variants say why there is no mesh
    }
  }

  void integrators() {
    if (!steps_matter()) return;
    const std::string model = word_of(meshed_);
    for (const Word& word : words::integrators) {
      const std::string method = word.word;
      const std::string name = model + ", " + method;
      const Settings settings = joined_to(given(meshed_), {"solver.integrator=" + method});
      add("integrator x time step", name, settings);
      const std::optional<scene::TimePlan> plan = plan_of(settings);
      if (plan && cut_by_limit(settings, *plan))
        add("integrator x time step", name + ", half the limit",
            joined_to(settings, {"solver.substeps=" +
                                 number_text(std::ceil(plan->time_step / (0.5 * *plan->limit)))}));
      for (const double step : time_steps_ms) {
        const bool own = plan && std::abs(1e3 * plan->substep - step) < 1e-9 * step;
        if (!own)
          add("integrator x time step", name + ", " + number_text(step) + " ms",
              joined_to(settings, one_step(step, base_.output.interval)));
      }
    }
  }

  // The time plan of a variant; nothing if it is invalid or has no mesh.
  [[nodiscard]] std::optional<scene::TimePlan> plan_of(const Settings& settings) const {
    try {
      const auto family = with_settings(asked_, case_, settings);
      const scene::Scene scene = run::build_scene(family.cases.front(), family, shapes_);
      if (scene.specimen) return scene.specimen->plan;
    } catch (const InputError&) {
    } catch (const MeshError&) {
    }
    return std::nullopt;
  }

  // Whether the stability limit determines the default substeps: a step well above it is refused.
  [[nodiscard]] bool cut_by_limit(const Settings& settings, const scene::TimePlan& plan) const {
    if (!plan.limit ||
        plan.substeps != static_cast<int>(std::ceil(plan.time_step / (0.9 * *plan.limit))))
      return false;
    const std::string bold = number_text(4e3 * *plan.limit) + " ms";
    return !plan_of(joined_to(
        settings, {"solver.time_step=" + bold, "solver.substeps=1", "output.interval=" + bold}));
  }

  const Asked& asked_;
  std::size_t case_;
  const scenario::Case& one_;
  const Scenario& base_;  // of one_
  scene::SpecimenShapes& shapes_;
  // The model of the groups integrator x time step and rings.
  Model meshed_ = scenario::strongest.of;
  std::string integrator_;
  std::vector<Variant> variants_;
  std::set<std::string> seen_;
};

}  // namespace

void refuse_forces(const scenario::Family& family, const std::string& sentence) {
  const std::vector<scenario::Step>& steps = family.base.steps;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (const auto* indent = std::get_if<scenario::Indent>(&steps[i]);
        indent != nullptr && indent->to.second)
      throw InputError(place_of(family.document, "step." + std::to_string(i + 1) + ".to"),
                       sentence);
}

namespace {

Asked parsed(const std::string& path, const std::string& text, const Settings& settings) {
  Asked asked{path, text, settings, scenario::parse(text, path, settings)};
  for (std::size_t i = 0; i < asked.family.cases.size(); ++i) {
    const scene::Choice choice = run::choose(asked.family.cases[i]);
    // The reference of a press with inertia is linear elasticity on a mesh.
    const bool still = !choice.chosen.meshed() || !about(choice.chosen.solver.integrator).inertia;
    asked.depths.push_back(still ? run::choose(opened(asked, i)).chosen.contact.depth
                                 : scenario::Contact::Depth::hertz);
  }
  return asked;
}

}  // namespace

Asked read_asked(const std::string& path, const Settings& settings) {
  const std::string found = scenario::file_of(path);
  return parsed(found, read_text(found), settings);
}

Asked read_for_chart(const std::string& path, const Settings& settings) {
  const std::string found = scenario::file_of(path);
  return read_for_chart(found, read_text(found), settings);
}

Asked read_for_chart(const std::string& path, const std::string& text, const Settings& settings) {
  const scenario::Family family = scenario::parse(text, path, settings);
  if (family.cases.size() > most_cases)
    throw InputError(place_of(family.document, "sweep"),
                     "`palpate chart` measures up to " + std::to_string(most_cases) +
                         " cases, and `sweep` makes " + std::to_string(family.cases.size()) +
                         "; give shorter lists");
  refuse_own_keys(family);
  refuse_forces(family,
                "a step to a force ends elsewhere in every configuration, and `palpate chart` "
                "compares forces at equal displacements; give a displacement");
  return parsed(path, text, settings);
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

std::string model_setting(Model model) { return "solver.model=" + word_of(model); }
std::string word_of(Model model) { return scenario::traits(model).word; }
std::string word_of(Integrator integrator) { return words::word(words::integrators, integrator); }
std::string word_of(contact::Coupling coupling) { return words::word(words::couplings, coupling); }

std::string mesh_setting(const Scenario& scenario, double factor) {
  const scenario::Mesh& mesh = scenario.tissue.mesh;
  if (const auto* kuhn = std::get_if<scenario::Kuhn>(&mesh))
    return text_of_cells("kuhn", scaled(kuhn->cells, factor), kuhn->grading);
  if (const auto* mirrored = std::get_if<scenario::Mirrored>(&mesh))
    return text_of_cells("mirrored", scaled(mirrored->cells, factor), mirrored->grading);
  const auto* tetgen = std::get_if<scenario::Tetgen>(&mesh);
  if (tetgen == nullptr) return "";
  if (tetgen->edge)
    return "tissue.mesh={kind='tetgen',edge='" +
           number_text(1e3 * *tetgen->edge / std::cbrt(factor)) + " mm'}";
  return "tissue.mesh={kind='tetgen',nodes=" +
         std::to_string(std::max(8L, std::lround(factor * tetgen->nodes))) + "}";
}

std::vector<Variant> design(const Asked& asked, std::size_t of_case,
                            scene::SpecimenShapes& shapes) {
  return Designer(asked, of_case, shapes).all();
}

double coarsest_interval(const scenario::PlainScenario& scenario) {
  double interval = scenario.output.interval;
  for (const double step : time_steps_ms)
    interval = std::max(interval, 1e-3 * rows_of(step, 1e3 * scenario.output.interval));
  return interval;
}

Integrator base_integrator(const scenario::Case& one) {
  const Scenario& scenario = one.scenario;
  const scenario::Solver& solver = scenario.solver;
  if (solver.integrator) return *solver.integrator;
  const bool drag = scenario.tissue.viscosity == tissue::Viscosity::nodal_drag;
  if (drag) return Integrator::central_difference;
  if (scenario.uniform()) return Integrator::quasi_static;
  return run::choose(one).expected.inertia < solver.tolerance ? Integrator::quasi_static
                                                              : Integrator::central_difference;
}

}  // namespace palpate::chart
