// From the case to the strongest answer that somebody else vouches for.
#include "study/chart_reference.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "contact/relaxation.h"
#include "run/extrapolation.h"
#include "run/family.h"
#include "run/reference.h"
#include "scenario/programme.h"
#include "scene/estimates.h"
#include "scene/specimen_mesh.h"

namespace palpate::study {
namespace {

using Settings = std::vector<std::string>;
using scenario::Scenario;

// Refined meshes know no better than this, in a thousand times the time: docs/accuracy.md.
constexpr double refined_error = 0.03;
constexpr double most_moments = 20.0;          // of a press without memory
constexpr double most_moments_in_time = 50.0;  // of one that the past or waves matter to

std::string percent(double part) { return rounded_text(100.0 * part, 2) + " %"; }

class Finder {
 public:
  Finder(const Asked& asked, std::size_t of_case, const std::atomic<bool>& stop,
         const std::function<void(const std::string&)>& told)
      : asked_(asked),
        case_(of_case),
        scenario_(asked.family.cases[of_case].scenario),
        stop_(stop),
        told_(told) {}

  std::optional<Truth> find() {
    if (scenario_.uniform()) return uniform();
    const scene::Estimates found = scene::estimate(scenario_);
    if (std::holds_alternative<scenario::HalfSpace>(scenario_.tissue.shape))
      return half_space(found);
    const double left_out = found.sides + found.inertia;
    if (!scene::beyond_layer(scenario_) && left_out <= refined_error) return layer(found);
    if (!std::holds_alternative<scenario::MeshFile>(scenario_.tissue.mesh)) return refined(found);
    return on_the_mesh();
  }

 private:
  // The case run with more settings; nothing where it was stopped.
  [[nodiscard]] std::optional<History> run(const Settings& settings) const {
    const auto family = with_settings(asked_, case_, settings);
    scene::Scene scene = scene::build(family.cases.front(), family);
    nodes_ = scene.specimen ? scene.specimen->network.nodes() : 0;
    scene.scenario.output.pressure_maps = scene.scenario.output.tissue = false;
    scene.scenario.output.picture = false;
    const record::CaseRecord record = run::run_case(scene, stop_);
    if (record.outcome == record::Outcome::interrupted) return std::nullopt;
    if (record.outcome == record::Outcome::diverged)
      throw MeshError("the reference of case " + asked_.family.cases[case_].name +
                      " did not come to its end: " + record.reason);
    return history(scenario_, record);
  }

  std::optional<Truth> vouched(const char* kind, const std::string& sentence,
                               const Settings& settings, double error) const {
    auto moments = run(settings);
    if (!moments) return std::nullopt;
    for (Moment& moment : *moments) moment.error = error * std::abs(moment.value);
    return Truth{kind, sentence + "; its own error is about " + percent(error), *moments};
  }

  std::optional<Truth> half_space(const scene::Estimates& found) const {
    const bool deep = found.deep >= scenario_.solver.tolerance;
    return vouched(
        "closed form", deep ? "Hertz, times the factor of a deep press" : "Hertz",
        {"solver.model=hertz", deep ? "contact.depth=neo_hookean" : "contact.depth=hertz"},
        (deep ? contact::DeepLaw::error : found.deep) + found.inertia);
  }

  std::optional<Truth> layer(const scene::Estimates& found) const {
    return vouched("closed form",
                   "a flat layer without end; the sides take " + percent(found.sides) +
                       ", waves add " + percent(found.inertia),
                   {"solver.model=layer"}, found.sides + found.inertia);
  }

  std::optional<Truth> on_the_mesh() const {
    const scene::Choice choice = scene::choose(scenario_);
    double error = 1.0;
    for (const scene::Rung& rung : choice.rungs)
      if (rung.model == scenario::Solver::Model::coupled_springs) error = rung.error;
    return vouched("own mesh",
                   "`coupled_springs` on the ready mesh, which cannot be refined, with the error "
                   "that the ladder predicts",
                   {"solver.model=coupled_springs",
                    "solver.integrator=" + word_of(base_integrator(scenario_))},
                   error);
  }

  std::optional<Truth> refined(const scene::Estimates& found) const {
    // Where the contact does not know the tissue's viscosity, a mesh that carries the tissue must
    // not know it either. `consistent` is asked, because with `resolved` the mesh is to know.
    auto family = with_settings(asked_, case_, {"contact.coupling=consistent"});
    Scenario& scenario = family.cases.front().scenario;
    const bool flows = scenario.viscous_contact();
    if (!flows) scenario.tissue.viscosity = tissue::Viscosity::none;
    const bool in_time = flows || found.inertia >= scenario.solver.tolerance;
    double& interval = scenario.output.interval;
    const double wanted =
        scenario::programme_time(scenario) / (in_time ? most_moments_in_time : most_moments);
    interval *= std::max(1.0, std::ceil(wanted / interval));
    const run::Reference reference = run::refer(family.cases.front(), family, 3, stop_, told_);
    if (stop_.load()) return std::nullopt;
    if (reference.diverged) throw MeshError("the reference diverged: " + *reference.diverged);
    Truth truth{"refined", "", {}};
    double turned = 0.0;
    double peak = 0.0;
    for (const run::ReferenceRow& row : reference.rows) {
      truth.moments.push_back({row.step, row.time, row.force, row.error});
      peak = std::max(peak, row.force);
      turned = std::max(turned, std::abs(row.by_sphere - 1.0) * row.force);
    }
    truth.sentence = "coupled springs on three meshes, extrapolated (`palpate reference`)";
    const double own = own_error(scenario_, truth.moments).greatest;
    truth.sentence += "; refinement may still change " + percent(own);
    if (turned > 0.0 && peak > 0.0)
      truth.sentence += ", and the way to read linear elasticity at this depth " +
                        percent(turned / peak) + ", which is not counted";
    return truth;
  }

  // Whether the strain of the whole specimen is the material's own, at any nu.
  [[nodiscard]] bool even() const {
    const auto& shape = scenario_.tissue.shape;
    return (std::holds_alternative<scenario::Cuboid>(shape) ||
            std::holds_alternative<scenario::Cylinder>(shape)) &&
           !std::holds_alternative<scenario::MeshFile>(scenario_.tissue.mesh) &&
           scenario_.regions.empty() && scene::base_of(scenario_) == tissue::Base::frictionless &&
           scenario_.tissue.viscosity != tissue::Viscosity::nodal_drag &&
           scenario_.solver.kinematics == tissue::Kinematics::linear;
  }

  // Coupled springs on a mesh of about so many nodes, 8 or more.
  [[nodiscard]] Settings coupled(double nodes, const char* integrator) const {
    Settings settings{"solver.model=coupled_springs",
                      std::string("solver.integrator=") + integrator, "solver.volume=auto",
                      "solver.substeps=auto", "solver.time_step=auto"};
    if (std::holds_alternative<scenario::MeshFile>(scenario_.tissue.mesh)) return settings;
    const auto* box = std::get_if<scenario::Cuboid>(&scenario_.tissue.shape);
    if (box == nullptr || !scene::all_slabs(scenario_)) {
      settings.push_back("tissue.mesh={kind='tetgen',nodes=" + rounded_text(nodes, 6) + "}");
      return settings;
    }
    // (n + 1) nodes along every side of n cells.
    const double cell = std::cbrt(box->size[0] * box->size[1] * box->size[2] / nodes);
    std::string cells;
    for (const double length : box->size)
      cells +=
          (cells.empty() ? "" : ",") + std::to_string(std::max(1L, std::lround(length / cell) - 1));
    settings.push_back("tissue.mesh={kind='mirrored',cells=[" + cells + "]}");
    return settings;
  }

  std::optional<Truth> uniform() const {
    constexpr double few = 60.0;  // nodes: modes of so small a mesh cost nothing
    const bool drag = scenario_.tissue.viscosity == tissue::Viscosity::nodal_drag;
    double inertia = 1.0;
    if (!drag) {
      told_("what inertia adds");
      const auto moving = run(coupled(few, "modal"));
      const auto still = moving ? run(coupled(few, "quasi_static")) : std::nullopt;
      if (!still) return std::nullopt;
      const auto off = deviation(scenario_, *moving, without_starts(scenario_, *still));
      inertia = off ? off->greatest : 1.0;
    }
    const bool moves = inertia > 0.5 * scenario_.solver.tolerance;
    if (even() && !moves) return material(inertia);
    return extrapolated(moves ? "modal" : "quasi_static", moves ? 0.0 : inertia);
  }

  // strain = s/E (J(t) - J(t - t_1)), J the creep over its end value; stress = e E(t).
  [[nodiscard]] Truth material(double inertia) const {
    const double modulus = *scenario_.tissue.young_modulus;
    const tissue::ViscousLaw law = scene::viscous_law(scenario_.tissue);
    contact::Relaxation relaxation;
    relaxation.retardation_time = law.time;
    for (const tissue::Branch& branch : law.branches)
      relaxation.branches.push_back({branch.time, branch.ratio});
    const contact::Creep creep = contact::creep(relaxation);
    Truth truth{"closed form",
                "the material's own law between slippery platens; what inertia adds, its own "
                "error, is " +
                    percent(inertia),
                {}};
    constexpr int moments = 100;  // of every step
    for (std::size_t i = 0; i < scenario_.steps.size(); ++i) {
      const int step = static_cast<int>(i) + 1;
      const auto* creeps = std::get_if<scenario::Creep>(&scenario_.steps[i]);
      const auto* relaxes = std::get_if<scenario::Relax>(&scenario_.steps[i]);
      const double time =
          creeps != nullptr ? creeps->load_time + creeps->recovery_time : relaxes->time;
      for (int k = 1; k <= moments; ++k) {
        const double t = time * k / moments;
        double value = 0.0;
        if (creeps != nullptr) {
          value = creep.compliance_ratio(t);
          if (t > creeps->load_time) value -= creep.compliance_ratio(t - creeps->load_time);
          value *= creeps->stress / modulus;
        } else {
          value = relaxes->strain * modulus * relaxation.modulus_ratio(t);
        }
        truth.moments.push_back({step, start_of(scenario_, step) + t, value, 0.0});
      }
    }
    for (Moment& moment : truth.moments) moment.error = inertia * std::abs(moment.value);
    return truth;
  }

  std::optional<Truth> extrapolated(const char* integrator, double more) const {
    const bool ready = std::holds_alternative<scenario::MeshFile>(scenario_.tissue.mesh);
    if (ready) return vouched_uniform(integrator, more);
    std::vector<History> levels;
    std::vector<double> spacings;
    const double coarsest = integrator == std::string("modal") ? 40.0 : 150.0;
    for (const double times : {1.0, 2.0, 4.0}) {
      told_("level " + std::to_string(levels.size() + 1) + " of 3");
      auto level = run(coupled(times * coarsest, integrator));
      if (!level) return std::nullopt;
      levels.push_back(without_starts(scenario_, *level));
      spacings.push_back(1.0 / std::cbrt(static_cast<double>(nodes_)));
    }
    Truth truth{"refined", "", {}};
    for (std::size_t i = 0; i < levels.back().size(); ++i) {
      std::vector<double> values;
      for (const History& level : levels) values.push_back(level[i].value);
      const run::Extrapolated found = run::extrapolate(spacings, values);
      const Moment& at = levels.back()[i];
      truth.moments.push_back(
          {at.step, at.time, found.value, found.error + more * std::abs(found.value)});
    }
    truth.sentence = std::string("coupled springs on three meshes by `") + integrator +
                     "`, extrapolated; refinement may still change " +
                     percent(own_error(scenario_, truth.moments).greatest);
    return truth;
  }

  std::optional<Truth> vouched_uniform(const char* integrator, double more) const {
    double error = 1.0;
    for (const scene::Rung& rung : scene::choose(scenario_).rungs)
      if (rung.model == scenario::Solver::Model::coupled_springs) error = rung.error;
    auto truth = vouched("own mesh", "`coupled_springs` on the ready mesh",
                         coupled(0.0, integrator), error + more);
    if (truth) truth->moments = without_starts(scenario_, truth->moments);
    return truth;
  }

  const Asked& asked_;
  std::size_t case_;
  const Scenario& scenario_;
  const std::atomic<bool>& stop_;
  const std::function<void(const std::string&)>& told_;
  mutable int nodes_ = 0;  // of the last run
};

}  // namespace

std::optional<Truth> find_truth(const Asked& asked, std::size_t of_case,
                                const std::atomic<bool>& stop,
                                const std::function<void(const std::string&)>& told) {
  return Finder(asked, of_case, stop, told).find();
}

std::optional<History> exact_in_time(const Asked& asked, const Variant& variant,
                                     const std::atomic<bool>& stop) {
  const double interval = coarsest_interval(asked.family.cases[variant.of_case].scenario);
  std::vector<History> finer;
  try {
    for (const double step : {0.5e-3, 0.25e-3}) {
      Settings settings = variant.settings;
      settings.emplace_back("solver.integrator=modal");
      settings.push_back("output.interval=" + number_text(1e3 * interval) + " ms");
      settings.push_back("solver.substeps=" +
                         number_text(std::max(1.0, std::round(interval / step))));
      const auto family = with_settings(asked, variant.of_case, settings);
      scene::Scene scene = scene::build(family.cases.front(), family);
      scene.scenario.output.pressure_maps = scene.scenario.output.tissue = false;
      scene.scenario.output.picture = false;
      const record::CaseRecord record = run::run_case(scene, stop);
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

}  // namespace palpate::study
