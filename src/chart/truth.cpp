// Chooses and computes the reference solution of a case.
#include "chart/truth.h"

#include <algorithm>
#include <cmath>

#include "base/doing.h"
#include "base/error.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "chart/extrapolation.h"
#include "chart/reference.h"
#include "contact/relaxation.h"
#include "run/choose.h"
#include "run/family.h"
#include "run/refined_mesh.h"
#include "scenario/programme.h"
#include "scene/estimates.h"
#include "scene/specimen_mesh.h"

namespace palpate::chart {
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
    const double left_out = std::abs(found.sides) + found.size_error + found.inertia;
    if (!scene::beyond(Model::layer, scenario_, choice_.touch) && found.measured &&
        left_out <= refined_error &&
        (found.depth_ratio ? std::abs(found.deep) : found.deep_error) <= refined_error)
      return layer(found);
    const bool ready = std::holds_alternative<scenario::MeshFile>(scenario_.tissue.mesh);
    return ready && found.inertia >= scenario_.solver.tolerance ? on_the_mesh() : refined(found);
  }

 private:
  // Runs the case with further settings.
  [[nodiscard]] History run(const Settings& settings) const {
    const auto family = with_settings(asked_, case_, settings);
    scene::Scene scene = run::build_scene(family.cases.front(), family);
    nodes_ = scene.specimen ? scene.specimen->network.nodes() : 0;
    scene.scenario.output.keep_rows_only();
    const record::CaseRecord record = run::run_case(scene);
    StopScope::end_if_stopped();
    if (record.outcome == record::Outcome::diverged)
      throw MeshError("the reference of case " + one_.name + " diverged: " + record.reason);
    return history(scenario_, record);
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
    return " in linear elasticity, like all variants; finite strain, which would change it by " +
           percent_text(std::abs(found.deep)) + ", is not included";
  }

  Truth half_space(const scene::Estimates& found) const {
    return vouched("closed form", "Hertz" + depth_text(found), {model_setting(Model::hertz)},
                   found.inertia);
  }

  Truth layer(const scene::Estimates& found) const {
    return vouched(
        "closed form",
        "an infinite flat layer" + depth_text(found) + "; the estimated effect of the sides is " +
            percent_text(std::abs(found.sides)) + ", that of inertia " +
            percent_text(found.inertia),
        {model_setting(Model::layer)}, std::abs(found.sides) + found.size_error + found.inertia);
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
    // If the scenario's contact law is elastic, the mesh must be elastic too. This is decided with
    // `consistent`, because with `resolved` the viscosity belongs to the mesh.
    auto family = with_settings(asked_, case_, {"contact.coupling=consistent"});
    scenario::Scenario& scenario = family.cases.front().scenario;
    const bool flows = scenario::viscous_contact(scenario);
    if (!flows) scenario.tissue.viscosity = tissue::Viscosity::none;
    const bool in_time = flows || found.inertia >= scenario.solver.tolerance;
    double& interval = scenario.output.interval;
    const double wanted =
        scenario::programme_time(scenario) / (in_time ? most_moments_in_time : most_moments);
    interval *= std::max(1.0, std::ceil(wanted / interval));
    const chart::Reference reference = chart::refer(family.cases.front(), family, 3);
    if (reference.diverged) throw MeshError("the reference diverged: " + *reference.diverged);
    Truth truth{"refined", "", {}};
    double turned = 0.0;
    double peak = 0.0;
    // The reference of a still press leaves inertia out. Where this is more than a little, coupled
    // springs say what it adds; where they do not, the estimate counts as an error.
    const double waves =
        reference.moves || found.inertia <= 0.1 * scenario_.solver.tolerance ? 0.0 : found.inertia;
    std::optional<Inertia> added;
    if (waves > 0.0 && !flows) added = inertia_of_press(interval, reference.rows);
    for (std::size_t i = 0; i < reference.rows.size(); ++i) {
      const chart::ReferenceRow& row = reference.rows[i];
      const Moment more = added ? added->added[i] : Moment{.error = waves * std::abs(row.force)};
      truth.moments.push_back({row.step, row.time, row.force + more.value, row.error + more.error});
      peak = std::max(peak, row.force);
      turned = std::max(turned, std::abs(row.by_sphere - 1.0) * row.force);
    }
    const std::string inertia =
        added ? "and what inertia adds to coupled springs, " + percent_text(added->greatest)
              : "without inertia, whose estimated effect is " + percent_text(found.inertia);
    truth.sentence =
        reference.moves
            ? "coupled springs on three meshes, extrapolated (`palpate reference`); forces" +
                  depth_text(found)
            : "`solid` on three meshes, extrapolated (`palpate reference`), " + inertia;
    const double own = own_error(scenario_, truth.moments).greatest;
    truth.sentence += "; its own error is about " + percent_text(own);
    if (turned > 0.0 && peak > 0.0)
      truth.sentence += ", and the choice of the pressure's direction at this depth " +
                        percent_text(turned / peak) + ", which is not included";
    return truth;
  }

  // Whether the strain is uniform in the whole specimen for every Poisson's ratio.
  [[nodiscard]] bool even() const {
    const auto& shape = scenario_.tissue.shape;
    return (std::holds_alternative<scenario::Cuboid>(shape) ||
            std::holds_alternative<scenario::Cylinder>(shape)) &&
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

  // What inertia adds to the values of coupled springs on a mesh, and the largest change, relative
  // to the largest value.
  struct Inertia {
    History added;
    double greatest = 1.0;
  };
  template <class Run>
  [[nodiscard]] Inertia inertia_of(const Run& run_with) const {
    const History moving = run_with("modal");
    const History still = without_starts(scenario_, run_with("quasi_static"));
    Inertia inertia{.added = without_starts(scenario_, moving)};
    if (const auto off = deviation(scenario_, moving, still)) inertia.greatest = off->greatest;
    for (std::size_t i = 0; i < still.size(); ++i) inertia.added[i].value -= still[i].value;
    return inertia;
  }

  // What inertia adds to an elastic press on a mesh with four times the scenario's nodes; its error
  // is the difference to the scenario's own mesh. Nothing without such meshes, and for slides.
  [[nodiscard]] std::optional<Inertia> inertia_of_press(
      double interval, const std::vector<ReferenceRow>& rows) const {
    if (rows.empty() || rows.back().slide != 0.0) return std::nullopt;
    set_doing("effect of inertia");
    const auto on = [&](double factor) {
      return inertia_of([&](const char* integrator) {
        return run({model_setting(scenario::strongest.of), "contact.coupling=consistent",
                    "tissue.viscosity=none", std::string("solver.integrator=") + integrator,
                    "output.interval=" + number_text(1e3 * interval) + " ms",
                    mesh_setting(one_.scenario, factor)});
      });
    };
    try {
      const Inertia own = on(1.0);
      Inertia finer = on(4.0);
      if (own.added.size() != rows.size()) return std::nullopt;
      for (std::size_t i = 0; i < rows.size(); ++i)
        finer.added[i].error = std::abs(finer.added[i].value - own.added[i].value);
      return finer;
    } catch (const InputError&) {
    } catch (const MeshError&) {
    }
    return std::nullopt;
  }

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
      set_doing("level " + std::to_string(levels.size() + 1) + " of 3");
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

}  // namespace palpate::chart
