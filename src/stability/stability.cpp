// Measures the map in order: models, axes, failures, sentences.
#include "stability/stability.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "run/choose.h"
#include "scenario/integrators.h"
#include "scenario/tested.h"
#include "scenario/words.h"
#include "stability/measure.h"

namespace palpate::stability {

using scenario::Solver;
using tissue::Viscosity;

void Survey::go_on(const std::string& what) {
  StopScope::end_if_stopped();
  (*told)(what, std::min(1.0, static_cast<double>(done++) / planned));
}

std::unique_ptr<ProbedBody> Survey::make_body(
    const ModelAndVolume& on, const std::function<void(scenario::Scenario&)>& change) {
  scenario::Case changed = bare(*one, on.model, on.volume);
  if (change) change(changed.scenario);
  return make_probed_body(changed, *family, shapes);
}

namespace {

using scenario::Scenario;

struct Setting {
  std::string axis;
  std::optional<double> value = {};
  std::string note = {};
  const ContactSpring* contact = nullptr;
};

// Measures one limit and adds its row to the map.
void add_limit(Survey& survey, ProbedBody& probed, const Method& method,
               const tissue::ViscousLaw& law, const Setting& setting) {
  const scenario::Resolved::Solver& solver = probed.scene.scenario.solver;
  LimitRow row = measure_limit(probed, method, law, setting.contact);
  row.model = scenario::traits(solver.model).word;
  row.volume = scenario::words::word(scenario::words::volumes, solver.volume);
  row.integrator = method.name();
  row.damping = scenario::words::word(scenario::words::viscosities, law.kind);
  row.axis = setting.axis;
  row.value = setting.value;
  if (!setting.note.empty()) row.note += (row.note.empty() ? "" : "; ") + setting.note;
  survey.map.limits.push_back(std::move(row));
}

constexpr std::array forms{Viscosity::none, Viscosity::nodal_drag, Viscosity::kelvin_voigt,
                           Viscosity::standard_linear_solid};
constexpr std::array volumes{Solver::Volume::none, Solver::Volume::tetrahedron,
                             Solver::Volume::nodal};

}  // namespace

void survey_models(Survey& survey) {
  for (const scenario::ModelTraits& model : scenario::model_table) {
    if (!model.meshed() || model.solid) continue;
    for (const Solver::Volume volume : volumes) {
      const ModelAndVolume one{model.of, volume};
      const bool own = one == survey.given;
      // Coupled springs without a volume term are refused in scenarios.
      if (model.coupled() && volume == Solver::Volume::none) continue;
      StopScope::end_if_stopped();
      const auto probed = survey.make_body(one);
      for (const Viscosity form : forms) {
        if (survey.large() && !own && form != Viscosity::none) continue;
        const Damping damping = damping_of(*survey.one, form);
        for (const Method& method : methods()) {
          survey.go_on(model.word + (", " + method.name()));
          if (method.integrator == Integrator::modal && survey.large() &&
              !(own && form == Viscosity::none))
            continue;
          add_limit(survey, *probed, method, damping.law,
                    {.axis = "model", .note = damping.assumed ? "viscosity assumed" : ""});
        }
      }
    }
  }
}

namespace {

// The explicit integrators of scenarios, without `lagged`.
std::vector<Method> explicit_methods() {
  std::vector<Method> all = methods();
  std::erase_if(all, [](const Method& one) { return !one.explicit_steps() || one.lags; });
  return all;
}

void along_modulus(Survey& survey) {
  // From 0.1 kPa, softer than brain, to 17 GPa, cortical bone.
  const int points = survey.large() ? 3 : 9;
  for (int i = 0; i < points; ++i) {
    const double modulus = 100.0 * std::pow(1.7e8, static_cast<double>(i) / (points - 1));
    survey.go_on("Young's modulus");
    const auto probed = survey.make_body(
        survey.given, [&](Scenario& scenario) { scenario.tissue.young_modulus = modulus; });
    for (const Method& method : explicit_methods())
      add_limit(survey, *probed, method, {}, {.axis = "young_modulus_Pa", .value = modulus});
  }
}

void along_ratio(Survey& survey) {
  for (const Solver::Volume volume : {Solver::Volume::tetrahedron, Solver::Volume::nodal}) {
    for (const double ratio : {0.0, 0.2, 0.3, 0.4, 0.45, 0.49, 0.499, 0.4995, 0.4999}) {
      if (survey.large() && ratio != 0.3 && ratio != 0.45 && ratio != 0.499) continue;
      survey.go_on("Poisson's ratio");
      const auto probed =
          survey.make_body({scenario::strongest.of, volume},
                           [&](Scenario& scenario) { scenario.tissue.poisson_ratio = ratio; });
      add_limit(survey, *probed, Method{}, {},
                {.axis = "poisson_ratio",
                 .value = ratio,
                 .note = ratio > 0.4995 ? "a mesh takes 0.4995" : ""});
    }
  }
}

// Makes the edges of the mesh about `factor` times as long; false if the mesh cannot be changed.
bool resize(scenario::Mesh& mesh, double factor) {
  const auto cells = [&](auto& lattice) {
    for (int& count : lattice.cells)
      count = std::max(1, static_cast<int>(std::lround(count / factor)));
    return true;
  };
  if (auto* kuhn = std::get_if<scenario::Kuhn>(&mesh)) return cells(*kuhn);
  if (auto* mirrored = std::get_if<scenario::Mirrored>(&mesh)) return cells(*mirrored);
  if (auto* tetgen = std::get_if<scenario::Tetgen>(&mesh)) {
    if (tetgen->edge) *tetgen->edge *= factor;
    tetgen->nodes =
        std::max(20, static_cast<int>(std::lround(tetgen->nodes / (factor * factor * factor))));
    tetgen->tetrahedra.reset();
    return true;
  }
  return false;
}

void along_size(Survey& survey) {
  for (const double factor : {2.0, 1.5, 1.0, 0.75, 0.6}) {
    if (survey.large() && factor < 1.0) break;
    scenario::Mesh mesh = survey.one->scenario.tissue.mesh;
    if (!resize(mesh, factor) && factor != 1.0) continue;
    survey.go_on("element size");
    std::unique_ptr<ProbedBody> probed;
    try {
      probed = survey.make_body(survey.given, [&](Scenario& scenario) {
        if (factor != 1.0) scenario.tissue.mesh = mesh;
      });
    } catch (const MeshError& error) {
      if (factor == 1.0) throw;
      survey.map.sentences.push_back("Elements " + number_text(factor) +
                                     " times as long were excluded: " + error.what() + ".");
      continue;
    }
    const auto& lengths = probed->scene.specimen->network.rest_length;
    add_limit(survey, *probed, Method{}, {},
              {.axis = "shortest_edge_mm",
               .value = 1e3 * *std::ranges::min_element(lengths),
               .note = std::to_string(probed->nodes()) + " nodes"});
  }
}

void along_damping(Survey& survey) {
  const double omega = survey.own->highest.frequency;
  for (const double zeta : {0.01, 0.1, 1.0, 10.0, 100.0}) {
    if (survey.large() && zeta != 0.1 && zeta != 10.0) continue;
    for (const Method& method : methods()) {
      if (!method.explicit_steps()) continue;
      survey.go_on("damping");
      tissue::ViscousLaw drag;
      drag.kind = Viscosity::nodal_drag;
      drag.drag = 2.0 * zeta * omega;
      add_limit(survey, *survey.own, method, drag, {.axis = "damping_per_s", .value = drag.drag});
      tissue::ViscousLaw voigt;
      voigt.kind = Viscosity::kelvin_voigt;
      voigt.time = 2.0 * zeta / omega;
      add_limit(survey, *survey.own, method, voigt,
                {.axis = "retardation_time_s", .value = voigt.time});
    }
  }
  // A branch that relaxes more slowly than the time step stiffens the body, a faster one does not.
  const Damping own = damping_of(*survey.one, Viscosity::standard_linear_solid);
  for (const double times : {0.03, 0.3, 1.0, 3.0, 30.0}) {
    survey.go_on("damping");
    tissue::ViscousLaw law = own.law;
    law.branches.front().time = times * 2.0 / omega;
    add_limit(survey, *survey.own, Method{}, law,
              {.axis = "relaxation_time_s", .value = law.branches.front().time});
  }
}

void along_contact(Survey& survey) {
  std::optional<ContactSpring> spring = contact_spring(*survey.own);
  if (!spring) return;
  const double stiffness = spring->stiffness;
  for (const double times : {0.1, 1.0, 10.0, 100.0, 1000.0}) {
    if (survey.large() && times != 1.0 && times != 100.0) continue;
    for (const Method& method : explicit_methods()) {
      survey.go_on("contact stiffness");
      spring->stiffness = times * stiffness;
      add_limit(survey, *survey.own, method, {},
                {.axis = "contact_stiffness_N_per_m",
                 .value = spring->stiffness,
                 .note = times == 1.0 ? "the contact at the largest displacement" : "",
                 .contact = &*spring});
    }
  }
}

// The longest frame time with which a device renders the scenario's contact, by device damping.
void along_device(Survey& survey) {
  const std::optional<ContactSpring> spring = contact_spring(*survey.own);
  if (!spring) return;
  for (const double damping : {0.01, 0.03, 0.1, 0.3, 1.0, 3.0}) {
    survey.go_on("device damping");
    Device device;
    device.sampled.damping = damping;
    const auto still = [&](double frame) {
      device.sampled.frame = frame;
      return !wall_gains_energy(device, spring->stiffness);
    };
    LimitRow row;
    row.model = "device";
    row.volume = "none";
    row.integrator = "zero_order_hold";
    row.damping = "device";
    row.axis = "device_damping_N_s_per_m";
    row.value = damping;
    row.theory = 2.0 * damping / spring->stiffness;  // K T / 2 = b
    row.measured = bisect_limit(still, *row.theory, 1e3 * *row.theory, 5e-4);
    row.failure = Failure::divergence;
    row.note = "frame time of a device of 45 g with no hand; theory: Colgate and Brown, any hand";
    survey.map.limits.push_back(std::move(row));
  }
}

}  // namespace

void survey_axes(Survey& survey) {
  for (const auto& axis :
       {along_modulus, along_ratio, along_size, along_damping, along_contact, along_device})
    axis(survey);
}

namespace {

void refuse(const scenario::Case& one, const scenario::Family& family) {
  if (std::holds_alternative<scenario::HalfSpace>(one.scenario.tissue.shape))
    throw InputError(place_of(family.document, "tissue.shape"),
                     "a `half_space` has no mesh and needs no time steps, so that it has no "
                     "stability map; give `tissue.shape` a size, as `{ kind = \"cuboid\" }` has");
}

void refuse_large(const ProbedBody& own, const scenario::Family& family) {
  if (own.nodes() <= most_map_nodes) return;
  throw InputError(place_of(family.document, "tissue.mesh"),
                   "the stability map accepts meshes of up to " + std::to_string(most_map_nodes) +
                       " nodes, and this one has " + std::to_string(own.nodes()) +
                       "; give `tissue.mesh` fewer cells (limits are proportional to the edges)");
}

// That a scenario steps nothing in time, if so: its model has no mesh, or its steps no inertia.
std::string unstepped(const scenario::Case& one, scene::SpecimenShapes& shapes) {
  const auto& named = one.scenario.solver.model;
  const scenario::Resolved::Solver solver =
      named ? scenario::resolve(one, *named).solver
            : run::choose(one, shapes, run::Models::quick).chosen.solver;
  const scenario::ModelTraits& model = scenario::traits(solver.model);
  if (model.meshed() && about(solver.integrator).inertia) return {};
  return std::string("Nothing is stepped in time here: `") + model.word +
         (model.meshed() ? std::string("` with `") + about(solver.integrator).word
                         : std::string()) +
         "` computes the force at rest, so that no step is too long; the limits are those of "
         "springs with inertia on this body.";
}

}  // namespace

StabilityMap map_stability(const scenario::Case& one, const scenario::Family& family,
                           const Told& told) {
  refuse(one, family);
  Survey survey;
  survey.one = &one;
  survey.family = &family;
  survey.told = &told;
  survey.given = model_and_volume(one.scenario);
  told("mesh", 0.0);
  survey.own = survey.make_body(survey.given);
  refuse_large(*survey.own, family);
  constexpr int beyond_models = 110;  // about the number of measurements on axes and of probes
  const std::size_t on_models = survey.large() ? forms.size() + 4 : 5 * forms.size();
  survey.planned = static_cast<int>(on_models * methods().size()) + beyond_models;
  survey_models(survey);
  survey_axes(survey);
  probe_time(survey);
  probe_shape(survey);
  probe_touch(survey);
  std::vector<std::string> sentences = map_sentences(survey);
  if (const std::string text = unstepped(one, survey.shapes); !text.empty())
    sentences.insert(sentences.begin(), text);
  survey.map.longest_step = longest_step(survey);
  survey.map.tested = joined(scenario::tested(one), "; ");
  survey.map.sentences.insert(survey.map.sentences.begin(), sentences.begin(), sentences.end());
  return std::move(survey.map);
}

}  // namespace palpate::stability
