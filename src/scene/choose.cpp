// Evaluates the questions in order, and chooses the cheapest model within the tolerance.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "scenario/integrators.h"
#include "scenario/programme.h"
#include "scene/estimates.h"
#include "scene/model_errors.h"
#include "scene/places.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"
#include "scene/time_plan.h"

namespace palpate::scene {
namespace {

using scenario::Model;
using scenario::Rung;
using Integrator = scenario::Solver::Integrator;

// The cheapest applicable model within the tolerance, or else the one with the least error; null
// without forecasts.
const Forecast* cheapest(const Choice& choice, bool uniform, double tolerance) {
  const Forecast* best = nullptr;
  for (const Forecast& rung : choice.rungs) {
    if (!rung.cannot.empty()) continue;
    if (scenario::rung(rung.model).solid) continue;  // only where it is named
    // The force of a press is that of finite elements on either kind of springs, but motion and
    // pictures of independent springs do not have the tissue's Poisson's ratio.
    if (!uniform && scenario::rung(rung.model).independent()) continue;
    if (best == nullptr || rung.error < best->error) best = &rung;
    if (rung.error > tolerance) continue;
    return &rung;
  }
  return best;
}

// The texts of a question, with its answers below and above the threshold; answers that contain
// numbers are made where the question is evaluated.
struct QuestionRow {
  const char* word;     // the name of the enumerator
  const char* topic;    // one word
  const char* measure;  // what the number is; empty if it only says yes or no
  const char* below;
  const char* above;
};
constexpr auto question_table = std::to_array<QuestionRow>({
    {"uniform", "test", "", "", "the end faces are loaded, which only a mesh can compute"},
    {"ratio_matters", "ratio", "error of independent springs",
     "independent springs have the right Young's modulus",
     "independent springs have a Poisson's ratio of their own"},
    {"force_knows_mesh", "coupling", "", "one_way: the force is that of hertz, whatever the mesh",
     ""},
    {"rigid_tissue", "stiffness", "the tissue's share of the deformation",
     "only the finger deforms", "the tissue deforms"},
    {"half_space", "size", "error of a force that ignores the body's size",
     "what its size changes in all is within the limit", ""},
    {"layer", "sides", "decrease of the force by the sides", "the sides do not matter",
     "the sides matter"},
    {"deep", "depth", "change of the force by large strains", "small strains are enough", ""},
    {"curved", "curvature", "difference between the two curvatures, finger included",
     "one curvature is enough", "both curvatures matter, the contact is elliptic"},
    {"time_dependent", "viscosity", "increase of the force by viscosity",
     "the press is slow against the tissue's time constant", ""},
    {"inertia", "inertia", "increase of the force by waves", "the loading is slow against waves",
     ""},
    {"shape_or_inclusion", "formula", "", "", ""},
});
static_assert(is_complete<Asked>(question_table), "every question has its text");

class Chooser {
 public:
  Chooser(const scenario::Case& one, SpecimenShapes& shapes)
      : case_(one),
        shapes_(shapes),
        asked_(scenario::resolve(one, scenario::strongest.of)),
        model_(one.scenario.solver.model.value_or(asked_.solver.model)) {
    place_in_scene(asked_, one.folder, shapes);
    if (!asked_.uniform()) choice_.touch = surface_touch(asked_, one.folder, shapes);
  }

  Choice choose() {
    choice_.given = case_.scenario.solver.model.has_value();
    if (asked_.uniform())
      uniform();
    else
      pressed();
    if (choice_.given) choice_.found = {.inertia_matters = !rests()};
    choice_.chosen = scenario::resolve(case_, model_, choice_.found);
    place_in_scene(choice_.chosen, case_.folder, shapes_);
    return choice_;
  }

 private:
  // Adds a question. `above` and `measure` replace the texts of the table unless they are empty.
  void ask(Asked of, double number, double threshold, const std::string& above = "",
           const std::string& measure = "") {
    const QuestionRow& row = question_table[as_index(of)];
    choice_.questions.push_back({row.topic, measure.empty() ? row.measure : measure, number,
                                 threshold,
                                 number < threshold ? row.below
                                 : above.empty()    ? row.above
                                                    : above});
  }

  [[nodiscard]] double tolerance() const { return asked_.solver.tolerance; }

  // Whether a slow press by a named model is one of statics: nothing damps the ringing of a mesh
  // without viscosity, which would turn its tetrahedra inside out.
  [[nodiscard]] bool rests() const {
    return !asked_.uniform() && !choice_.otherwise_found.inertia_matters &&
           asked_.tissue.viscosity == tissue::Viscosity::none &&
           asked_.solver.kinematics == scenario::Solver::Kinematics::linear &&
           !asked_.solver.rings && !scenario::asks_for_steps(case_.scenario.solver);
  }

  // Questions for a test of a specimen between platens.
  void uniform() {
    const double nu = asked_.tissue.poisson_ratio;
    const bool bonded = asked_.tissue.base == tissue::Base::bonded ||
                        scenario::upper_platen(asked_) == tissue::Base::bonded;
    const auto& shape = asked_.tissue.shape;
    const bool prism = std::holds_alternative<scenario::Cuboid>(shape) ||
                       std::holds_alternative<scenario::Cylinder>(shape);
    // With a bonded end or several tissues the strain is uneven and nu matters; springs have 1/4.
    // Independent springs get the stiffness of a prism whatever the shape: measured on the
    // ligament (22 %) and the leg (40 %).
    const bool uneven = bonded || several_tissues(asked_) || !prism;
    constexpr double even_error = 0.001;
    constexpr double shape_error = 0.4;
    const double meshed = bonded_mesh_error(asked_);
    const double stiffening = bonded_stiffening(asked_, nu) / bonded_stiffening(asked_, 0.25);
    const double ratio_error =
        !prism   ? shape_error
        : uneven ? std::max(0.5 * std::abs(nu - 0.25), std::abs(1.0 - 1.0 / stiffening)) + meshed
                 : even_error;
    ask(Asked::uniform, 1.0, 0.5);
    ask(Asked::ratio_matters, ratio_error, tolerance(), "",
        !prism   ? "error of independent springs on a shape that is no prism"
        : uneven ? "error of independent springs with fixed ends or several tissues"
                 : "");
    const bool moving = about(asked_.solver.integrator).inertia;
    const double ringing = moving ? uniform_ringing(asked_) : 0.0;
    if (moving)
      ask(Asked::inertia, ringing, tolerance(), "the body rings",
          "share of the strain by which it rings");
    choice_.found.inertia_matters = moving;
    const auto error_of_still = [&](const Rung& rung) {
      return rung.own_ratio ? even_error + std::max(uneven ? rung.error.uneven : 0.0, meshed)
                            : ratio_error;
    };
    for (const Rung& rung : scenario::ladder)
      if (rung.uniform) add(rung, errors_.counted(ringing) + error_of_still(rung));
    take_cheapest();
  }

  void pressed() {
    choice_.expected = estimate(asked_, choice_.touch);
    const Estimates& e = choice_.expected;
    const double limit = tolerance();
    // The reason why no formula is applicable, if none is.
    std::optional<std::string> reason = beyond(Model::hertz, asked_, choice_.touch);
    const bool box = std::holds_alternative<scenario::Cuboid>(asked_.tissue.shape);
    if (asked_.contact.coupling == contact::Coupling::one_way && !reason) {
      ask(Asked::force_knows_mesh, 0.0, 1.0);
      if (!choice_.given) model_ = Model::hertz;
      return;
    }
    std::string formulas;
    for (const Rung& rung : scenario::ladder)
      if (rung.formula() && !beyond(rung.of, asked_, choice_.touch))
        formulas += (formulas.empty() ? "" : " or ") + std::string(rung.word);
    ask(Asked::rigid_tissue, e.tissue_share, std::min(limit, 0.02));
    ask(Asked::half_space, half_space_error(e), limit,
        (e.thickness < 0.0 ? "the layers below take " : "the thickness adds ") +
            percent_text(std::abs(e.thickness)) +
            (box ? ", the sides take " + percent_text(e.sides)
                 : ", the width of the body and of its base takes " + percent_text(e.narrow)));
    if (box) ask(Asked::layer, e.sides, limit);
    decide(e);
    if (choice_.found.size_matters) {
      std::string& answer = choice_.questions.back().answer;
      answer = choice_.questions.back().number < limit ? "small, but " : "";
      answer += "with the factor for it no mesh is needed";
    }
    ask(Asked::deep, std::abs(e.deep), deep_limit(), deep_answer(e));
    if (choice_.found.depth_matters && std::abs(e.deep) < deep_limit())
      choice_.questions.back().answer =
          "small, but with the factor for it a cheaper model is enough";
    ask(Asked::curved, e.curvature_ratio - 1.0, 0.1);
    // A fifth of the tolerance, because viscosity that is left out adds to the model's error.
    ask(Asked::time_dependent, e.viscous, 0.2 * limit, viscous_answer());
    ask(Asked::inertia, e.inertia, limit, inertia_answer());
    if (choice_.found.inertia_matters && e.inertia < limit)
      choice_.questions.back().answer = "small, but nothing is within the limit without it";
    ask(Asked::shape_or_inclusion, 1.0, 0.0,
        formulas.empty() ? "none, because " + reason.value_or("") : formulas);

    take_cheapest();
  }

  // A fifth of the tolerance, because depth that is left out adds to the model's error.
  [[nodiscard]] double deep_limit() const { return 0.2 * tolerance(); }

  // What matters, and the error of every rung. The factors of a deep press and of the body's size
  // are taken as well where a cheaper model is enough with them, and motion where nothing else is.
  void decide(const Estimates& e) {
    const scenario::Found needed{
        .viscosity_matters = e.viscous >= 0.2 * tolerance(),
        .inertia_matters = e.inertia >= tolerance(),
        .depth_matters = std::abs(e.deep) >= deep_limit() && errors_.has_depth_ratio()};
    scenario::Found best;
    std::optional<Forecast> least;
    const auto serves = [&](const Forecast& one) { return one.error <= tolerance(); };
    for (const bool motion : {false, true})
      for (const bool size : {false, true})
        for (const bool depth : {false, true}) {
          if (motion && (needed.inertia_matters || !errors_.moves())) continue;
          if (depth && (needed.depth_matters || !errors_.has_depth_ratio())) continue;
          if (least && serves(*least) &&
              (motion || least->model == scenario::ladder.front().of ||
               (size && !scenario::rung(least->model).meshed())))
            continue;
          choice_.found = needed;
          choice_.found.inertia_matters |= motion;
          choice_.found.size_matters = size;
          choice_.found.depth_matters |= depth;
          evaluate();
          const Forecast one = *cheapest(choice_, false, tolerance());
          if (least && (serves(one) != serves(*least) ? serves(*least)
                        : serves(one)                 ? one.model >= least->model
                                                      : one.error >= least->error))
            continue;
          least = one;
          best = choice_.found;
        }
    choice_.waves = best.inertia_matters ? 0.0 : errors_.counted(e.inertia);
    choice_.otherwise = *least;
    choice_.otherwise_found = best;
    if (choice_.found == best && !choice_.given) return;
    choice_.found = best;
    evaluate(choice_.given ? std::optional(model_) : std::nullopt);
  }

  // A model that is named has no more than the scenario gives it.
  void evaluate(std::optional<Model> named = {}) {
    choice_.rungs.clear();
    for (const Rung& rung : scenario::ladder) {
      scenario::Found found = choice_.found;
      if (named == rung.of) found.depth_matters = found.size_matters = false;
      add(rung, errors_.of(rung, found), errors_.of_mesh(rung));
    }
  }

  [[nodiscard]] std::string deep_answer(const Estimates& e) const {
    std::string change = e.deep < 0.0 ? "lower" : "raise";
    change += " the force by " + percent_text(std::abs(e.deep));
    if (!choice_.expected.depth_ratio)
      return "large strains " + change + " near this place, but the factor is not known here";
    return "large strains " + change + ", and a factor takes this into account";
  }

  [[nodiscard]] std::string viscous_answer() const {
    if (asked_.contact.viscosity == scenario::Contact::Viscosity::tissue)
      return "Lee and Radok's force while the contact grows, Ting's while it shrinks";
    return "left out, because the scenario does not set `contact.viscosity`: the force is that of "
           "the relaxed tissue";
  }

  [[nodiscard]] std::string inertia_answer() const {
    if (errors_.moves()) return "a mesh includes it, a formula does not";
    return "left out of the force of this scenario: `consistent` includes it with "
           "`viscosity` none, nodal_drag, or a solid that relaxes in the contact too; else use "
           "`resolved`";
  }

  void add(const Rung& rung, double error, double of_mesh = 0.0) {
    if (rung.solid && model_ != rung.of) return;
    if (!asked_.uniform())
      if (auto cannot = beyond(rung.of, asked_, choice_.touch)) {
        choice_.rungs.push_back({.model = rung.of, .cannot = *cannot});
        return;
      }
    // The time of a set-up by conjugate gradients.
    const double nodes = expected_nodes(asked_.tissue.mesh);
    const double set_up = 5.5e-5 * nodes * std::max(1.0, std::cbrt(nodes / 8000.0));
    choice_.rungs.push_back({.model = rung.of,
                             .error = error,
                             .of_mesh = of_mesh,
                             .seconds = rung.cost.once +
                                        (asked_.regions.empty() ? 0.0 : rung.cost.layered) +
                                        rung.cost.set_ups * set_up});
  }

  void take_cheapest() {
    if (asked_.uniform()) choice_.otherwise = *cheapest(choice_, true, tolerance());
    if (!choice_.given) model_ = choice_.otherwise.model;
  }

  const scenario::Case& case_;
  SpecimenShapes& shapes_;
  scenario::Resolved asked_;  // resolved with the most complete model, whatever the scenario names
  Model model_;               // the choice
  Choice choice_;
  const ModelErrors errors_{case_.scenario, asked_, choice_.touch, choice_.expected};
};

}  // namespace

const Forecast* Choice::forecast(Model model) const {
  for (const Forecast& rung : rungs)
    if (rung.model == model && rung.cannot.empty()) return &rung;
  return nullptr;
}

std::string Choice::shortfall(std::optional<double> mesh_error) const {
  const Forecast* rung = taken();
  const double error = rung != nullptr ? rung->known(mesh_error) : 0.0;
  if (given || !(error > chosen.solver.tolerance)) return "";
  return "no model is expected to be within the tolerance of " +
         percent_text(chosen.solver.tolerance) + ": `" + scenario::rung(rung->model).word +
         "` comes nearest with " + error_text(error) +
         (coarse_mesh(chosen, touch) ? "; a finer `tissue.mesh` may help" : "");
}

Choice choose(const scenario::Case& one) {
  SpecimenShapes shapes;
  return choose(one, shapes);
}

Choice choose(const scenario::Case& one, SpecimenShapes& shapes) {
  return Chooser(one, shapes).choose();
}

Choice given_choice(const scenario::Case& one, Model model, SpecimenShapes& shapes) {
  Choice choice;
  choice.given = true;
  choice.chosen = scenario::resolve(one, model);
  place_in_scene(choice.chosen, one.folder, shapes);
  if (choice.chosen.uniform()) return choice;
  choice.touch = surface_touch(choice.chosen, one.folder, shapes);
  choice.expected = estimate(choice.chosen, choice.touch);
  return choice;
}

}  // namespace palpate::scene
