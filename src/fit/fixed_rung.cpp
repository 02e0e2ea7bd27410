// The ladder's questions, asked at the corners of a box.
#include "fit/fixed_rung.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "contact/deep.h"
#include "scene/scene.h"

namespace palpate::fit {
namespace {

using Model = scenario::Solver::Model;

// The corners of the box, and its middle first; of many unknowns the ends of each alone.
std::vector<std::vector<double>> places(std::size_t unknowns) {
  std::vector<std::vector<double>> all{std::vector<double>(unknowns, 0.5)};
  constexpr std::size_t most_for_corners = 5;
  if (unknowns > most_for_corners) {
    for (std::size_t i = 0; i < unknowns; ++i)
      for (const double end : {0.0, 1.0}) {
        all.push_back(all.front());
        all.back()[i] = end;
      }
    return all;
  }
  for (std::size_t corner = 0; corner < (std::size_t{1} << unknowns); ++corner) {
    all.emplace_back(unknowns);
    for (std::size_t i = 0; i < unknowns; ++i) all.back()[i] = (corner >> i & 1U) != 0 ? 1.0 : 0.0;
  }
  return all;
}

// Whether the number of a question reached its threshold anywhere.
bool reached(const std::vector<scene::Choice>& choices, const std::string& asked) {
  return std::any_of(choices.begin(), choices.end(), [&](const scene::Choice& choice) {
    return std::any_of(choice.questions.begin(), choice.questions.end(), [&](const auto& one) {
      return one.asked == asked && one.number >= one.threshold;
    });
  });
}

double error_of(const scene::Choice& choice, Model model) {
  for (const scene::Rung& rung : choice.rungs)
    if (rung.model == model)
      return rung.cannot.empty() ? rung.error : std::numeric_limits<double>::infinity();
  return std::numeric_limits<double>::infinity();
}

}  // namespace

FixedRung fix_rung(const scenario::Scenario& scenario, const Node& document,
                   std::span<const Unknown> unknowns) {
  std::vector<scene::Choice> choices;
  std::vector<Problem> wrong;
  // The flow of a specimen is what a creep test is made for: its waves are left out, and
  // inertia_of_flow() says afterwards whether that was right.
  const bool still_flow = scenario.uniform() &&
                          scenario.tissue.viscosity != tissue::Viscosity::nodal_drag &&
                          scenario.tissue.viscosity != tissue::Viscosity::none;
  bool deep_known = true;  // the factor of deep presses, for every Poisson's ratio of the box
  for (const std::vector<double>& u : places(unknowns.size())) {
    scenario::Scenario at = scenario;
    std::vector<double> values;
    for (std::size_t i = 0; i < u.size(); ++i) values.push_back(unknowns[i].value(u[i]));
    set_unknowns(at, unknowns, values);
    std::vector<Problem> problems;
    scenario::check(at, document, problems);
    deep_known = deep_known && contact::deep_law(*at.tissue.poisson_ratio).has_value();
    if (problems.empty())
      choices.push_back(scene::choose(at));
    else if (wrong.empty())
      wrong = problems;
  }
  if (choices.empty()) throw InputError(wrong);

  FixedRung fixed;
  fixed.given = choices.front().given;
  fixed.scenario = scenario;
  scenario::Scenario& with = fixed.scenario;
  const scenario::Scenario& chosen = choices.front().chosen;
  if (chosen.solver.model == Model::hertz && choices.front().rungs.empty() && !fixed.given) {
    with.solver.model = Model::hertz;  // `one_way`: no other rung says more
  } else if (!fixed.given) {
    double best = std::numeric_limits<double>::infinity();
    for (const scene::Rung& rung : choices.front().rungs) {  // cheapest first
      double worst = 0.0;
      for (const scene::Choice& choice : choices)
        worst = std::max(worst, error_of(choice, rung.model));
      if (worst >= best) continue;
      best = worst;
      with.solver.model = rung.model;
      if (worst <= scenario.solver.tolerance) break;
    }
  }
  for (const scene::Choice& choice : choices)
    if (!choice.rungs.empty())
      fixed.worst_error = std::max(fixed.worst_error, error_of(choice, with.solver.model));

  // The other keys that were left to `auto`, as the chooser completes them for one case.
  const bool free = !fixed.given && !scenario.uniform() && !choices.front().questions.empty();
  const bool closed_form = with.solver.model == Model::hertz || with.solver.model == Model::layer;
  if (free && !reached(choices, "time dependent?"))
    with.contact.viscosity = scenario::Contact::Viscosity::none;
  if (with.contact.depth == scenario::Contact::Depth::automatic)
    with.contact.depth =
        free && with.solver.model == Model::hertz && deep_known && reached(choices, "deep?")
            ? scenario::Contact::Depth::neo_hookean
            : scenario::Contact::Depth::hertz;
  if (with.solver.integrator == scenario::Solver::Integrator::automatic) {
    const bool drag = with.tissue.viscosity == tissue::Viscosity::nodal_drag;
    const bool still = with.contact.coupling == contact::Coupling::resolved ||
                       (!fixed.given && still_flow) ||
                       (free && !reached(choices, "inertia?") && !drag);
    with.solver.integrator = still && !closed_form
                                 ? scenario::Solver::Integrator::quasi_static
                                 : scenario::Solver::Integrator::central_difference;
  }
  return fixed;
}

// 1 / (w_1 tau)^2, w_1 = pi c / (2 L)                                          PHYSICS.md 1.3 (5)
std::optional<double> inertia_of_flow(const scenario::Scenario& scenario) {
  const scenario::Tissue& tissue = scenario.tissue;
  const auto* box = std::get_if<scenario::Cuboid>(&tissue.shape);
  const auto& time = tissue.viscosity == tissue::Viscosity::kelvin_voigt ? tissue.retardation_time
                                                                         : tissue.relaxation_time;
  if (box == nullptr || !time || !scenario.uniform()) return std::nullopt;
  const double speed = std::sqrt(*tissue.young_modulus / *tissue.density);
  const double turns = std::numbers::pi * speed / (2.0 * box->size[2]) * *time;
  return 1.0 / (turns * turns);
}

std::optional<double> predicted_error(const scenario::Scenario& fixed) {
  const scene::Choice choice = scene::choose(fixed);
  const scene::Rung* rung = choice.taken();
  return rung == nullptr ? std::nullopt : std::optional(rung->error);
}

}  // namespace palpate::fit
