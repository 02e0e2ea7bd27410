// Measures the map in order: models, axes, failures, sentences.
#include "stability/stability.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "run/choose.h"
#include "scenario/integrators.h"
#include "scenario/words.h"
#include "stability/survey.h"

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

void add_limit(Survey& survey, ProbedBody& probed, const Method& method,
               const tissue::ViscousLaw& law, const Setting& setting) {
  const scenario::Resolved::Solver& solver = probed.scene.scenario.solver;
  const Measured measured = measure_limit(probed, method, law, setting.contact);
  LimitRow row;
  row.model = scenario::traits(solver.model).word;
  row.volume = scenario::words::word(scenario::words::volumes, solver.volume);
  row.integrator = method.name();
  row.damping = setting.damping.empty()
                    ? scenario::words::word(scenario::words::viscosities, law.kind)
                    : setting.damping;
  row.axis = setting.axis;
  row.value = setting.value;
  row.measured = measured.limit;
  row.theory = measured.theory;
  row.failure = measured.failure;
  row.note = measured.note;
  if (!setting.note.empty()) row.note += (row.note.empty() ? "" : "; ") + setting.note;
  survey.map.limits.push_back(std::move(row));
}

namespace {

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

void refuse(const scenario::Case& one, const scenario::Family& family) {
  if (std::holds_alternative<scenario::HalfSpace>(one.scenario.tissue.shape))
    throw InputError(
        place_of(family.document, "tissue.shape"),
        "a `half_space` has no mesh and needs no time steps, so that it has no stability "
        "map; give `tissue.shape` a size, as `{ kind = \"cuboid\" }` has");
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
         "` computes the force at rest" +
         ", so that no step is too long; the limits are those of springs with inertia on this "
         "body.";
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
  else
    survey.map.longest_step = longest_step(survey);
  survey.map.sentences.insert(survey.map.sentences.begin(), sentences.begin(), sentences.end());
  return std::move(survey.map);
}

}  // namespace palpate::stability
