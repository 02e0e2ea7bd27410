// Settings as texts, so that every variant passes the same checks as a person's `--set`.
#include "study/chart_design.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/field_writer.h"
#include "base/files.h"
#include "base/text.h"
#include "scenario/words.h"
#include "scene/estimates.h"
#include "scene/scene.h"

namespace palpate::study {
namespace {

using Model = scenario::Solver::Model;
using Integrator = scenario::Solver::Integrator;
using Settings = std::vector<std::string>;
using scenario::Scenario;
namespace words = scenario::words;

constexpr std::size_t most_cases = 8;
constexpr double mesh_factors[] = {0.25, 4.0};        // of the scenario's nodes
constexpr double time_steps_ms[] = {0.25, 1.0, 4.0};  // shares and multiples of a haptic frame
constexpr int ring_counts[] = {2, 3, 5};
constexpr double cells_a_contact_radius = 3.5;  // `resolved` asks for 3

// What a chart sets itself.
constexpr const char* own_keys[] = {"solver.model",    "solver.integrator", "solver.time_step",
                                    "solver.substeps", "solver.rings",      "contact.coupling",
                                    "tissue.mesh",     "output.interval"};

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

// The setting that makes a mesh of `factor` times as many nodes; empty where there is none.
std::string finer(const Scenario& scenario, double factor) {
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

// Cells under the finger that `resolved` is content with, growing beyond the contact; empty where
// the body is no cuboid of one tissue, or the finger more than one sphere.
std::string graded(const Scenario& scenario, const scene::Estimates& found) {
  const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape);
  if (box == nullptr || !scenario.regions.empty() || scenario.finger.spheres != 1 ||
      std::holds_alternative<scenario::MeshFile>(scenario.tissue.mesh))
    return "";
  const double radius = found.contact_radius;
  const double place[] = {scenario.finger.x.value_or(0.5 * box->size[0]),
                          scenario.finger.y.value_or(0.5 * box->size[1]), box->size[2]};
  std::array<int, 3> cells{};
  double farthest = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double units = 0.0;  // a cell at distance d has sqrt(1 + (d/a)^2) of the least one's side
    for (const double length : {place[axis], box->size[axis] - place[axis]}) {
      units += std::asinh(length / radius);
      farthest = std::max(farthest, length);
    }
    cells[axis] = static_cast<int>(std::ceil(units * cells_a_contact_radius));
  }
  const double grading = std::sqrt(1.0 + farthest * farthest / (radius * radius));
  return text_of_cells("mirrored", cells, std::round(10.0 * grading) / 10.0);
}

// The least multiple of the output interval that is one of the step too, both in ms; where there is
// none below ten, the nearest multiple of the step.
double rows_of(double step_ms, double interval_ms) {
  for (int times = 1; times < 10; ++times) {
    const double pieces = times * interval_ms / step_ms;
    if (pieces > 0.5 && std::abs(pieces - std::round(pieces)) < 1e-9 * pieces)
      return times * interval_ms;
  }
  return std::max(1.0, std::round(interval_ms / step_ms)) * step_ms;
}

// A step of so many ms in one piece.
Settings one_step(double step_ms, double interval) {
  const double rows_ms = rows_of(step_ms, 1e3 * interval);
  Settings settings{"solver.time_step=" + number_text(step_ms) + " ms", "solver.substeps=1"};
  if (std::abs(rows_ms - 1e3 * interval) > 1e-9 * rows_ms)
    settings.push_back("output.interval=" + rounded_text(rows_ms, 12) + " ms");
  return settings;
}

class Designer {
 public:
  Designer(const Asked& asked, std::size_t of_case)
      : asked_(asked), case_(of_case), base_(asked.family.cases[of_case].scenario) {
    Scenario open = base_;
    open.solver.model = Model::automatic;
    open.solver.integrator = Integrator::automatic;
    const scene::Choice choice = scene::choose(open);
    rung_ = choice.chosen.solver.model;
    if (rung_ != Model::coupled_springs) rung_ = Model::mass_spring;
    integrator_ = word_of(base_integrator(base_));
  }

  std::vector<Variant> all() {
    const Settings open =
        base_.solver.model == Model::automatic ? Settings{} : Settings{"solver.model=auto"};
    add("base", "auto", open);
    if (!open.empty()) add("base", "as it stands", {});
    for (const Model model : {Model::hertz, Model::layer})
      add("rung x mesh", word_of(model), {"solver.model=" + word_of(model)});
    for (const Model model : {Model::mass_spring, Model::coupled_springs}) meshes(model);
    if (!base_.uniform())
      for (const Model model : {Model::mass_spring, Model::coupled_springs}) couplings(model);
    integrators();
    if (!base_.uniform())
      for (const int rings : ring_counts)
        add("rings", word_of(rung_) + ", " + std::to_string(rings) + " rings",
            joined_to(rung(rung_), {"solver.rings=" + std::to_string(rings)}));
    return variants_;
  }

 private:
  static Settings joined_to(Settings settings, const Settings& more) {
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
  }

  [[nodiscard]] Settings rung(Model model) const {
    return {"solver.model=" + word_of(model), "solver.integrator=" + integrator_};
  }

  // What a variant settles on, as text; refused ones count as themselves.
  [[nodiscard]] std::string settled(const Settings& settings) const {
    try {
      const auto family = with_settings(asked_, case_, settings);
      Scenario chosen = scene::choose(family.cases.front().scenario).chosen;
      return fields_as_toml([&](FieldVisitor& visitor) { fields(visitor, chosen); });
    } catch (const InputError&) {
      return joined(settings, "\n");
    }
  }

  void add(const std::string& group, const std::string& name, const Settings& settings) {
    if (seen_.insert(settled(settings)).second) variants_.push_back({case_, group, name, settings});
  }

  void meshes(Model model) {
    add("rung x mesh", word_of(model), rung(model));
    for (const double factor : mesh_factors)
      if (const std::string mesh = finer(base_, factor); !mesh.empty())
        add("rung x mesh", word_of(model) + ", nodes x " + number_text(factor),
            joined_to(rung(model), {mesh}));
  }

  void couplings(Model model) {
    using contact::Coupling;
    for (std::size_t i = 0; i < words::couplings.size(); ++i) {
      const std::string coupling = words::couplings[i].word;
      add("rung x coupling", word_of(model) + ", " + coupling,
          joined_to(rung(model), {"contact.coupling=" + coupling}));
    }
    const std::string mesh = graded(base_, scene::estimate(base_));
    if (!mesh.empty())
      add("rung x coupling", word_of(model) + ", resolved on graded cells",
          joined_to(rung(model), {"contact.coupling=resolved", mesh}));
  }

  void integrators() {
    const std::string model = word_of(rung_);
    for (const Word& word : words::integrators) {
      const std::string method = word.word;
      if (method == "auto") continue;
      const std::string name = model + ", " + method;
      const Settings settings{"solver.model=" + model, "solver.integrator=" + method};
      add("integrator x time step", name, settings);
      const std::optional<scene::TimePlan> plan = plan_of(settings);
      if (plan && cut_by_limit(settings, *plan))
        add("integrator x time step", name + ", half the limit",
            joined_to(settings, {"solver.substeps=" +
                                 number_text(std::ceil(plan->time_step / (0.5 * plan->limit)))}));
      for (const double step : time_steps_ms) {
        const bool own = plan && std::abs(1e3 * plan->substep - step) < 1e-9 * step;
        if (!own)
          add("integrator x time step", name + ", " + number_text(step) + " ms",
              joined_to(settings, one_step(step, base_.output.interval)));
      }
    }
  }

  // What the variant would step; nothing where it is refused or has no mesh.
  [[nodiscard]] std::optional<scene::TimePlan> plan_of(const Settings& settings) const {
    try {
      const auto family = with_settings(asked_, case_, settings);
      const scene::Scene scene = scene::build(family.cases.front(), family);
      if (scene.specimen) return scene.specimen->plan;
    } catch (const InputError&) {
    } catch (const MeshError&) {
    }
    return std::nullopt;
  }

  // Whether the method's own substeps follow from the stability limit: a step well above it is
  // refused.
  [[nodiscard]] bool cut_by_limit(const Settings& settings, const scene::TimePlan& plan) const {
    if (plan.substeps != static_cast<int>(std::ceil(plan.time_step / (0.9 * plan.limit))))
      return false;
    const std::string bold = number_text(4e3 * plan.limit) + " ms";
    return !plan_of(joined_to(
        settings, {"solver.time_step=" + bold, "solver.substeps=1", "output.interval=" + bold}));
  }

  const Asked& asked_;
  std::size_t case_;
  const Scenario& base_;
  Model rung_ = Model::mass_spring;  // of integrators and rings
  std::string integrator_;
  std::vector<Variant> variants_;
  std::set<std::string> seen_;
};

void refuse_own_keys(const scenario::Family& family) {
  for (const scenario::Setting& swept : family.design.settings(0))
    for (const char* own : own_keys)
      if (swept.key == own || swept.key.starts_with(std::string(own) + "."))
        throw InputError(swept.value.place,
                         "`" + swept.key + "` is swept, and `palpate chart` varies `" + own +
                             "` itself; set it to one value, with `[sweep]` without it");
}

void refuse_forces(const scenario::Family& family) {
  const auto& steps = family.base.steps;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (const auto* indent = std::get_if<scenario::Indent>(&steps[i]);
        indent != nullptr && indent->to.second)
      throw InputError(
          scenario::place_of(family.document, "step." + std::to_string(i + 1) + ".to"),
          "a step to a force ends elsewhere in every variant, and `palpate chart` compares forces "
          "at equal travels; give a travel");
}

}  // namespace

std::string word_of(Model model) { return words::word(words::models, model); }
std::string word_of(Integrator integrator) { return words::word(words::integrators, integrator); }
std::string word_of(contact::Coupling coupling) { return words::word(words::couplings, coupling); }

std::vector<Variant> design(const Asked& asked, std::size_t of_case) {
  return Designer(asked, of_case).all();
}

double coarsest_interval(const Scenario& scenario) {
  double interval = scenario.output.interval;
  for (const double step : time_steps_ms)
    interval = std::max(interval, 1e-3 * rows_of(step, 1e3 * scenario.output.interval));
  return interval;
}

Integrator base_integrator(const Scenario& scenario) {
  const scenario::Solver& solver = scenario.solver;
  if (solver.integrator != Integrator::automatic) return solver.integrator;
  const bool drag = scenario.tissue.viscosity == tissue::Viscosity::nodal_drag;
  if (scenario.uniform() || drag) return Integrator::central_difference;
  return scene::estimate(scenario).inertia < solver.tolerance ? Integrator::quasi_static
                                                              : Integrator::central_difference;
}

Asked read_for_chart(const std::string& path, const Settings& settings) {
  Asked asked{path, read_text(path), settings, {}};
  asked.family = scenario::parse(asked.text, path, settings);
  const scenario::Family& family = asked.family;
  if (family.cases.size() > most_cases)
    throw InputError(scenario::place_of(family.document, "sweep"),
                     "`palpate chart` measures up to " + std::to_string(most_cases) +
                         " cases, and `sweep` makes " + std::to_string(family.cases.size()) +
                         "; give shorter lists");
  refuse_own_keys(family);
  refuse_forces(family);
  return asked;
}

scenario::Family with_settings(const Asked& asked, std::size_t of_case, const Settings& settings) {
  Settings all = asked.settings;
  all.insert(all.end(), settings.begin(), settings.end());
  scenario::Family family = scenario::parse_case(asked.text, asked.path, all, of_case);
  family.cases.front().name = asked.family.cases[of_case].name;
  return family;
}

}  // namespace palpate::study
