// Chooses the model by its estimated errors at the corners of the box.
#include "identify/fixed_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "run/choose.h"
#include "scene/specimen_shape.h"

namespace palpate::identify {
namespace {

// The middle of the box, then its corners; for more than 5 unknowns the ends of each one alone.
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

double error_of(const scene::Choice& choice, scenario::Model model) {
  const scene::Forecast* forecast = choice.forecast(model);
  return forecast != nullptr ? forecast->error : std::numeric_limits<double>::infinity();
}

scene::Choice quick_choice(const scenario::Case& one) {
  scene::SpecimenShapes shapes;
  return run::choose(one, shapes, run::Models::quick);
}

}  // namespace

scenario::Case FixedModel::at(std::span<const Unknown> unknowns,
                              std::span<const double> values) const {
  scenario::Case other = one;
  set_unknowns(other.scenario, unknowns, values);
  return other;
}

FixedModel fix_model(const scenario::Case& one, const Node& document,
                     std::span<const Unknown> unknowns) {
  const scenario::Scenario& scenario = one.scenario;
  FixedModel fixed{.one = one};
  std::vector<scene::Choice> choices;
  scene::SpecimenShapes shapes;
  std::vector<Problem> wrong;
  bool deep_known = true;  // the factor of deep presses exists for all values tried
  for (const std::vector<double>& u : places(unknowns.size())) {
    std::vector<double> values;
    for (std::size_t i = 0; i < u.size(); ++i) values.push_back(unknowns[i].value(u[i]));
    const scenario::Case at = fixed.at(unknowns, values);
    std::vector<Problem> problems;
    scenario::check(at, document, problems);
    if (problems.empty()) {
      choices.push_back(run::choose(at, shapes, run::Models::quick));
      deep_known = deep_known && choices.back().expected.depth_ratio.has_value();
    } else if (wrong.empty()) {
      wrong = problems;
    }
  }
  if (choices.empty()) throw InputError(wrong);

  scenario::Found found{.viscosity_matters = false, .inertia_matters = false};
  fixed.given = choices.front().given;
  fixed.model = choices.front().chosen.solver.model;
  double best = std::numeric_limits<double>::infinity();
  for (const scene::Forecast& forecast : choices.front().forecasts) {  // cheapest first
    if (fixed.given || best <= scenario.solver.tolerance) break;
    double worst = 0.0;
    for (const scene::Choice& choice : choices)
      worst = std::max(worst, error_of(choice, forecast.model) - choice.waves);
    if (worst >= best) continue;
    best = worst;
    fixed.model = forecast.model;
  }
  for (const scene::Choice& choice : choices) {
    if (!choice.forecasts.empty())
      fixed.worst_error = std::max(fixed.worst_error, error_of(choice, fixed.model));
    found.viscosity_matters |= choice.found.viscosity_matters;
    found.inertia_matters |= choice.found.inertia_matters;
    found.depth_matters |= choice.found.depth_matters;
  }
  found.depth_matters = found.depth_matters && deep_known;
  fixed.one.scenario = scenario::answered(one, scenario::resolve(one, fixed.model, found));
  return fixed;
}

// 1 / (omega_1 tau)^2, omega_1 = pi sqrt(E / rho) / (2 H)                docs/theory.md [damping]
std::optional<double> inertia_of_flow(const scenario::Resolved& scenario) {
  const scenario::Resolved::Tissue& tissue = scenario.tissue;
  const auto* box = std::get_if<scenario::Cuboid>(&tissue.shape);
  const bool voigt = tissue.viscosity == tissue::Viscosity::kelvin_voigt;
  const bool solid = tissue.viscosity == tissue::Viscosity::standard_linear_solid;
  if (box == nullptr || (!voigt && !solid) || !scenario.uniform()) return std::nullopt;
  const double time = voigt ? tissue.law.time : tissue.law.longest_time();
  const double speed = std::sqrt(tissue.young_modulus / tissue.density);
  const double turns = std::numbers::pi * speed / (2.0 * box->size[2]) * time;
  return 1.0 / (turns * turns);
}

std::optional<double> predicted_error(const scenario::Case& fixed) {
  const scene::Choice choice = quick_choice(fixed);
  const scene::Forecast* forecast = choice.taken();
  return forecast == nullptr ? std::nullopt : std::optional(forecast->error);
}

std::optional<double> deep_effect(const scenario::Case& fixed) {
  const scene::Choice choice = quick_choice(fixed);
  if (choice.chosen.contact.depth != scenario::Contact::Depth::neo_hookean) return std::nullopt;
  return choice.expected.deep;
}

}  // namespace palpate::identify
