// Sentences on why the estimates may be wrong.
#include "identify/warnings.h"

#include <algorithm>

#include "base/text.h"
#include "fit/residual_tests.h"
#include "identify/fixed_rung.h"
#include "scenario/integrators.h"

namespace palpate::identify {

std::vector<std::string> warnings_of(const Identification& found,
                                     const WeightedResiduals& residuals,
                                     const scenario::Resolved& with) {
  std::vector<std::string> warnings;
  // Systematic residuals below a thousandth of the curve come from interpolation.
  if (fit::systematic(residuals.values) && residuals.noise > 1e-3)
    warnings.push_back(
        "the model does not describe the data: neighbouring residuals are correlated "
        "(Durbin-Watson " +
        rounded_text(found.durbin_watson, 3) + ", noise gives 2). The intervals count the " +
        std::to_string(found.x.size()) + " points as " +
        rounded_text(std::max(1.0, found.effective_size), 3) +
        " independent ones; the bias of a wrong model is not in them");
  if (found.rho > 0.0 && found.effective_size < 10.0 && residuals.noise > 1e-3)
    warnings.emplace_back(
        "the points are worth fewer than 10 independent ones, which cannot tell noise from a law "
        "that does not fit; record a longer curve");
  if (found.r2 < 0.9)
    warnings.push_back("R^2 is " + rounded_text(found.r2, 3) +
                       ", so that the model describes the curve poorly, and the estimates mean "
                       "little");
  std::vector<std::string> tied;
  for (const Identified& one : found.unknowns)
    if (one.tied) tied.push_back("`" + one.unknown.name() + "`");
  if (!tied.empty())
    warnings.push_back(
        joined(tied, " and ") + (tied.size() > 1 ? " have no numbers" : " has no number") +
        ": these data do not tell; give one by `--set` or `--given`, or add a test that "
        "differs, such as another radius or thickness, by `--with`");
  for (const Identified& one : found.unknowns)
    if (one.at_bound)
      warnings.push_back("the best `" + one.unknown.name() +
                         "` is on the edge of its range; widen the range, or hold it there with "
                         "`--set`");
  for (const Identification* one : views(found))
    if (one->predicted_error && *one->predicted_error > with.solver.tolerance)
      warnings.push_back("the estimated error of `" + std::string(scenario::rung(one->rung).word) +
                         "` is " + percent_text(*one->predicted_error) +
                         " here, and the estimates are wrong by about as much" +
                         (one->given ? "; leave `solver.model` to `auto`" : ""));
  const auto waves = inertia_of_flow(with);
  if (waves && *waves > 0.01 && !about(with.solver.integrator).inertia)
    warnings.push_back("waves in the specimen change its deformation by about " +
                       percent_text(*waves) +
                       " and are left out; set `solver.integrator = \"central_difference\"`");
  return warnings;
}

}  // namespace palpate::identify
