// Sentences on why the estimates may be wrong.
#include "identify/warnings.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/text.h"
#include "fit/residual_tests.h"
#include "identify/fixed_model.h"
#include "scenario/integrators.h"

namespace palpate::identify {

std::vector<std::string> warnings_of(const Identification& found,
                                     const WeightedResiduals& residuals,
                                     const scenario::Resolved& with) {
  std::vector<std::string> warnings;
  // Systematic residuals below a thousandth of the curve come from interpolation.
  const bool few = found.rho > 0.0 && found.effective_size < 10.0;
  if ((fit::systematic(residuals.values) || few) && residuals.noise > 1e-3)
    warnings.push_back(fit::correlation_sentence(
        found.durbin_watson, found.x.size(),
        found.rho > 0.0 ? found.effective_size : static_cast<double>(found.x.size())));
  if (found.r2 < 0.9)
    warnings.push_back("R^2 is " + rounded_text(found.r2, 3) +
                       ", so that the model describes the curve poorly, and the estimates mean "
                       "little");
  std::vector<std::string> inseparable;
  for (const Identified& one : found.unknowns)
    if (one.inseparable) inseparable.push_back("`" + one.unknown.name() + "`");
  if (!inseparable.empty())
    warnings.push_back(
        joined(inseparable, " and ") +
        (inseparable.size() > 1 ? " have no numbers" : " has no number") +
        ": these data do not tell; give one by `--set` or `--given`, or add a test that "
        "differs, such as another radius or thickness, by `--with`");
  for (const Identified& one : found.unknowns)
    if (one.at_bound)
      warnings.push_back("the best `" + one.unknown.name() +
                         "` is on the edge of its range; widen the range, or hold it there with "
                         "`--set`");
  for (const Identification* one : views(found))
    if (one->predicted_error && *one->predicted_error > with.solver.tolerance)
      warnings.push_back("the estimated error of `" +
                         std::string(scenario::traits(one->taken).word) + "` is " +
                         percent_text(*one->predicted_error) +
                         " here, and the estimates are wrong by about as much" +
                         (one->given ? "; leave `solver.model` to `auto`" : ""));
  const auto waves = inertia_of_flow(with);
  if (waves && *waves > 0.01 && !about(with.solver.integrator).inertia)
    warnings.push_back("waves in the specimen change its deformation by about " +
                       percent_text(*waves) +
                       " and are neglected; set `solver.integrator = \"central_difference\"`");
  return warnings;
}

DefaultBody default_body(ScenarioCurve& curve, const scenario::Family& family,
                         std::span<const double> values) {
  const auto* box = std::get_if<scenario::Cuboid>(&curve.fixed().tissue.shape);
  const Member* tissue = family.document.find("tissue");
  const bool named = tissue != nullptr && tissue->value.find("shape") != nullptr;
  if (box == nullptr || named || curve.fixed().uniform()) return {};
  DefaultBody body;
  body.text = "the scenario names no `tissue.shape`, so that the body is the default block, ";
  for (std::size_t i = 0; i < 3; ++i)
    body.text += (i > 0 ? " by " : "") + rounded_text(unit::mm.from_si(box->size[i]));
  body.text += " mm";
  FixedModel half{.one = curve.at(values)};
  half.one.scenario.tissue.shape = scenario::HalfSpace{};
  half.one.scenario.solver.model = scenario::Model::hertz;
  const auto on_block = curve.rows(values);
  const auto on_half = ScenarioCurve(curve.kind(), std::move(half), family, {}).rows({});
  if (on_block && on_half && on_block->y.size() == on_half->y.size()) {
    // Over time the last row may be after the finger has left the body.
    const auto largest = std::max_element(on_half->y.begin(), on_half->y.end());
    const double on_this = on_block->y[as_index(largest - on_half->y.begin())];
    const double more = *largest > 0.0 ? on_this / *largest - 1.0 : 0.0;
    if (std::abs(more) > 0.02) {
      body.change = more;
      body.text += ", on which the force at the deepest is " + percent_text(std::abs(more)) +
                   (more > 0.0 ? " larger" : " smaller") +
                   " than on a half-space, and the intervals are as much wider";
    }
  }
  body.text += "; set it to that of the specimen";
  return body;
}

}  // namespace palpate::identify
