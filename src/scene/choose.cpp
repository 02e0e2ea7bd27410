// The questions of the ladder, in order, and the cheapest rung that their answers leave.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "scenario/words.h"
#include "scene/estimates.h"
#include "scene/scene.h"
#include "scene/specimen_mesh.h"
#include "scene/time_plan.h"

namespace palpate::scene {
namespace {

using Model = scenario::Solver::Model;
using Integrator = scenario::Solver::Integrator;

constexpr double infinite = std::numeric_limits<double>::infinity();

// A rung's own error on a mesh, measured against converged elasticity: docs/accuracy.md.
struct MeshError {
  double flat;    // of the force on a flat cuboid
  double sides;   // part of the sides' effect that it misses
  double curved;  // of the force on a curved body, besides
  double size;    // part of such a body's effect that it misses
  double waves;   // part of what inertia adds that it misses
};
constexpr MeshError mass_spring_error{
    .flat = 0.02, .sides = 0.3, .curved = 0.03, .size = 0.3, .waves = 0.15};
constexpr MeshError coupled_error{
    .flat = 0.02, .sides = 0.1, .curved = 0.03, .size = 0.1, .waves = 0.06};

// Of a / (w/2), what a narrow body takes of the force: measured on cylinders and an ellipsoid.
constexpr double width_of_body = 0.5;

constexpr double doubt = 0.4;  // of the sides' effect, which is a fit

// What cells of a curved body cost that see its thickness only coarsely: 0.4 (cell / thickness)^2,
// measured on the ligament's strap from 300 to 2400 nodes.
double coarseness(const scenario::Scenario& scenario) {
  const auto shape = parametric(scenario.tissue.shape);
  if (!shape || std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape)) return 0.0;
  const Vec3 size = geometry::extent(*shape);
  const double cell = std::cbrt(size.prod() / expected_nodes(scenario));
  double thickness = size.z();
  if (const auto* limb = std::get_if<scenario::LayeredLimb>(&scenario.tissue.shape))
    thickness = limb->skin_thickness;
  const double ratio = std::min(1.0, cell / thickness);
  return 0.4 * ratio * ratio;
}

bool coarse_mesh(const scenario::Scenario& scenario) {
  return scenario.meshed() && coarseness(scenario) > 0.0;
}

class Chooser {
 public:
  explicit Chooser(const scenario::Scenario& scenario) : asked_(scenario) {
    choice_.chosen = scenario;
  }

  Choice choose() {
    choice_.given = asked_.solver.model != Model::automatic;
    if (asked_.uniform())
      uniform();
    else
      pressed();
    complete();
    return choice_;
  }

 private:
  void ask(const char* asked, const char* measure, double number, double threshold,
           const std::string& below, const std::string& above) {
    choice_.questions.push_back(
        {asked, measure, number, threshold, number < threshold ? below : above});
  }

  [[nodiscard]] double tolerance() const { return asked_.solver.tolerance; }

  // Strain or stress of a specimen between platens.
  void uniform() {
    const double nu = *asked_.tissue.poisson_ratio;
    const bool bonded = base_of(asked_) == tissue::Base::bonded;
    const bool several = !asked_.regions.empty();
    // A bonded end, or a second tissue, makes the strain uneven, and nu matters: springs have 1/4.
    const double error = bonded || several ? 0.5 * std::abs(nu - 0.25) : 0.001;
    ask("a uniform test?", "steps that load the end faces", 1.0, 0.5, "",
        "yes: only a specimen can creep or relax");
    ask("does nu matter?",
        bonded || several ? "|nu - 1/4| / 2, ends held or tissues mixed"
                          : "ends slide on their platens",
        error, tolerance(), "no: springs have the right Young's modulus",
        "yes: springs have a Poisson's ratio of their own");
    add_mesh(Model::mass_spring, error);
    add_mesh(Model::coupled_springs, 0.001 + (bonded || several ? 0.02 : 0.0));
    take_cheapest();
  }

  void pressed() {
    const Estimates e = estimate(asked_);
    const double limit = tolerance();
    const auto percent = [](double part) { return rounded_text(100.0 * part, 2) + " %"; };
    const auto beyond = beyond_hertz(asked_);
    const auto beyond_flat = beyond_layer(asked_);
    const bool endless = std::holds_alternative<scenario::HalfSpace>(asked_.tissue.shape);
    const bool box = std::holds_alternative<scenario::Cuboid>(asked_.tissue.shape);
    if (asked_.contact.coupling == contact::Coupling::one_way && !beyond) {
      choice_.questions.push_back({"does the force know the mesh?", "coupling is one_way", 0, 1,
                                   "no: it is eq. (2) alone, hertz says the same"});
      if (!choice_.given) choice_.chosen.solver.model = Model::hertz;
      return;
    }
    ask("rigid tissue?", "lambda_2 / (lambda_1 + lambda_2)", e.tissue_share, std::min(limit, 0.02),
        "yes: only the finger deforms", "no: the tissue deforms");
    // A curved body that is narrow gives way as free sides do, against the thickness.
    const double narrow = std::min(0.99, e.sides + width_of_body * e.curved_body);
    const double size = std::abs((1.0 + e.thickness) * (1.0 - narrow) - 1.0);
    ask("half-space?", "what thickness and sides change of the force", size, limit,
        "yes: the specimen's size does not matter",
        "no: the thickness adds " + percent(e.thickness) +
            (box ? ", the sides take " + percent(e.sides)
                 : ", the body's width changes up to " + percent(e.curved_body)));
    ask("layer?", "what the sides take of the force", box ? e.sides : 1.0, limit,
        "yes: flat tissue of known thickness, exactly known",
        box ? "no: the sides matter" : "no: the tissue is not flat");
    ask("deep?", "|F / F_Hertz - 1| of neo-Hookean tissue", e.deep, limit, "no: h^(3/2) holds",
        "yes: times the factor of a deep press on `hertz`");
    ask("curved?", "(1/R + kappa_1) / (1/R + kappa_2) - 1", e.curvature_ratio - 1.0, 0.1,
        "no: one curvature says it all", "yes: both curvatures count, an elliptic contact");
    // A fifth of the tolerance: what is left out here adds to what a rung leaves out.
    ask("time dependent?", "what viscosity adds to the force", e.viscous, 0.2 * limit,
        "no: slow against the tissue's own time", viscous_answer());
    ask("inertia?", "what waves add to the force", e.inertia, limit,
        "no: the press is slow against them", inertia_answer());
    ask("shape or inclusion?", "reasons that only a mesh knows", beyond && beyond_flat ? 1.0 : 0.0,
        1.0, "no: a formula knows this shape", beyond ? "yes: " + *beyond : "");

    drop_viscosity_ = e.viscous < 0.2 * limit;
    quasi_static_ = e.inertia < limit;
    deepen_ = e.deep >= limit;
    const double still = quasi_static_ ? 0.0 : e.inertia;
    const double deep = deepen_ ? contact::DeepLaw::error : e.deep;
    add({.model = Model::hertz,
         .error = std::abs(1.0 / ((1.0 + e.thickness) * (1.0 - narrow)) - 1.0) + doubt * narrow +
                  still + deep,
         .seconds = 1e-6,
         .cannot = beyond.value_or("")});
    add({.model = Model::layer,
         .error = 1.0 / (1.0 - std::min(e.sides, 0.99)) - 1.0 + doubt * e.sides + still,
         .seconds = asked_.regions.empty() ? 0.02 : 0.5,
         .cannot = beyond_flat.value_or("")});
    if (endless) {
      for (const Model model : {Model::mass_spring, Model::coupled_springs})
        add({.model = model, .cannot = "a `half_space` has no end to be meshed to"});
    } else {
      scenario::Scenario moving = asked_;
      moving.solver.model = Model::coupled_springs;
      const bool moves = inertia_reaches_force(moving);
      const auto error = [&](const MeshError& of) {
        const double waves = quasi_static_ ? 0.0 : (moves ? of.waves : 1.0) * e.inertia;
        return waves + coarseness(asked_) + of.flat + of.sides * e.sides +
               (box ? 0.0 : of.curved + of.size * e.curved_body);
      };
      // A network's own nu blurs what another tissue changes.
      const double mixed = all_slabs(asked_) ? 0.0 : 0.05;
      add_mesh(Model::mass_spring, error(mass_spring_error) + mixed);
      add_mesh(Model::coupled_springs, error(coupled_error) + (mixed > 0.0 ? 0.03 : 0.0));
    }
    take_cheapest();
  }

  [[nodiscard]] std::string viscous_answer() const {
    if (asked_.contact.viscosity == scenario::Contact::Viscosity::tissue)
      return "yes: Lee and Radok's force while it grows, Ting's while it shrinks";
    return "yes, but the scenario leaves it out of the contact (`contact.viscosity`): the force is "
           "that of the relaxed tissue";
  }

  [[nodiscard]] std::string inertia_answer() const {
    scenario::Scenario moving = asked_;
    moving.solver.model = Model::coupled_springs;
    if (inertia_reaches_force(moving))
      return "yes: the tissue's mass takes part, on a mesh that moves";
    return "yes, but not in the force of this scenario: `consistent` knows it with `viscosity` "
           "none, "
           "nodal_drag, or a solid that relaxes in the contact too; else take `resolved`";
  }

  void add(Rung rung) { choice_.rungs.push_back(std::move(rung)); }

  // Seconds of a sparse Cholesky of so many nodes; coupled springs carry a pressure a node besides.
  void add_mesh(Model model, double error) {
    const double nodes = expected_nodes(asked_);
    const double once = 0.4 * std::pow(nodes / 2200.0, 2.27) + 1e-4 * nodes;
    add({.model = model,
         .error = error,
         .seconds = model == Model::coupled_springs ? 2.8 * once : once});
  }

  void take_cheapest() {
    if (choice_.given) return;
    const Rung* best = nullptr;
    for (const Rung& rung : choice_.rungs) {
      if (!rung.cannot.empty()) continue;
      if (best == nullptr || rung.error < best->error) best = &rung;
      if (rung.error > tolerance()) continue;
      best = &rung;
      break;
    }
    choice_.chosen.solver.model = best->model;
  }

  // The other keys that were left to `auto`.
  void complete() {
    scenario::Scenario& chosen = choice_.chosen;
    const bool free = !choice_.given;
    const bool closed_form =
        chosen.solver.model == Model::hertz || chosen.solver.model == Model::layer;
    if (chosen.contact.depth == scenario::Contact::Depth::automatic)
      chosen.contact.depth = free && deepen_ && chosen.solver.model == Model::hertz
                                 ? scenario::Contact::Depth::neo_hookean
                                 : scenario::Contact::Depth::hertz;
    if (free && drop_viscosity_) chosen.contact.viscosity = scenario::Contact::Viscosity::none;
    if (chosen.solver.integrator == Integrator::automatic) {
      const bool drag = chosen.tissue.viscosity == tissue::Viscosity::nodal_drag;
      const bool still = chosen.contact.coupling == contact::Coupling::resolved ||
                         (free && quasi_static_ && !drag);
      chosen.solver.integrator =
          still && !closed_form ? Integrator::quasi_static : Integrator::central_difference;
    }
    if (chosen.solver.volume == scenario::Solver::Volume::automatic)
      chosen.solver.volume = chosen.solver.model == Model::coupled_springs
                                 ? scenario::Solver::Volume::nodal
                                 : scenario::Solver::Volume::none;
  }

  const scenario::Scenario& asked_;
  Choice choice_;
  bool drop_viscosity_ = false;
  bool quasi_static_ = false;
  bool deepen_ = false;
};

}  // namespace

const Rung* Choice::taken() const {
  for (const Rung& rung : rungs)
    if (rung.model == chosen.solver.model && rung.cannot.empty()) return &rung;
  return nullptr;
}

std::string Choice::shortfall() const {
  const Rung* rung = taken();
  if (given || rung == nullptr || !(rung->error > chosen.solver.tolerance)) return "";
  return "no rung is predicted to be within the tolerance of " +
         rounded_text(100.0 * chosen.solver.tolerance, 2) + " %: `" +
         scenario::words::word(scenario::words::models, rung->model) +
         "` comes nearest with about " + rounded_text(100.0 * rung->error, 2) + " %" +
         (coarse_mesh(chosen) ? "; a finer `tissue.mesh` may help" : "");
}

Choice choose(const scenario::Scenario& scenario) { return Chooser(scenario).choose(); }

}  // namespace palpate::scene
