// Evaluates the questions in order, and chooses the cheapest model within the tolerance.
#include "run/choose.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "contact/layer.h"
#include "meshing/tetgen_body.h"
#include "run/family.h"
#include "run/size_effect.h"
#include "scenario/integrators.h"
#include "scenario/programme.h"
#include "scene/places.h"
#include "scene/proportions.h"
#include "scene/refining_press.h"
#include "scene/specimen_shape.h"
#include "scene/time_plan.h"
#include "solid/finger_press.h"

namespace palpate::run {
namespace {

using scenario::Found;
using scenario::Model;
using scenario::ModelTraits;
using scene::Asked;
using scene::Choice;
using scene::Estimates;
using scene::Forecast;
using scene::SpecimenShapes;

// The cheapest applicable model within the tolerance, or else the one with the least error; null
// without forecasts.
const Forecast* cheapest(const Choice& choice, bool uniform, double tolerance) {
  const Forecast* best = nullptr;
  for (const Forecast& forecast : choice.forecasts) {
    if (!forecast.cannot.empty()) continue;
    // The force of a press is that of finite elements on either kind of springs, but motion and
    // pictures of independent springs do not have the tissue's Poisson's ratio.
    if (!uniform && scenario::traits(forecast.model).independent()) continue;
    if (best == nullptr || forecast.error < best->error) best = &forecast;
    if (forecast.error > tolerance) continue;
    return &forecast;
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
    {"half_space", "size", "change of a half-space's force by the size of the body",
     "a half-space is enough", "the body is not a half-space"},
    {"layer", "sides", "change of a flat layer's force by the sides", "the sides do not matter",
     "the sides matter"},
    {"edge", "edge", "bound of what an edge near the contact changes", "no edge is near",
     "only a mesh with large strains knows the edge"},
    {"deep", "depth", "change of the force by large strains", "small strains are enough", ""},
    {"curved", "curvature", "difference between the two curvatures, finger included",
     "the contact is nearly circular", "both curvatures matter, the contact is elliptic"},
    {"time_dependent", "viscosity", "increase of the force by viscosity",
     "the press is slow against the tissue's time constant", ""},
    {"inertia", "inertia", "change of the force by inertia", "the loading is slow", ""},
    {"shape_or_inclusion", "formula", "", "", ""},
    {"family", "family", "", "",
     "another case needs it, and cases that are compared take one model"},
});
static_assert(is_complete<Asked>(question_table), "every question has its text");

class Chooser {
 public:
  Chooser(const scenario::Case& one, SpecimenShapes& shapes, Models models)
      : case_(one),
        shapes_(shapes),
        quick_(models == Models::quick),
        asked_(scenario::resolve(one, scenario::strongest.of)),
        model_(one.scenario.solver.model.value_or(asked_.solver.model)) {
    scene::place_in_scene(asked_, one.folder, shapes);
    if (!asked_.uniform()) choice_.touch = surface_touch(asked_, one.folder, shapes);
  }

  Choice choose() {
    choice_.given = case_.scenario.solver.model.has_value();
    if (asked_.uniform())
      uniform();
    else
      pressed();
    if (choice_.given)
      choice_.found = {.inertia_matters = !rests(), .depth_matters = takes_depth(model_)};
    choice_.chosen = scenario::resolve(case_, model_, choice_.found);
    scene::place_in_scene(choice_.chosen, case_.folder, shapes_);
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

  // Whether a model that the scenario names has the factor of a deep press where `auto` finds that
  // it matters: a layer is the same by either way, the others are what their names say.
  [[nodiscard]] bool takes_depth(Model named) const {
    return named == Model::layer && choice_.found.depth_matters;
  }

  // Questions for a test of a specimen between platens.
  void uniform() {
    double nu = asked_.tissue.poisson_ratio;  // the farthest from that of independent springs
    for (const auto& region : asked_.regions)
      if (std::abs(region.poisson_ratio - 0.25) > std::abs(nu - 0.25)) nu = region.poisson_ratio;
    const bool bonded = asked_.tissue.base == tissue::Base::bonded ||
                        scenario::upper_platen(asked_) == tissue::Base::bonded;
    const auto& shape = asked_.tissue.shape;
    const bool prism = std::holds_alternative<scenario::Cuboid>(shape) ||
                       std::holds_alternative<scenario::Cylinder>(shape) ||
                       std::holds_alternative<scenario::Disc>(shape);
    // With a bonded end or several tissues the strain is uneven and nu matters; springs have 1/4.
    // Independent springs get the stiffness of a prism whatever the shape: measured on the
    // ligament (22 %) and the leg (40 %).
    const bool uneven = bonded || scene::several_tissues(asked_) || !prism;
    constexpr double shape_error = 0.4;
    const double meshed = bonded || scene::several_tissues(asked_) ? uneven_mesh_error() : 0.0;
    const double stiffening =
        scene::bonded_stiffening(asked_, nu) / scene::bonded_stiffening(asked_, 0.25);
    const double ratio_error =
        !prism   ? shape_error
        : uneven ? std::max(0.5 * std::abs(nu - 0.25), std::abs(1.0 - 1.0 / stiffening)) + meshed
                 : least_error;
    ask(Asked::uniform, 1.0, 0.5);
    ask(Asked::ratio_matters, ratio_error, tolerance(), "",
        !prism   ? "error of independent springs on a shape that is no prism"
        : uneven ? "error of independent springs with fixed ends or several tissues"
                 : "");
    const bool moving = about(asked_.solver.integrator).inertia;
    const double ringing = moving ? scene::uniform_ringing(asked_) : 0.0;
    if (moving)
      ask(Asked::inertia, ringing, tolerance(), "the body vibrates",
          "share of the strain by which it vibrates");
    choice_.found.inertia_matters = moving;
    const auto error_of_still = [&](const ModelTraits& traits) {
      return traits.own_ratio ? least_error + std::max(uneven ? traits.uneven : 0.0, meshed)
                              : ratio_error;
    };
    for (const ModelTraits& traits : scenario::model_table)
      if (traits.uniform) add(traits, counted(ringing) + error_of_still(traits));
    take_cheapest();
  }

  // What a mesh misses of a specimen of several tissues or with fixed ends, by another with shorter
  // or longer cells: stresses are singular where borders of tissues and fixed ends meet the free
  // side, so that the error goes with the length of the cells, or more slowly.
  //                                                          docs/theory.md, below [compression]
  [[nodiscard]] double uneven_mesh_error() {
    scenario::Resolved other = asked_;
    scenario::Mesh& mesh = other.tissue.mesh;
    if (std::holds_alternative<scenario::MeshFile>(mesh)) return 0.0;
    const double nodes = scene::expected_nodes(mesh);
    const double finer = nodes < 300.0 ? 4.0 : nodes < 2000.0 ? 2.0 : 0.5;
    const auto change = [&](std::array<int, 3>& cells) {
      for (int& number : cells) number = std::max(1, static_cast<int>(finer * number));
    };
    if (auto* kuhn = std::get_if<scenario::Kuhn>(&mesh)) change(kuhn->cells);
    if (auto* mirrored = std::get_if<scenario::Mirrored>(&mesh)) change(mirrored->cells);
    if (auto* tetgen = std::get_if<scenario::Tetgen>(&mesh)) {
      tetgen->nodes = static_cast<int>(std::pow(finer, 3) * tetgen->nodes);
      tetgen->tetrahedra.reset();
    }
    // The cases of a sweep that differ in nothing else share it.
    std::string key = scene::shape_key(asked_) + " between platens " +
                      std::to_string(static_cast<int>(asked_.tissue.base)) + " " +
                      std::to_string(static_cast<int>(scenario::upper_platen(asked_))) + " " +
                      number_text(asked_.tissue.poisson_ratio);
    for (const auto& region : asked_.regions)
      key += " " + number_text(region.young_modulus / asked_.tissue.young_modulus) + " " +
             number_text(region.poisson_ratio);
    const auto measure = [&]() -> scene::SpecimenShapes::Numbers {
      try {
        const double difference = std::abs(platen_modulus(other) / platen_modulus(asked_) - 1.0);
        return {finer > 1.0 ? 2.0 * difference : difference};
      } catch (const MeshError&) {   // the models that mesh the body say why,
      } catch (const InputError&) {  // and where the mistake stands
      }
      return {unknown};
    };
    return shapes_.kept_numbers(key, measure)[0];
  }

  [[nodiscard]] double platen_modulus(const scenario::Resolved& scenario) {
    scenario::Family family;
    family.folder = case_.folder;
    scene::Choice choice;
    choice.given = true;
    choice.chosen = scenario;
    choice.chosen.solver.model = Model::coupled_springs;
    return scene::build({}, family, shapes_, choice).specimen->pressed.young_modulus;
  }

  void pressed() {
    choice_.expected = estimate(asked_, choice_.touch);
    const double limit = tolerance();
    // The reason why no formula is applicable, if none is.
    std::optional<std::string> reason = beyond(Model::hertz, asked_, choice_.touch);
    const bool box = std::holds_alternative<scenario::Cuboid>(asked_.tissue.shape);
    measure();
    const Estimates& e = choice_.expected;
    const bool named_formula = choice_.given && scenario::traits(model_).formula();
    if (asked_.contact.coupling == contact::Coupling::one_way && !reason && !named_formula) {
      ask(Asked::force_knows_mesh, 0.0, 1.0);
      if (!choice_.given) model_ = Model::hertz;
      return;
    }
    std::string formulas;
    for (const ModelTraits& traits : scenario::model_table)
      if (traits.formula() && !beyond(traits.of, asked_, choice_.touch))
        formulas += (formulas.empty() ? "" : " or ") + std::string(traits.word);
    ask(Asked::rigid_tissue, e.tissue_share, std::min(limit, 0.02));
    if (!reason) ask(Asked::half_space, std::abs(e.size), limit);
    if (box && !beyond(Model::layer, asked_, choice_.touch))
      ask(Asked::layer, std::abs(e.sides), limit);
    if (e.edge > 0.0) ask(Asked::edge, e.edge, limit);
    choice_.found = {.viscosity_matters = e.viscous >= 0.2 * limit,
                     .inertia_matters = e.inertia >= limit,
                     .depth_matters = std::abs(e.deep) >= 0.2 * limit && has_depth_ratio()};
    for (const ModelTraits& traits : scenario::model_table) {
      Found found = choice_.found;
      if (choice_.given && model_ == traits.of) found.depth_matters = takes_depth(traits.of);
      add(traits, error_of(traits, found), of_mesh(traits));
    }
    choice_.waves = choice_.found.inertia_matters ? 0.0 : counted(e.inertia);
    choice_.otherwise = *cheapest(choice_, false, limit);
    choice_.otherwise_found = choice_.found;
    if (const auto& depth = case_.scenario.contact.depth)
      choice_.otherwise_found.depth_matters = *depth == scenario::Contact::Depth::neo_hookean;
    if (choice_.given && choice_.otherwise.model == model_)  // without a name it takes the depth
      choice_.otherwise.error = error_of(scenario::traits(model_), choice_.found);
    ask(Asked::deep, std::abs(e.deep) + (e.depth_ratio ? 0.0 : e.deep_error), 0.2 * limit,
        deep_answer(e), e.depth_ratio ? "" : "bound of what large strains change");
    ask(Asked::curved, e.curvature_ratio - 1.0, 0.1);
    // A fifth of the tolerance, because neglected viscosity adds to the model's error.
    ask(Asked::time_dependent, e.viscous, 0.2 * limit, viscous_answer());
    ask(Asked::inertia, e.inertia, limit, inertia_answer());
    ask(Asked::shape_or_inclusion, 1.0, 0.0,
        formulas.empty() ? "none, because " + reason.value_or("") : formulas);
    if (choice_.given) return;
    model_ = choice_.otherwise.model;
    if (!case_.at_least || *case_.at_least <= model_) return;
    const Forecast* common = choice_.forecast(*case_.at_least);
    if (common == nullptr) return;
    ask(Asked::family, 1.0, 0.0);
    model_ = common->model;
  }

  // Whether a body from a file may yield as a whole: not one that is held below the finger, without
  // a gap, by a large part of its surface.
  [[nodiscard]] bool may_swing() {
    constexpr double large = 0.15;
    if (!std::holds_alternative<scenario::SurfaceFile>(asked_.tissue.shape)) return false;
    const scene::SurfaceTouch& touch = choice_.touch;
    const auto& body = *shapes_.surface(asked_, case_.folder).must();
    return !std::isfinite(touch.to_base) || touch.tissue_to_base < touch.to_base ||
           scene::base_area(asked_, body.surface(), touch.position, 0.0).of_surface < large;
  }

  // Presses a coarse mesh of the body, where something of it is asked for.
  void measure() {
    const bool none =
        std::holds_alternative<scenario::HalfSpace>(asked_.tissue.shape) || choice_.touch.nowhere;
    const bool formula = !beyond(Model::hertz, asked_, choice_.touch) ||
                         !beyond(Model::layer, asked_, choice_.touch);
    if (none || (!formula && scene::refines(asked_) && !may_swing())) return;
    if (scene::step_through(asked_, choice_.touch, choice_.expected) > 0)
      return;  // will be refused
    Estimates& e = choice_.expected;
    if (formula && scene::refines(asked_) && !each_presses(asked_) &&
        std::holds_alternative<scenario::Cuboid>(asked_.tissue.shape) &&
        choice_.touch.to_edge >= far_sides * choice_.touch.thickness) {
      e.measured = true;
      return;
    }
    try {
      const double seconds = e.rate > 0.0 ? e.travel / e.rate : HUGE_VAL;
      const SizeEffect found = size_effect(asked_, case_.folder, choice_.touch, seconds, shapes_);
      if (found.nodes == 0) return;
      // Where the body yields, a force needs a longer way than Hertz's depth.
      if (const Estimates farther = estimate(asked_, choice_.touch, yields(found));
          farther.travel > e.travel) {
        choice_.expected = farther;
        return measure();
      }
      if (!formula && scene::refines(asked_)) {
        e.swing = swing(found, e, choice_.touch, asked_.tissue);
        e.inertia += e.swing;
        return;
      }
      coarse_nodes_ = found.nodes;
      // What an elastic finger takes of the depth knows nothing of the body.
      const double change = e.tissue_share * found.change;
      e.size_error = e.tissue_share * found.error;
      e.swing = swing(found, e, choice_.touch, asked_.tissue);
      e.inertia += e.swing;
      e.measured = true;
      if (std::holds_alternative<scenario::Cuboid>(asked_.tissue.shape)) {
        const bool layered = !asked_.regions.empty();
        e.sides = layered ? change : (1.0 + change) / (1.0 + e.thickness) - 1.0;
        e.sides = std::clamp(e.sides, -most_by_sides(), most_by_sides());
        e.size = layered ? (1.0 + e.thickness) * (1.0 + change) - 1.0 : change;
      } else {
        e.size = change;
      }
    } catch (const meshing::Needles&) {  // no model has a mesh
      throw;
    } catch (const MeshError&) {   // the models that mesh the body say why,
    } catch (const InputError&) {  // and where the mistake stands
    }
  }

  // The error that a model is expected to have with what the scenario gives it, and with what was
  // found where the scenario leaves a key open, a fraction of the force.
  [[nodiscard]] double error_of(const ModelTraits& traits, const Found& found) const {
    const Estimates& e = choice_.expected;
    if (traits.solid) return of_mesh(traits) + of_waves(traits, found);
    const double body = traits.meshed() ? of_mesh(traits) : of_size(traits);
    return body + of_waves(traits, found) +
           (contact::mesh_is_tissue(asked_.contact.coupling) ? 0.0 : e.edge) + e.ball +
           of_depth(traits, found);
  }

  // The part of it that the mesh causes; 0 without one. Where the mesh is refined, what refining
  // leaves, else the error of the coarse mesh, which falls with the square of the cells' size.
  [[nodiscard]] double of_mesh(const ModelTraits& traits) const {
    if (traits.solid) {
      const double narrowed = std::max(1.0, solid::most_narrowed / choice_.touch.width);
      if (tolerance() >= solid::error_of_one_mesh) return narrowed * solid::error_of_one_mesh;
      return narrowed * std::max(tolerance(), solid::error_of_three_meshes);
    }
    if (!traits.meshed()) return 0.0;
    if (scene::refines(asked_)) return scene::refined_share * tolerance();
    if (coarse_nodes_ == 0) return unknown;
    if (std::holds_alternative<scenario::MeshFile>(asked_.tissue.mesh))
      return choice_.expected.size_error;
    return choice_.expected.size_error *
           std::pow(coarse_nodes_ / scene::expected_nodes(asked_.tissue.mesh), 2.0 / 3.0);
  }

  // What a formula does not know of the body's size, over the body's force.
  [[nodiscard]] double of_size(const ModelTraits& traits) const {
    const Estimates& e = choice_.expected;
    if (std::holds_alternative<scenario::HalfSpace>(asked_.tissue.shape)) return 0.0;
    if (!e.measured) return unknown;
    const double change = traits.of == Model::hertz ? e.size : e.sides;
    const double error = std::abs(1.0 / (1.0 + change) - 1.0) + e.size_error;
    return traits.of == Model::hertz ? error : std::min(error, most_by_sides());
  }

  // What free sides change fades with exp(-1.2 b/H) at least, the slowest of the fields in a layer
  // that is held below and free above. A coarse mesh may be farther off.
  [[nodiscard]] double most_by_sides() const {
    const scene::SurfaceTouch& touch = choice_.touch;
    if (!std::holds_alternative<scenario::Cuboid>(asked_.tissue.shape) || !asked_.regions.empty() ||
        asked_.tissue.base != tissue::Base::bonded ||
        touch.to_edge < 0.5 * far_sides * touch.thickness)
      return unknown;
    return std::exp(-1.2 * (touch.to_edge / touch.thickness - choice_.expected.chi));
  }

  // What the depth leaves open: the error of its factor, or the neglected effect. The factor
  // is of statics; of what waves add to the force, the bound is open. At least 0.1 %, for a contact
  // that is never quite as small as a contact law assumes.
  [[nodiscard]] double of_depth(const ModelTraits& traits, const Found& found) const {
    using Depth = scenario::Contact::Depth;
    const Estimates& e = choice_.expected;
    const auto depth = case_.scenario.contact.depth.value_or(
        found.depth_matters ? Depth::neo_hookean : Depth::hertz);
    const bool used = depth == Depth::neo_hookean && has_depth_ratio();
    const double waves = computes_waves(traits, found) ? e.inertia : 0.0;
    const double in_waves = e.depth_ratio ? waves / (1.0 + waves) * e.deep_bound : 0.0;
    return std::max(least_error, (used ? 0.0 : std::abs(e.deep)) + e.deep_error + in_waves);
  }

  // All of the effect where the model does not move, or its mesh does not carry the waves; else a
  // part of it, over the force that contains it.
  [[nodiscard]] double of_waves(const ModelTraits& traits, const Found& found) const {
    const bool carried =
        computes_waves(traits, found) &&
        scene::carries_waves(asked_, choice_.touch, choice_.expected.contact_radius);
    const double waves = counted(choice_.expected.inertia);
    return carried ? traits.waves * waves / (1.0 + waves) : waves;
  }

  [[nodiscard]] bool computes_waves(const ModelTraits& traits, const Found& found) const {
    const auto& integrator = case_.scenario.solver.integrator;
    const bool moving = integrator ? about(*integrator).inertia : found.inertia_matters;
    return traits.inertia && moving && moves();
  }

  // A neglected effect of inertia. It counts from a fifth of the tolerance on, as depth and
  // viscosity do.
  [[nodiscard]] double counted(double inertia) const {
    return inertia < 0.2 * tolerance() ? 0.0 : inertia;
  }

  // Whether the models of this scenario can use the factor of a deep press.
  [[nodiscard]] bool has_depth_ratio() const {
    return choice_.expected.depth_ratio && !contact::mesh_is_tissue(asked_.contact.coupling);
  }

  // Whether the tissue's inertia affects the force on a mesh.
  [[nodiscard]] bool moves() const { return scene::inertia_reaches_force(asked_); }

  // Why `auto` does not take `solid`; empty if it may. The checks of a scenario that names it are
  // those of the first two sentences.
  [[nodiscard]] std::string no_solid() const {
    const scenario::Scenario& given = case_.scenario;
    if (given.contact.depth) return "the scenario names what depth does to the force";
    if (given.contact.coupling != contact::Coupling::consistent)
      return "the scenario names a coupling of contact and springs";
    for (const scenario::Step& step : given.steps)
      if (const auto* slide = std::get_if<scenario::Slide>(&step))
        if (slide->keep == scenario::Slide::Keep::force || given.contact.friction > 0.0)
          return "the finger slides with friction or at a force";
    if (given.solver.integrator || given.solver.rings || asks_for_steps(given.solver) ||
        given.solver.kinematics != scenario::Solver::Kinematics::linear)
      return "the scenario names a method of steps";
    if (given.output.tissue) return "`output.tissue` asks for displacements in time";
    return quick_ ? "it takes seconds a force" : "";
  }

  [[nodiscard]] std::string deep_answer(const Estimates& e) const {
    if (!e.depth_ratio) return "only a mesh with large strains knows by how much";
    return std::string("large strains ") + (e.deep < 0.0 ? "lower" : "raise") + " the force by " +
           percent_text(std::abs(e.deep)) + ", and a factor takes this into account";
  }

  [[nodiscard]] std::string viscous_answer() const {
    if (asked_.contact.viscosity == scenario::Contact::Viscosity::tissue)
      return "Lee and Radok's force while the contact grows, Ting's while it shrinks";
    return "neglected, because the scenario does not set `contact.viscosity`: the force is that of "
           "the relaxed tissue";
  }

  [[nodiscard]] std::string inertia_answer() const {
    if (moves()) return "a mesh includes it, a formula does not";
    return "neglected in the force of this scenario: `consistent` includes it with `viscosity` "
           "none, nodal_drag, or a solid that relaxes in the contact too; else use `resolved`";
  }

  void add(const ModelTraits& traits, double error, double of_mesh = 0.0) {
    const bool named = choice_.given && model_ == traits.of;
    if (!asked_.uniform()) {
      std::string cannot = beyond(traits.of, asked_, choice_.touch).value_or("");
      if (traits.solid && cannot.empty() && !named) cannot = no_solid();
      if (traits.of == Model::layer && cannot.empty() && !named)
        if (choice_.expected.chi > contact::last_layer_chi(scene::layers_of(asked_, 1.0)))
          cannot = "the contact is wider than its law is known for";
      if (!cannot.empty()) {
        choice_.forecasts.push_back({.model = traits.of, .cannot = cannot});
        return;
      }
    }
    // The time of a set-up by conjugate gradients.
    const double nodes = scene::expected_nodes(asked_.tissue.mesh);
    const double set_up = 5.5e-5 * nodes * std::max(1.0, std::cbrt(nodes / 8000.0));
    choice_.forecasts.push_back({.model = traits.of,
                                 .error = error,
                                 .of_mesh = of_mesh,
                                 .seconds = traits.cost.once +
                                            (asked_.regions.empty() ? 0.0 : traits.cost.layered) +
                                            traits.cost.set_ups * set_up});
  }

  void take_cheapest() {
    choice_.otherwise = *cheapest(choice_, true, tolerance());
    if (!choice_.given) model_ = choice_.otherwise.model;
  }

  static constexpr double far_sides = 4.0;      // thicknesses, of which exp(-1.2) leaves 0.8 %
  static constexpr double least_error = 0.001;  // of a formula, and of an even strain
  static constexpr double unknown = 1.0;        // the error where nothing is known

  const scenario::Case& case_;
  SpecimenShapes& shapes_;
  bool quick_;
  scenario::Resolved asked_;  // resolved with the most complete model, whatever the scenario names
  Model model_;               // the choice
  Choice choice_;
  double coarse_nodes_ = 0.0;  // of the mesh of size_effect()
};

}  // namespace

Choice choose(const scenario::Case& one) {
  SpecimenShapes shapes;
  return choose(one, shapes);
}

Choice choose(const scenario::Case& one, SpecimenShapes& shapes, Models models) {
  return Chooser(one, shapes, models).choose();
}

OneModel one_model(const scenario::Family& family, SpecimenShapes& shapes, int workers) {
  constexpr std::size_t most = 64;
  if (family.base.solver.model) return {};
  const std::size_t count = std::max(family.design.count(), family.cases.size());
  const std::size_t tries = std::min(count, most);
  std::vector<std::pair<std::size_t, Choice>> made(tries);
  share_out(tries, workers, [&](std::size_t t) {
    const std::size_t i = tries == 1 ? 0 : t * (count - 1) / (tries - 1);
    made[t] = {i, scenario::at_its_key(family.document, [&] {
                 return family.cases.empty() ? choose(scenario::make_case(family, i), shapes)
                                             : choose(family.cases[i], shapes);
               })};
  });
  Model dearest = Model::hertz;
  for (const auto& [i, choice] : made) {
    if (choice.given) return {};  // models are swept
    dearest = std::max(dearest, choice.chosen.solver.model);
  }
  return {dearest, {made.begin(), made.end()}};
}

}  // namespace palpate::run
