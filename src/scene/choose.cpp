// Evaluates the questions in order, and chooses the cheapest model within the tolerance.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "scenario/integrators.h"
#include "scene/estimates.h"
#include "scene/refining_press.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"
#include "scene/time_plan.h"

namespace palpate::scene {
namespace {

using scenario::Model;
using scenario::Rung;
using Integrator = scenario::Solver::Integrator;

// The texts of a question, with its answers below and above the threshold; answers that contain
// numbers are made where the question is evaluated.
struct QuestionRow {
  const char* word;  // the name of the enumerator
  const char* text;
  const char* measure;
  const char* below;
  const char* above;
};
constexpr auto question_table = std::to_array<QuestionRow>({
    {"uniform", "a uniform test?", "steps that load the end faces", "",
     "yes: only a specimen can creep or relax"},
    {"ratio_matters", "does nu matter?", "ends slide on their platens",
     "no: springs have the right Young's modulus",
     "yes: springs have a Poisson's ratio of their own"},
    {"force_knows_mesh", "does the mesh affect the force?", "coupling is one_way",
     "no: the force is eq. (2) alone, as with hertz", ""},
    {"rigid_tissue", "rigid tissue?", "lambda_2 / (lambda_1 + lambda_2)",
     "yes: only the finger deforms", "no: the tissue deforms"},
    {"half_space", "half-space?", "change of the force by thickness and sides",
     "yes: the specimen's size does not matter", ""},
    {"layer", "layer?", "decrease of the force by the sides",
     "yes: flat tissue of known thickness, exactly known", ""},
    {"deep", "deep?", "change of the force in neo-Hookean tissue", "no: linear elasticity holds",
     ""},
    {"curved", "curved?", "(1/R + kappa_1) / (1/R + kappa_2) - 1", "no: one curvature is enough",
     "yes: both curvatures matter, the contact is elliptic"},
    {"time_dependent", "time dependent?", "increase of the force by viscosity",
     "no: the press is slow against the tissue's time constant", ""},
    {"inertia", "inertia?", "increase of the force by waves",
     "no: the loading is slow against them", ""},
    {"shape_or_inclusion", "shape or inclusion?", "reasons for a mesh",
     "no: there is a formula for this shape", ""},
});
static_assert(is_complete<Asked>(question_table), "every question has its text");

// A narrow body reduces the force by this times a / (w/2): measured on cylinders and an ellipsoid.
constexpr double width_of_body = 0.5;

constexpr double doubt = 0.4;  // relative uncertainty of the effect of the sides, which is a fit

// The error of cells that are coarse compared with the thickness, 0.15 (cell / thickness)^2:
// measured on discs of 5 and 10 mm and on thin blocks. Flat layers have an exact law. Where the
// mesh is refined, at most what refining leaves.
//                                                                        docs/theory.md (69)
double coarseness(const scenario::Resolved& scenario, const SurfaceTouch& touch) {
  const bool box = std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape);
  const Vec3& size = touch.size;
  if (!size.allFinite() || (box && !scenario.regions.empty() && all_slabs(scenario))) return 0.0;
  const double cell = std::cbrt(size.prod() / expected_nodes(scenario.tissue.mesh));
  double thickness = size.z();
  if (const auto* limb = std::get_if<scenario::LayeredLimb>(&scenario.tissue.shape))
    thickness = limb->skin_thickness;
  const double ratio = std::min(1.0, cell / thickness);
  const double error = 0.15 * ratio * ratio;
  return refines(scenario) ? std::min(error, refined_share * scenario.solver.tolerance) : error;
}

bool coarse_mesh(const Choice& choice) {
  return choice.chosen.meshed() && !refines(choice.chosen) &&
         coarseness(choice.chosen, choice.touch) > 0.0;
}

class Chooser {
 public:
  Chooser(const scenario::Case& one, SpecimenShapes& shapes)
      : case_(one),
        asked_(scenario::resolve(one, scenario::strongest.of)),
        model_(one.scenario.solver.model.value_or(asked_.solver.model)) {
    if (!asked_.uniform()) choice_.touch = surface_touch(asked_, one.folder, shapes);
  }

  Choice choose() {
    choice_.given = case_.scenario.solver.model.has_value();
    if (asked_.uniform())
      uniform();
    else
      pressed();
    if (choice_.given) choice_.found = {};
    choice_.chosen = scenario::resolve(case_, model_, choice_.found);
    return choice_;
  }

 private:
  // Adds a question. `above` and `measure` replace the texts of the table unless they are empty.
  void ask(Asked of, double number, double threshold, const std::string& above = "",
           const std::string& measure = "") {
    const QuestionRow& row = question_table[as_index(of)];
    choice_.questions.push_back({row.text, measure.empty() ? row.measure : measure, number,
                                 threshold,
                                 number < threshold ? row.below
                                 : above.empty()    ? row.above
                                                    : above});
  }

  [[nodiscard]] double tolerance() const { return asked_.solver.tolerance; }

  // Questions for a test of a specimen between platens.
  void uniform() {
    const double nu = asked_.tissue.poisson_ratio;
    const bool bonded = asked_.tissue.base == tissue::Base::bonded;
    const auto& shape = asked_.tissue.shape;
    const bool prism = std::holds_alternative<scenario::Cuboid>(shape) ||
                       std::holds_alternative<scenario::Cylinder>(shape);
    // With a bonded end or several tissues the strain is uneven and nu matters; springs have 1/4.
    // Independent springs get the stiffness of a prism whatever the shape: measured on the
    // ligament (22 %) and the leg (40 %).
    const bool uneven = bonded || !asked_.regions.empty() || !prism;
    constexpr double even_error = 0.001;
    constexpr double shape_error = 0.4;
    const double ratio_error = !prism   ? shape_error
                               : uneven ? 0.5 * std::abs(nu - 0.25)
                                        : even_error;
    ask(Asked::uniform, 1.0, 0.5);
    ask(Asked::ratio_matters, ratio_error, tolerance(), "",
        !prism   ? "independent springs on a shape that is no prism"
        : uneven ? "|nu - 1/4| / 2, ends held or tissues mixed"
                 : "");
    const double inertia = uniform_inertia(asked_);
    ask(Asked::inertia, inertia, tolerance(), "yes: the specimen rings",
        "change of the strain by waves");
    choice_.found.inertia_matters = inertia >= tolerance();
    const auto& integrator = case_.scenario.solver.integrator;
    const double left_out = integrator && !about(*integrator).inertia ? inertia : 0.0;
    for (const Rung& rung : scenario::ladder)
      if (rung.uniform)
        add(rung, left_out + (rung.own_ratio ? even_error + (uneven ? rung.error.uneven : 0.0)
                                             : ratio_error));
    take_cheapest();
  }

  void pressed() {
    const Estimates e = estimate(asked_, choice_.touch);
    choice_.depth_ratio = e.depth_ratio;
    const double limit = tolerance();
    // The reason why no formula is applicable, if none is.
    std::optional<std::string> reason = beyond(Model::hertz, asked_, choice_.touch);
    const bool box = std::holds_alternative<scenario::Cuboid>(asked_.tissue.shape);
    if (asked_.contact.coupling == contact::Coupling::one_way && !reason) {
      ask(Asked::force_knows_mesh, 0.0, 1.0);
      if (!choice_.given) model_ = Model::hertz;
      return;
    }
    for (const Rung& rung : scenario::ladder)
      if (!rung.meshed() && !beyond(rung.of, asked_, choice_.touch)) reason.reset();
    ask(Asked::rigid_tissue, e.tissue_share, std::min(limit, 0.02));
    // A narrow curved body reduces the force as free sides do, while the thickness increases it.
    narrow_ = std::min(0.99, e.sides + width_of_body * e.curved_body);
    const double size = std::abs(change_by_size(e));
    ask(Asked::half_space, size, limit,
        "no: the thickness adds " + percent_text(e.thickness) +
            (box ? ", the sides take " + percent_text(e.sides)
                 : ", the body's width changes up to " + percent_text(e.curved_body)));
    ask(Asked::layer, box ? e.sides : 1.0, limit,
        box ? "no: the sides matter" : "no: the tissue is not flat");
    // A fifth of the tolerance, because depth that is left out adds to the model's error.
    ask(Asked::deep, std::abs(e.deep), 0.2 * limit, deep_answer(e));
    ask(Asked::curved, e.curvature_ratio - 1.0, 0.1);
    // A fifth of the tolerance, because viscosity that is left out adds to the model's error.
    ask(Asked::time_dependent, e.viscous, 0.2 * limit, viscous_answer());
    ask(Asked::inertia, e.inertia, limit, inertia_answer());
    ask(Asked::shape_or_inclusion, reason ? 1.0 : 0.0, 1.0, reason ? "yes: " + *reason : "");

    choice_.found = {.viscosity_matters = e.viscous >= 0.2 * limit,
                     .inertia_matters = e.inertia >= limit,
                     .depth_matters = std::abs(e.deep) >= 0.2 * limit && has_depth_ratio()};
    for (const Rung& rung : scenario::ladder) add(rung, error_of(rung, e), error_of_mesh(rung, e));
    take_cheapest();
  }

  // The error of a model in a press, as a fraction of the force.                docs/theory.md (69)
  [[nodiscard]] double error_of(const Rung& rung, const Estimates& e) const {
    const scenario::Found& found = choice_.found;
    const double still = found.inertia_matters ? e.inertia : 0.0;
    switch (rung.of) {
      case Model::hertz:
        return std::abs(1.0 / (1.0 + change_by_size(e)) - 1.0) + doubt * narrow_ + still +
               depth_error(e);
      case Model::layer:
        return 1.0 / (1.0 - std::min(e.sides, 0.99)) - 1.0 + doubt * e.sides + still +
               depth_error(e);
      case Model::mass_spring:
      case Model::coupled_springs: break;
      case Model::neo_hookean: return error_of_mesh(rung, e) + still;
    }
    const double waves =
        found.inertia_matters ? (moves() ? rung.error.waves : 1.0) * e.inertia : 0.0;
    return waves + depth_error(e) + error_of_mesh(rung, e);
  }

  // What the mesh of a rung costs; 0 without one.
  [[nodiscard]] double error_of_mesh(const Rung& rung, const Estimates& e) const {
    if (!rung.meshed()) return 0.0;
    const bool box = std::holds_alternative<scenario::Cuboid>(asked_.tissue.shape);
    if (rung.solid)
      return rung.error.flat + coarseness_of_solid() + (box ? 0.0 : rung.error.curved);
    return coarseness(asked_, choice_.touch) + rung.error.flat + rung.error.sides * e.sides +
           (box ? 0.0 : rung.error.curved + rung.error.size * e.curved_body) +
           (all_slabs(asked_) ? 0.0 : rung.error.mixed);
  }

  // What cells cost nearly incompressible tetrahedra: measured on a block of 60 x 60 x 30 mm,
  // pressed by 8 mm, on 726 to 3179 nodes, with nu from 0.33 to 0.49.
  [[nodiscard]] double coarseness_of_solid() const {
    const Vec3& size = choice_.touch.size;
    const double cell = std::cbrt(size.prod() / expected_nodes(asked_.tissue.mesh));
    const double ratio = std::min(1.0, cell / size.z());
    return 30.0 * ratio * ratio * std::max(0.0, asked_.tissue.poisson_ratio - 0.4);
  }

  // Whether the rungs of this scenario can use the factor of a deep press.
  [[nodiscard]] bool has_depth_ratio() const {
    return choice_.depth_ratio && !contact::mesh_is_tissue(asked_.contact.coupling);
  }

  // What the depth leaves open: the error of its factor, or the effect that is left out. At least
  // 0.1 %, for a contact that is never quite as small as a contact law assumes.
  [[nodiscard]] double depth_error(const Estimates& e) const {
    constexpr double least = 1e-3;
    const bool found = !choice_.given && choice_.found.depth_matters;
    const auto depth = case_.scenario.contact.depth.value_or(
        found ? scenario::Contact::Depth::neo_hookean : scenario::Contact::Depth::hertz);
    const bool used = depth == scenario::Contact::Depth::neo_hookean && has_depth_ratio();
    return std::max(least, used ? e.deep_error : std::abs(e.deep) + e.deep_error);
  }

  [[nodiscard]] std::string deep_answer(const Estimates& e) const {
    const std::string change = "finite strain " + std::string(e.deep < 0.0 ? "lowers" : "raises") +
                               " the force by " + percent_text(std::abs(e.deep));
    if (!choice_.depth_ratio)
      return "yes: near this place " + change + ", but its factor is not known here";
    return "yes: " + change + ", and a factor takes this into account";
  }

  // The change of the half-space's force by the size of the body. A narrow base lets a curved body
  // yield as a whole; files and ligaments may stand on all of their underside, where the thickness
  // acts alone.
  [[nodiscard]] double change_by_size(const Estimates& e) const {
    const auto& shape = asked_.tissue.shape;
    const bool wide_base = std::holds_alternative<scenario::SurfaceFile>(shape) ||
                           std::holds_alternative<scenario::AsMeshed>(shape) ||
                           std::holds_alternative<scenario::Ligament>(shape);
    const double both = (1.0 + e.thickness) * (1.0 - narrow_) - 1.0;
    return wide_base && e.thickness > std::abs(both) ? e.thickness : both;
  }

  // Whether the tissue's inertia affects the force on a mesh.
  [[nodiscard]] bool moves() const { return inertia_reaches_force(asked_); }

  [[nodiscard]] std::string viscous_answer() const {
    if (asked_.contact.viscosity == scenario::Contact::Viscosity::tissue)
      return "yes: Lee and Radok's force while the contact grows, Ting's while it shrinks";
    return "yes, but the scenario leaves it out of the contact (`contact.viscosity`): the force is "
           "that of the relaxed tissue";
  }

  [[nodiscard]] std::string inertia_answer() const {
    if (moves()) return "yes: the mesh has the mass of the tissue";
    return "yes, but the force of this scenario leaves it out: `consistent` includes it with "
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
    // The times of a set-up by conjugate gradients and of a sparse Cholesky factorisation.
    const double nodes = expected_nodes(asked_.tissue.mesh);
    const double set_up = 5.5e-5 * nodes * std::max(1.0, std::cbrt(nodes / 8000.0));
    const double factorisation = 0.4 * std::pow(nodes / 2200.0, 2.27) + 1e-4 * nodes;
    choice_.rungs.push_back(
        {.model = rung.of,
         .error = error,
         .of_mesh = of_mesh,
         .seconds = rung.cost.once + (asked_.regions.empty() ? 0.0 : rung.cost.layered) +
                    rung.cost.set_ups * set_up + rung.cost.factorisations * factorisation});
  }

  void take_cheapest() {
    if (choice_.given) return;
    const Forecast* best = nullptr;
    for (const Forecast& rung : choice_.rungs) {
      if (!rung.cannot.empty()) continue;
      // The force of a press is that of finite elements on either kind of springs, but motion and
      // pictures of independent springs do not have the tissue's Poisson's ratio.
      if (!asked_.uniform() && scenario::rung(rung.model).independent()) continue;
      if (best == nullptr || rung.error < best->error) best = &rung;
      if (rung.error > tolerance()) continue;
      best = &rung;
      break;
    }
    model_ = best->model;
  }

  const scenario::Case& case_;
  scenario::Resolved asked_;  // resolved with the most complete model, whatever the scenario names
  Model model_;               // the choice
  Choice choice_;
  double narrow_ = 0.0;  // reduction of the force by sides, or by the width of a curved body
};

}  // namespace

const Forecast* Choice::forecast(Model model) const {
  for (const Forecast& rung : rungs)
    if (rung.model == model && rung.cannot.empty()) return &rung;
  return nullptr;
}

std::string Choice::shortfall() const {
  const Forecast* rung = taken();
  if (given || rung == nullptr || !(rung->error > chosen.solver.tolerance)) return "";
  return "no rung is predicted to be within the tolerance of " +
         percent_text(chosen.solver.tolerance) + ": `" + scenario::rung(rung->model).word +
         "` comes nearest with about " + percent_text(rung->error) +
         (coarse_mesh(*this) ? "; a finer `tissue.mesh` may help" : "");
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
  if (choice.chosen.uniform()) return choice;
  choice.touch = surface_touch(choice.chosen, one.folder, shapes);
  if (choice.chosen.contact.depth == scenario::Contact::Depth::neo_hookean)
    choice.depth_ratio = estimate(choice.chosen, choice.touch).depth_ratio;
  return choice;
}

}  // namespace palpate::scene
