// The map in order: rungs, axes, failures, sentences.
#include "study/stability.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/text.h"
#include "scenario/words.h"
#include "study/survey.h"

namespace palpate::study {

using scenario::Solver;
using tissue::Viscosity;

bool Survey::go_on(const std::string& what) {
  if (*stop) {
    map.interrupted = true;
    return false;
  }
  (*told)(what, std::min(1.0, static_cast<double>(done++) / planned));
  return true;
}

std::unique_ptr<Variant> Survey::variant(
    const RungOf& on, const std::function<void(scenario::Scenario&)>& change) const {
  scenario::Scenario scenario = bare(one->scenario, on.model, on.volume);
  if (change) change(scenario);
  return make_variant(scenario, *family);
}

void add_limit(Survey& survey, Variant& variant, const std::string& method,
               const tissue::ViscousLaw& law, const Setting& setting) {
  const Solver& solver = variant.scene.scenario.solver;
  const Measured measured = measure_limit(variant, method, law, setting.contact);
  LimitRow row;
  row.rung = scenario::words::word(scenario::words::models, solver.model);
  row.volume = scenario::words::word(scenario::words::volumes, solver.volume);
  row.integrator = method;
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

void survey_rungs(Survey& survey) {
  for (const auto model : {Solver::Model::mass_spring, Solver::Model::coupled_springs}) {
    for (const Solver::Volume volume : volumes) {
      const RungOf rung{model, volume};
      const bool own = rung == survey.rung;
      // Coupled springs without a volume term are refused in scenarios.
      if (model == Solver::Model::coupled_springs && volume == Solver::Volume::none) continue;
      if (*survey.stop) return;
      const auto variant = survey.variant(rung);
      for (const Viscosity form : forms) {
        if (survey.large() && !own && form != Viscosity::none) continue;
        const Damping damping = damping_of(survey.one->scenario, *survey.family, form);
        for (const std::string& method : methods()) {
          if (!survey.go_on(std::string(scenario::words::word(scenario::words::models, model)) +
                            ", " + method))
            return;
          if (method == "modal" && survey.large() && !(own && form == Viscosity::none)) continue;
          add_limit(survey, *variant, method, damping.law,
                    {.axis = "rung", .note = damping.assumed ? "viscosity assumed" : ""});
        }
      }
    }
  }
}

namespace {

void refuse(const scenario::Case& one, const scenario::Family& family) {
  if (std::holds_alternative<scenario::HalfSpace>(one.scenario.tissue.shape))
    throw InputError(scenario::place_of(family.document, "tissue.shape"),
                     "a `half_space` has no mesh, and nothing on it is stepped in time; give "
                     "`tissue.shape` a size, as `{ kind = \"cuboid\" }` has, to see where methods "
                     "fail");
}

void refuse_large(const Variant& own, const scenario::Family& family) {
  if (own.nodes() <= most_map_nodes) return;
  throw InputError(scenario::place_of(family.document, "tissue.mesh"),
                   "the stability map takes meshes of up to " + std::to_string(most_map_nodes) +
                       " nodes, this one has " + std::to_string(own.nodes()) +
                       "; give `tissue.mesh` fewer cells: limits shrink with the shortest edge");
}

}  // namespace

StabilityMap map_stability(const scenario::Case& one, const scenario::Family& family,
                           const std::atomic<bool>& stop, const Told& told) {
  refuse(one, family);
  Survey survey;
  survey.one = &one;
  survey.family = &family;
  survey.stop = &stop;
  survey.told = &told;
  survey.rung = rung_of(one.scenario);
  survey.own = survey.variant(survey.rung);
  refuse_large(*survey.own, family);
  constexpr int beyond_rungs = 110;  // measurements on axes, and probes
  const std::size_t on_rungs = survey.large() ? forms.size() + 4 : 5 * forms.size();
  survey.planned = static_cast<int>(on_rungs * methods().size()) + beyond_rungs;
  survey_rungs(survey);
  survey_axes(survey);
  probe_time(survey);
  probe_shape(survey);
  probe_touch(survey);
  if (!survey.map.interrupted) survey.map.sentences = map_sentences(survey);
  return std::move(survey.map);
}

}  // namespace palpate::study
