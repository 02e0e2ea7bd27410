// Turns the choice of the model, its forecasts and the estimates into sentences. Their words are
// those of everyday use: tests/unit/cli_answers.cpp compares them with the glossary.
#include "run/answer.h"

#include <algorithm>
#include <cmath>

#include "base/numerics.h"
#include "base/text.h"
#include "mechanics/pressed_mesh.h"
#include "run/size_effect.h"
#include "scenario/integrators.h"
#include "scene/first_touch.h"

namespace palpate::run {
namespace {

using record::Neglected;
using scenario::Model;

std::string word(Model model) { return scenario::traits(model).word; }

const char* plain_word(Model model) {
  switch (model) {
    case Model::hertz: return "the formula for deep, wide tissue";
    case Model::layer: return "the formula for a flat layer";
    case Model::mass_spring: return "a mesh of springs";
    case Model::coupled_springs: return "a mesh with the tissue's elasticity";
    case Model::solid: return "a mesh for large strains";
  }
  return "";
}

std::string would_change(double change, const std::string& of = "the force") {
  return std::string("which would ") + (change < 0.0 ? "take " : "add ") +
         percent_text(std::abs(change)) + (change < 0.0 ? " off " : " to ") + of;
}

// What a uniform test strains the softest tissue of a specimen at last, as if its tissues lay in
// layers across the load.
double largest_uniform_strain(const scene::Scene& scene) {
  const scenario::Step& step = scene.scenario.steps.front();
  double softest = scene.scenario.tissue.young_modulus;
  for (const auto& region : scene.scenario.regions)
    softest = std::min(softest, region.young_modulus);
  if (const auto* creep = std::get_if<scenario::Creep>(&step)) return creep->stress / softest;
  const auto* relax = std::get_if<scenario::Relax>(&step);
  const double mean = relax != nullptr ? relax->strain : std::get<scenario::Compress>(step).strain;
  if (!scene::several_tissues(scene.scenario)) return mean;
  return mean * std::max(1.0, scene.specimen->pressed.young_modulus / softest);
}

// Stress over E of an incompressible neo-Hookean solid.                docs/theory.md [stretch]
double neo_hookean_stress(double strain) {
  const double stretch = 1.0 - strain;
  return (1.0 / (stretch * stretch) - stretch) / 3.0;
}

double neo_hookean_strain(double stress_over_modulus) {
  const auto too_much = [&](double strain) {
    return neo_hookean_stress(strain) - stress_over_modulus;
  };
  constexpr double flat = 1.0 - 1e-6;  // of a specimen that is pressed to nothing
  return numerics::root({0.0, flat}, too_much).middle();
}

class Words {
 public:
  explicit Words(const scene::Scene& scene, std::optional<double> mesh_error = std::nullopt)
      : scene_(scene),
        mesh_error_(mesh_error),
        traits_(scenario::traits(scene.scenario.solver.model)),
        e_(scene.choice.expected) {}

  [[nodiscard]] std::string model() const {
    std::string text = (scene_.choice.given ? "Prescribed by the scenario: " : "Chosen: ") +
                       std::string(traits_.word) + ", " + plain_word(traits_.of);
    std::vector<std::string> with;
    if (!scene_.scenario.uniform() && !scene_.relaxation.elastic()) with.emplace_back("viscosity");
    if (scene_.depth_ratio && !traits_.solid) with.emplace_back("large strains");
    if (!with.empty()) text += ", with " + joined(with, " and ");
    return text + ". " + why();
  }

  // The sentence's part on the error of the largest force, or of the strain.
  [[nodiscard]] static std::string error(const record::Answer& answer) {
    if (!answer.stated_error) return "an error that is not estimated";
    return "an error of " + error_text(*answer.stated_error) + " (" + answer.tolerance + ")" +
           record::uncounted_text(answer);
  }

  // Gives an answer its error, with what is said beside it.
  void state(std::optional<double> error, record::Answer& answer) const {
    answer.stated_error = error;
    if (!error) return;
    answer.tolerance = "tolerance " + percent_text(tolerance());
    if (!scene_.choice.given && *error > tolerance())
      answer.tolerance += follows_hertz()
                              ? ", and with `contact.coupling = \"one_way\"` no model comes nearer"
                              : ", and no model comes nearer";
    answer.uncounted = record::uncounted(answer.effects);
  }

  void neglect(record::Answer& answer) const {
    answer.effects = neglected(scene_);
    if (answer.effects.empty())
      answer.neglected = "Neglected: nothing that would add more than " +
                         percent_text(0.2 * tolerance()) + " to this error.";
    for (const Neglected& one : answer.effects)
      answer.neglected +=
          (answer.neglected.empty() ? "Neglected: " : " Also neglected: ") + one.sentence();
  }

  // What the model leaves out, the largest first.
  std::vector<Neglected> all_neglected() {
    other_laws();
    if (scene_.scenario.uniform()) {
      large_uniform_strain();
    } else {
      size();
      edge();
      ball();
      double_counting();
      large_strains();
      viscosity();
      fresh_tissue();
      waves();
    }
    std::ranges::stable_sort(all_, [](const Neglected& a, const Neglected& b) {
      return std::abs(a.change.value_or(HUGE_VAL)) > std::abs(b.change.value_or(HUGE_VAL));
    });
    return std::move(all_);
  }

 private:
  [[nodiscard]] double tolerance() const { return scene_.scenario.solver.tolerance; }
  // A formula that the scenario names reads no coupling.
  [[nodiscard]] bool one_way() const {
    return scene_.scenario.contact.coupling == contact::Coupling::one_way &&
           !(scene_.choice.given && traits_.formula());
  }
  [[nodiscard]] bool mesh_is_tissue() const {
    return contact::mesh_is_tissue(scene_.scenario.contact.coupling);
  }
  [[nodiscard]] bool follows_hertz() const { return !scene_.scenario.uniform() && one_way(); }
  void omit(const std::string& what, std::optional<double> change, const std::string& when,
            const std::string& remedy = "", const std::string& beside = "") {
    all_.push_back({what, change, when, remedy, beside});
  }

  // Why this model, or what another would do.
  [[nodiscard]] std::string why() const {
    const scene::Choice& choice = scene_.choice;
    const bool uniform = scene_.scenario.uniform();
    if (follows_hertz())
      return "With `contact.coupling = \"one_way\"` the mesh gives the shape; the force is that of "
             "hertz, whatever the size of the body.";
    if (choice.given) {
      if (choice.forecasts.empty()) return "No other was considered.";
      const scene::Forecast& other = choice.otherwise;
      const auto deep = [](bool used) { return used ? " with large strains" : ""; };
      if (other.model == traits_.of &&
          choice.otherwise_found.depth_matters == scene_.depth_ratio.has_value())
        return "It would be chosen anyway.";
      const std::string reason = traits_.formula() ? " " + against(traits_.of, " is ") : "";
      return "Without `solver.model` it would be " + word(other.model) +
             (other.model == traits_.of ? deep(choice.otherwise_found.depth_matters) : "") + ", " +
             error_text(other.known(mesh_error_, traits_.of)) + " from the true force." + reason;
    }
    if (uniform) {
      const auto* springs = choice.forecast(Model::mass_spring);
      if (traits_.of == Model::mass_spring || springs == nullptr)
        return "Only a mesh can be loaded between plates.";
      return "mass_spring would be " + error_text(springs->error) +
             " off, because its springs do not have the tissue's Poisson's ratio.";
    }
    if (choice.otherwise.model != traits_.of)
      return "Another case of the sweep needs it; alone, this one would take " +
             word(choice.otherwise.model) + ".";
    if (traits_.of == Model::hertz) return enough();
    std::string text = against(Model::hertz);
    if (!traits_.formula() &&
        std::holds_alternative<scenario::Cuboid>(scene_.scenario.tissue.shape))
      if (const std::string layer = against(Model::layer); !layer.ends_with(tail(text)))
        text += " " + layer;
    return text;
  }

  // The reason after the model's name, which two models may share.
  [[nodiscard]] static std::string tail(const std::string& sentence) {
    return sentence.substr(std::min(sentence.size(), sentence.find(' ')));
  }

  // Why hertz is enough.
  [[nodiscard]] std::string enough() const {
    if (!scene_.choice.touch.size.allFinite())
      return "The tissue has neither an underside nor sides.";
    return "Size, base and sides of the body change the force by about " +
           percent_text(std::abs(e_.size)) + " only.";
  }

  // What a formula would do in this scene: "hertz would be 14 % low: ..."
  [[nodiscard]] std::string against(Model model, const std::string& verb = " would be ") const {
    const auto& forecasts = scene_.choice.forecasts;
    const auto found =
        std::ranges::find_if(forecasts, [&](const auto& traits) { return traits.model == model; });
    if (found == forecasts.end()) return "";
    if (!found->cannot.empty()) return word(model) + " does not apply: " + found->cannot + ".";
    const bool thickness = model == Model::layer;  // is represented
    const std::string would = word(model) + verb;
    const std::string off = would + error_text(found->error) + " off";
    if (!std::isfinite(e_.thickness) && !thickness)
      return would + "far too low: the tissue is too thin for it.";
    // The largest of what it neglects.
    const double change = thickness ? e_.sides : e_.size;
    const double size = 1.0 / (1.0 + change) - 1.0;
    const double waves = scene_.choice.found.inertia_matters ? e_.inertia : 0.0;
    const double deep = scene_.depth_ratio ? 0.0 : std::abs(e_.deep) + e_.deep_error;
    const double most = std::max({std::abs(size), waves, deep, e_.edge});
    if (most == waves && waves > 0.0)
      return off + ": inertia changes the force by " + percent_text(waves) + " at this speed.";
    if (most == e_.edge && most > 0.0)
      return off + ": an edge is " +
             rounded_text(scene_.choice.touch.to_edge / e_.contact_radius, 2) +
             " contact radii away.";
    if (most == deep && deep > 0.0)
      return off + ": large strains change the force by " + (e_.depth_ratio ? "" : "up to ") +
             percent_text(deep) + ".";
    return off + ": " +
           (thickness                       ? "the sides"
            : each_presses(scene_.scenario) ? "dents of the other spheres and size of the body"
                                            : "size, base and sides of the body") +
           (change < 0.0 ? " lower" : " raise") + " the force by " +
           percent_text(std::abs(change)) + ".";
  }

  void size() {
    const std::string free = one_way()             ? "remove `contact.coupling`"
                             : scene_.choice.given ? "remove `solver.model`"
                                                   : "";
    if ((traits_.of == Model::hertz || one_way()) && std::abs(e_.size) > tolerance())
      omit("the size of the body", e_.size, would_change(e_.size), free);
    else if (traits_.of == Model::layer && std::abs(e_.sides) > tolerance())
      omit("the sides of the body", e_.sides, would_change(e_.sides), free);
  }

  void edge() {
    if (traits_.solid || mesh_is_tissue() || e_.edge <= 0.2 * tolerance()) return;
    omit("an edge of the body near the contact", e_.edge,
         "which may change the force by up to " + percent_text(e_.edge),
         waves_matter() ? "press farther from it"
                        : "set `solver.model = \"solid\"`, or press farther from it");
  }

  void ball() {
    if (traits_.solid || e_.ball <= 0.2 * tolerance()) return;
    omit("the size of the finger, a ball that is stiffer than Hertz's law has it", e_.ball,
         would_change(e_.ball),
         waves_matter() || !meshable() ? "" : "set `solver.model = \"solid\"`");
  }

  // By how much a half-space under `series` is too soft.                 docs/theory.md [depth]
  void double_counting() {
    if (!scene_.specimen || scene_.scenario.contact.coupling != contact::Coupling::series) return;
    const double change = std::pow(2.0 - scene_.finger.compliance_share, 1.5) - 1.0;
    omit("counting the softness of the tissue once only", change, would_change(change),
         "remove `contact.coupling`", "the softness that counts twice");
  }

  void large_strains() {
    const double most = std::abs(e_.deep) + (e_.depth_ratio ? 0.0 : e_.deep_error);
    if (traits_.solid || scene_.depth_ratio || most < 0.2 * tolerance()) return;
    if (!e_.depth_ratio)
      return omit(
          "large strains", most,
          "which may change the force by up to " + percent_text(most) + " where it is deepest",
          waves_matter() || !meshable() ? "press less deep"
          : mesh_is_tissue() ? "set `solver.model = \"solid\"` and remove `contact.coupling`"
                             : "set `solver.model = \"solid\"`");
    std::string remedy = "add `contact.depth = \"neo_hookean\"`";
    if (mesh_is_tissue())
      remedy = (waves_matter() ? remedy : "set `solver.model = \"solid\"`") +
               " and remove `contact.coupling`";
    omit("large strains", e_.deep, would_change(e_.deep) + " where it is deepest", remedy);
  }

  void large_uniform_strain() {
    if (scene_.scenario.solver.kinematics != scenario::Solver::Kinematics::linear) return;
    const double strain = largest_uniform_strain(scene_);
    const bool creeps = std::holds_alternative<scenario::Creep>(scene_.scenario.steps.front());
    const double change =
        (creeps ? neo_hookean_strain(strain) : neo_hookean_stress(strain)) / strain - 1.0;
    if (std::abs(change) < 0.2 * tolerance()) return;
    const std::string of =
        std::string(creeps ? "the strain" : "the stress") + " of incompressible neo-Hookean tissue";
    omit("large strains", change,
         scene::several_tissues(scene_.scenario)
             ? "which would change " + of + " by up to " + percent_text(std::abs(change))
             : would_change(change, of),
         creeps ? "take a smaller stress" : "take a smaller strain", "large strains");
  }

  void viscosity() {
    if (!neglects_viscosity()) return;
    std::string remedy = "add `contact.viscosity = \"tissue\"`";
    if (one_way()) remedy += " and remove `contact.coupling`";
    omit("viscosity", e_.viscous, would_change(e_.viscous) + " while pressing", remedy,
         "viscosity");
  }

  // A body has one law of time, the tissue's.                    docs/theory.md [one_matrix]
  void other_laws() {
    const scenario::Resolved& scenario = scene_.scenario;
    const bool elastic = scenario.uniform() ? scenario.tissue.law.kind == tissue::Viscosity::none
                                            : scene_.relaxation.elastic();
    if (elastic ||
        std::ranges::none_of(scenario.regions, [](const auto& region) { return region.other_law; }))
      return;
    omit("the viscosity of the material of a `[[region]]`", std::nullopt,
         "which takes that of `tissue`; what this changes is not known",
         "set one law of time for all tissues", "the regions' own viscosity");
  }

  // The contact relaxes as if the finger stayed where it is.
  void fresh_tissue() {
    if (scene_.relaxation.elastic() || e_.fresh <= 0.2 * tolerance()) return;
    omit("that a slide loads tissue which has not relaxed", e_.fresh,
         would_change(e_.fresh) + " at most while the finger slides", "slide more slowly",
         "tissue that has not relaxed");
  }

  void waves() {
    if (!waves_matter()) return;
    const std::string when = would_change(e_.inertia) + " at this speed";
    if (!traits_.inertia)
      return omit("inertia of the tissue", e_.inertia, when,
                  meshable() ? mesh_with_waves() : "press more slowly");
    if (scene::inertia_reaches_force(scene_.scenario) || mesh_is_tissue()) return;
    omit("inertia of the tissue", e_.inertia, when,
         "take an integrator with inertia and " + viscosity_with_waves() +
             ", or `contact.coupling = \"resolved\"`");
  }

  [[nodiscard]] bool meshable() const {
    return !std::holds_alternative<scenario::HalfSpace>(scene_.scenario.tissue.shape);
  }

  // `solid` is no remedy then, because it has no inertia.
  [[nodiscard]] bool waves_matter() const { return e_.inertia > tolerance(); }

  // Waves reach the force of a mesh where its springs do not damp them.
  [[nodiscard]] std::string mesh_with_waves() const {
    std::string mesh = "set `solver.model = \"coupled_springs\"`";
    if (scene_.scenario.tissue.viscosity != tissue::Viscosity::none &&
        scene_.scenario.tissue.viscosity != tissue::Viscosity::standard_linear_solid)
      mesh += " and " + viscosity_with_waves();
    return mesh;
  }

  // The viscosity with which waves reach the force: none, or a solid that relaxes in the contact
  // too where the force has viscosity or would have it by the remedy beside this one.
  [[nodiscard]] std::string viscosity_with_waves() const {
    return neglects_viscosity() || !scene_.relaxation.elastic()
               ? "`tissue.viscosity = \"standard_linear_solid\"`"
               : "`tissue.viscosity = \"none\"`";
  }

  [[nodiscard]] bool neglects_viscosity() const {
    return scene_.relaxation.elastic() && !mesh_is_tissue() && e_.viscous > 0.2 * tolerance();
  }

  const scene::Scene& scene_;
  std::optional<double> mesh_error_;
  const scenario::ModelTraits& traits_;
  const scene::Estimates& e_;
  std::vector<Neglected> all_;
};

// What the error of a case is of, as the start of a sentence.
std::string quantity(const scenario::Resolved& scenario) {
  if (!scenario.uniform()) return "The force";
  const bool creeps = std::holds_alternative<scenario::Creep>(scenario.steps.front());
  return creeps ? "The strain" : "The stress";
}

}  // namespace

std::optional<double> stated_error(const scene::Scene& scene, std::optional<double> mesh_error) {
  if (const scene::Forecast* forecast = scene.choice.taken())
    return forecast->known(mesh_error, forecast->model);
  // Without forecasts the force is that of a half-space, because of `one_way`, or unjudged.
  if (scene.scenario.uniform() || scene.scenario.contact.coupling != contact::Coupling::one_way)
    return std::nullopt;
  const scene::Estimates& e = scene.choice.expected;
  return std::abs(1.0 / (1.0 + e.size) - 1.0) + e.size_error + e.edge + e.ball + e.inertia +
         e.deep_error + (scene.depth_ratio ? 0.0 : std::abs(e.deep));
}

Expected expect(const scene::Scene& scene) {
  Expected expected;
  expected.mesh_error = mesh_error(scene);
  const std::optional<double> error = stated_error(scene, expected.mesh_error);
  const Words words(scene, expected.mesh_error);
  record::Answer& answer = expected.answer;
  answer.model = words.model();
  words.neglect(answer);
  words.state(error, answer);
  answer.error = quantity(scene.scenario) + " has " + Words::error(answer) + ".";
  return expected;
}

record::Answer answer(const scene::Scene& scene, const record::CaseRecord& record) {
  const std::optional<double> mesh_error = record::number_of(record, "mesh_error");
  const Words words(scene, mesh_error);
  const auto peak = record::peak_of(record);
  record::Answer answer;
  answer.model = words.model();
  words.neglect(answer);
  answer.error =
      peak ? "Peak " + peak->of + ": " + rounded_text(peak->value, 3) + peak->unit : "No result";
  if (record.outcome == record::Outcome::completed) {
    words.state(stated_error(scene, mesh_error), answer);
    answer.error += ", with " + Words::error(answer) + ".";
  } else {
    answer.error += peak ? " " + record::reached_text(record) + ", where the run " +
                               (record.unstable ? "diverged" : "ended") + "; no error is stated."
                         : ": the run ended at its start.";
  }
  return answer;
}

std::vector<Neglected> neglected(const scene::Scene& scene) { return Words(scene).all_neglected(); }

bool states_mesh_error(const scene::Scene& scene) {
  return !scene.scenario.uniform() &&
         (scene.solid ||
          (scene.specimen && scene.scenario.contact.coupling == contact::Coupling::consistent));
}

std::optional<double> mesh_error(const scene::Scene& scene) {
  if (scene.solid || !states_mesh_error(scene)) return std::nullopt;
  mechanics::PressedMesh mesh(scene);
  mechanics::Touch touch;
  touch.finger = scene::first_touch(scene).finger;
  const double deepest = scene::deepest_travel(scene.scenario, scene.law());
  if (mesh.try_out(touch.finger - deepest * Vec3::UnitZ(), touch)) return std::nullopt;
  const mechanics::SphereContact* contact = touch.deepest();
  if (contact == nullptr) return std::nullopt;
  return mechanics::mesh_error(*contact);
}

}  // namespace palpate::run
