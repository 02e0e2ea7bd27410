// Chooses and computes the reference solution of a case.
#include "chart/truth.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/doing.h"
#include "base/error.h"
#include "base/numerics.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "chart/reference.h"
#include "contact/viscous_contact.h"
#include "run/choose.h"
#include "run/family.h"
#include "run/refined_mesh.h"
#include "scenario/programme.h"
#include "scene/estimates.h"
#include "scene/specimen_mesh.h"

namespace palpate::chart {
namespace {

constexpr double least_order = 0.5;
constexpr double most_order = 3.0;

// (h1^p - h2^p) / (h2^p - h3^p), which grows with p.
double ratio_of_changes(std::span<const double> h, double p) {
  return (std::pow(h[0] / h[1], p) - 1.0) / (1.0 - std::pow(h[2] / h[1], p));
}

// The p with this ratio of changes, not below `least_order`.
double observed_order(std::span<const double> h, double ratio) {
  return numerics::root({least_order, most_order},
                        [&](double p) { return ratio_of_changes(h, p) - ratio; })
      .middle();
}

}  // namespace

Extrapolated extrapolate(std::span<const double> spacings, std::span<const double> values) {
  assert(spacings.size() == values.size() && !values.empty());
  const double finest = values.back();
  if (values.size() == 1) return {finest, std::numeric_limits<double>::infinity(), 0.0};
  const std::size_t count = std::min<std::size_t>(3, values.size());
  const auto h = spacings.last(count);
  const auto f = values.last(count);
  const double last_change = f[count - 1] - f[count - 2];
  Extrapolated result{.value = finest, .order = 1.0};
  if (count == 3) {
    const double change = f[1] - f[0];
    if (last_change == 0.0 && change == 0.0) return {finest, 0.0, 0.0};
    const bool settles =
        change * last_change > 0.0 && change / last_change <= ratio_of_changes(h, most_order);
    if (!settles) {
      const auto [low, high] = std::minmax({f[0], f[1], f[2]});
      return {finest, high - low, 0.0};
    }
    result.order = observed_order(h, change / last_change);
  }
  // value + C h^p: (remaining change) / (last change) = 1 / ((h_2 / h_3)^p - 1)
  const double rest = last_change / (std::pow(h[count - 2] / h[count - 1], result.order) - 1.0);
  result.value += rest;
  result.error = std::max(std::abs(rest), 0.5 * std::abs(last_change));
  if (count == 2) result.error *= 2.0;
  return result;
}

namespace {

using Settings = std::vector<std::string>;
using scenario::Model;

// What `solid` states on its meshes.
constexpr double refined_error = 0.005;
constexpr double most_moments = 20.0;          // of a press without memory
constexpr double most_moments_in_time = 50.0;  // of a press with viscosity or inertia

class Finder {
 public:
  Finder(const Asked& asked, std::size_t of_case)
      : asked_(asked),
        case_(of_case),
        one_(asked.family.cases[of_case]),
        choice_(run::choose(one_)),
        scenario_(choice_.chosen) {}

  Truth find() {
    if (scenario_.uniform()) return uniform();
    const scene::Estimates& found = choice_.expected;
    if (std::holds_alternative<scenario::HalfSpace>(scenario_.tissue.shape))
      return half_space(found);
    const double neglected = std::abs(found.sides) + found.size_error + found.inertia + found.ball;
    if (!scene::beyond(Model::layer, scenario_, choice_.touch) && found.measured &&
        neglected <= refined_error &&
        (found.depth_ratio ? std::abs(found.deep) : found.deep_error) <= refined_error)
      return layer(found, neglected);
    const bool ready = std::holds_alternative<scenario::MeshFile>(scenario_.tissue.mesh);
    return ready && found.inertia >= scenario_.solver.tolerance ? on_the_mesh() : refined(found);
  }

 private:
  [[nodiscard]] History run(const Settings& settings) const {
    Ran ran = run_with(asked_, case_, settings);
    nodes_ = ran.nodes;
    return std::move(ran.moments);
  }

  Truth vouched(const char* kind, const std::string& sentence, const Settings& settings,
                double error) const {
    History moments = run(settings);
    for (Moment& moment : moments) moment.error = error * std::abs(moment.value);
    return {kind, sentence + "; its own error is about " + percent_text(error), moments};
  }

  // What all variants have in common, so that no difference shows it.
  [[nodiscard]] std::string depth_text(const scene::Estimates& found) const {
    if (one_.scenario.contact.depth.value_or(asked_.depths[case_]) ==
        scenario::Contact::Depth::neo_hookean)
      return " times the factor of a deep press, which `auto` applies here; its error of " +
             percent_text(found.deep_error) + " is not included";
    return " in linear elasticity, like all configurations; finite strain, which would change it "
           "by " +
           percent_text(std::abs(found.deep)) + ", is not included";
  }

  Truth half_space(const scene::Estimates& found) const {
    return vouched("closed form",
                   "Hertz" + depth_text(found) + "; the estimated effect of the finger's size is " +
                       percent_text(found.ball) + ", that of inertia " +
                       percent_text(found.inertia),
                   {model_setting(Model::hertz)}, found.ball + found.inertia);
  }

  Truth layer(const scene::Estimates& found, double neglected) const {
    return vouched("closed form",
                   "an infinite flat layer" + depth_text(found) +
                       "; the estimated effect of the sides is " +
                       percent_text(std::abs(found.sides)) + ", that of inertia " +
                       percent_text(found.inertia),
                   {model_setting(Model::layer)}, neglected);
  }

  // The estimated error of the strongest model, relative.
  [[nodiscard]] double strongest_error() const {
    const scene::Choice choice = run::choose(one_);
    const scene::Forecast* forecast = choice.forecast(scenario::strongest.of);
    return forecast != nullptr ? forecast->error : 1.0;
  }

  Truth on_the_mesh() const {
    return vouched("own mesh",
                   "`coupled_springs` on the ready mesh, which cannot be refined, with the "
                   "estimated error of this model",
                   {model_setting(scenario::strongest.of),
                    "solver.integrator=" + word_of(base_integrator(one_))},
                   strongest_error());
  }

  Truth refined(const scene::Estimates& found) const {
    const Reference reference = refer(asked_, case_, {most_moments, most_moments_in_time});
    if (reference.diverged) throw MeshError("the reference diverged: " + *reference.diverged);
    Truth truth{"refined", "", {}};
    for (const ReferenceRow& row : reference.rows)
      truth.moments.push_back({row.step, row.time, row.force, row.error});
    truth.sentence =
        (reference.moves
             ? "coupled springs on three meshes, extrapolated (`palpate reference`); forces" +
                   depth_text(found)
             : "`solid` on three meshes, extrapolated (`palpate reference`); " + reference.how) +
        "; its own error is about " + percent_text(own_error(scenario_, truth.moments).greatest);
    return truth;
  }

  // Whether the strain is uniform in the whole specimen for every Poisson's ratio.
  [[nodiscard]] bool even() const {
    const auto& shape = scenario_.tissue.shape;
    return (std::holds_alternative<scenario::Cuboid>(shape) ||
            std::holds_alternative<scenario::Cylinder>(shape) ||
            std::holds_alternative<scenario::Disc>(shape)) &&
           !std::holds_alternative<scenario::MeshFile>(scenario_.tissue.mesh) &&
           scenario_.regions.empty() && scenario_.tissue.base == tissue::Base::frictionless &&
           scenario_.tissue.viscosity != tissue::Viscosity::nodal_drag &&
           scenario_.solver.kinematics == scenario::Solver::Kinematics::linear;
  }

  // Settings for coupled springs on a mesh of about `nodes` nodes, at least 8 (or on a ready mesh).
  [[nodiscard]] Settings coupled(double nodes, const char* integrator) const {
    Settings settings{model_setting(scenario::strongest.of),
                      std::string("solver.integrator=") + integrator, "solver.volume=auto",
                      "solver.substeps=auto", "solver.time_step=auto"};
    if (std::holds_alternative<scenario::MeshFile>(scenario_.tissue.mesh)) return settings;
    const auto* box = std::get_if<scenario::Cuboid>(&scenario_.tissue.shape);
    if (box == nullptr || !scene::all_slabs(scenario_)) {
      settings.push_back("tissue.mesh={kind='tetgen',nodes=" + rounded_text(nodes, 6) + "}");
      return settings;
    }
    // n cells have n + 1 nodes along a side.
    const double cell = std::cbrt(box->size[0] * box->size[1] * box->size[2] / nodes);
    std::string cells;
    for (const double length : box->size)
      cells +=
          (cells.empty() ? "" : ",") + std::to_string(std::max(2L, std::lround(length / cell) - 1));
    settings.push_back("tissue.mesh={kind='mirrored',cells=[" + cells + "]}");
    return settings;
  }

  // Coupled springs on a mesh of about `nodes` nodes, more where the shape cannot have so few, at
  // the moments of the variants with the longest interval.
  [[nodiscard]] History run_coupled(double nodes, const char* integrator) const {
    for (;; nodes = std::ceil(1.5 * nodes)) {
      try {
        Settings settings = coupled(nodes, integrator);
        const double interval = coarsest_interval(one_.scenario);
        settings.push_back("output.interval=" + number_text(1e3 * interval) + " ms");
        if (integrator == std::string("tr_bdf2")) settings.emplace_back("solver.substeps=16");
        return run(settings);
      } catch (const MeshError&) {
        if (1.5 * nodes > most_modal_nodes) throw;
      }
    }
  }

  Truth uniform() const {
    if (scenario_.tissue.viscosity == tissue::Viscosity::nodal_drag) return extrapolated("modal");
    return even() ? material() : extrapolated("quasi_static");
  }

  // The spacing of the nodes in the mesh of the last run(), relative to the specimen's size.
  [[nodiscard]] double spacing() const { return 1.0 / std::cbrt(static_cast<double>(nodes_)); }

  // The value of the material's law at the time `t` (s) after the beginning of a step:
  // strain = s/E (J(t) - J(t - t_1)), J the creep compliance times E; stress = e E(t).
  [[nodiscard]] double of_law(const scenario::Step& step, double t) const {
    const double modulus = scenario_.tissue.young_modulus;
    const contact::Relaxation relaxation = scene::relaxation_of(scenario_.tissue.law);
    if (const auto* relaxes = std::get_if<scenario::Relax>(&step))
      return relaxes->strain * modulus * relaxation.modulus_ratio(t);
    if (const auto* compress = std::get_if<scenario::Compress>(&step))
      return modulus * relaxation.ramp_response(compress->rate, compress->ramp_time(), t);
    const auto& creeps = std::get<scenario::Creep>(step);
    const contact::Creep creep = contact::creep(relaxation);
    double value = creep.compliance_ratio(t);
    if (t > creeps.load_time) value -= creep.compliance_ratio(t - creeps.load_time);
    return value * creeps.stress / modulus;
  }

  // At the moments of the variants with the longest interval, which statics on few nodes give.
  [[nodiscard]] Truth material() const {
    const History few = run_coupled(60.0, "quasi_static");
    Truth truth{"closed form", "the material's law between frictionless platens",
                without_starts(scenario_, few)};
    for (Moment& at : truth.moments)
      at = {at.step, at.time,
            of_law(scenario_.steps[as_index(at.step - 1)], at.time - start_of(scenario_, at.step))};
    return truth;
  }

  Truth extrapolated(const char* integrator) const {
    const bool ready = std::holds_alternative<scenario::MeshFile>(scenario_.tissue.mesh);
    if (ready) return vouched_uniform(integrator);
    std::vector<History> levels;
    std::vector<double> spacings;
    double coarsest = integrator == std::string("modal") ? 40.0 : 600.0;
    for (const double times : {1.0, 2.0, 4.0}) {
      // Where the shape needs so many nodes that `modal` does not take the finest level.
      if (4.0 * coarsest > most_modal_nodes && integrator == std::string("modal"))
        integrator = "tr_bdf2";
      set_doing({"level " + std::to_string(levels.size() + 1) + " of 3"});
      levels.push_back(without_starts(scenario_, run_coupled(times * coarsest, integrator)));
      spacings.push_back(spacing());
      coarsest = std::max(coarsest, nodes_ / times);
    }
    Truth truth{"refined", "", {}};
    for (std::size_t i = 0; i < levels.back().size(); ++i) {
      std::vector<double> values;
      for (const History& level : levels) values.push_back(level[i].value);
      const chart::Extrapolated found = chart::extrapolate(spacings, values);
      const Moment& at = levels.back()[i];
      truth.moments.push_back({at.step, at.time, found.value, found.error});
    }
    truth.sentence = std::string("coupled springs on three meshes by `") + integrator +
                     "`, extrapolated; further refinement may change " +
                     percent_text(own_error(scenario_, truth.moments).greatest);
    return truth;
  }

  Truth vouched_uniform(const char* integrator) const {
    auto truth = vouched("own mesh", "`coupled_springs` on the ready mesh",
                         coupled(0.0, integrator), strongest_error());
    truth.moments = without_starts(scenario_, truth.moments);
    return truth;
  }

  const Asked& asked_;
  std::size_t case_;
  const scenario::Case& one_;
  const scene::Choice choice_;
  const scenario::Resolved& scenario_;
  mutable int nodes_ = 0;  // of the last run
};

}  // namespace

Truth find_truth(const Asked& asked, std::size_t of_case) { return Finder(asked, of_case).find(); }

std::optional<History> exact_in_time(const Asked& asked, const Variant& variant,
                                     integrate::KnownModes& known) {
  const double interval = coarsest_interval(asked.family.cases[variant.of_case].scenario);
  std::vector<History> finer;
  try {
    // Modes follow the constant loads of a uniform test exactly.
    const double longest = asked.family.cases[variant.of_case].scenario.uniform() ? interval : 5e-4;
    for (const double step : {longest, 0.5 * longest}) {
      std::vector<std::string> settings = variant.settings;
      settings.emplace_back("solver.integrator=modal");
      settings.push_back("output.interval=" + number_text(1e3 * interval) + " ms");
      settings.push_back("solver.substeps=" +
                         number_text(std::max(1.0, std::round(interval / step))));
      const auto family = with_settings(asked, variant.of_case, settings);
      scene::Scene scene = run::build_scene(family.cases.front(), family);
      if (!scene.specimen || scene.specimen->network.nodes() > most_modal_nodes)
        return std::nullopt;
      scene.scenario.solver.modes = 3 * scene.specimen->network.nodes();  // all
      scene.known_modes = &known;
      scene.scenario.output.keep_rows_only();
      const record::CaseRecord record = run::run_case(scene);
      if (record.outcome != record::Outcome::completed) return std::nullopt;
      finer.push_back(without_starts(scene.scenario, history(scene.scenario, record)));
    }
  } catch (const InputError&) {
    return std::nullopt;
  }
  History best = finer.back();
  for (std::size_t i = 0; i < best.size(); ++i)
    best[i].error = std::abs(best[i].value - finer.front()[i].value);
  return best;
}

}  // namespace palpate::chart
