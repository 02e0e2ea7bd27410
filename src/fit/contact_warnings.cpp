// Sentences on the limits of a contact fit.
#include "fit/contact_warnings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "contact/depth_ratio.h"
#include "fit/residual_tests.h"

namespace palpate::fit {
namespace {

// Hertz's paraboloid against the exact law of a sphere at the same depth, minus 1.
double error_of_hertz(double depth, double radius) {
  const Tip paraboloid{Tip::Kind::paraboloid, radius, 0.0};
  const Tip sphere{Tip::Kind::sphere, radius, 0.0};
  return tip_force(paraboloid, depth).force / tip_force(sphere, depth).force - 1.0;
}

// The force of a sphere on neo-Hookean tissue at the deepest row, or as deep as it is known,
// against the law fitted, minus 1; 0 where it is not known.                      docs/theory.md
// [deep]
struct Change {
  double depth = 0.0, change = 0.0;
};
Change change_by_strain(const ContactResult& result) {
  const ContactTest& test = result.test;
  const bool round = test.tip == Tip::Kind::paraboloid || test.tip == Tip::Kind::sphere;
  if (!round) return {};
  const auto ratio = contact::depth_ratio(
      {.radius = test.radius,
       .thickness = test.thickness.value_or(std::numeric_limits<double>::infinity()),
       .poisson_ratio = test.poisson_ratio,
       .base = test.base});
  if (!ratio) return {};
  const double depth = std::min(result.deepest, ratio->last_depth());
  const double linear =  // of the paraboloid, to which the ratio refers
      test.tip == Tip::Kind::sphere ? 1.0 + error_of_hertz(depth, test.radius) : 1.0;
  return {depth, ratio->value(depth) * linear - 1.0};
}

std::string rows_text(std::size_t count) {
  return (count == 0 ? "no" : std::to_string(count)) + (count < 2 ? " row lies" : " rows lie");
}

}  // namespace

void warn_of_contact(Fit& fit, const ContactResult& result) {
  const ContactTest& test = result.test;
  const auto warn = [&](const std::string& sentence) { fit.warnings.push_back(sentence); };
  if (result.beyond < 10)
    warn("only " + rows_text(result.beyond) +
         " beyond the contact point, so that modulus and contact point depend on each other; "
         "record more points, or press deeper");
  const bool automatic = test.baseline == ContactTest::BaselineChoice::automatic;
  if (automatic && result.before < 3)
    warn(rows_text(result.before) +
         (result.baseline == Baseline::none
              ? " before contact, so that a force offset cannot be told; the force is taken as "
                "measured from zero"
              : " before contact, and the force offset follows from the bend of the curve alone; "
                "record rows before contact, or give `--baseline none` if the force is zeroed"));
  if (result.baseline == Baseline::tilt && result.drift > 0.5)
    warn("the baseline rises by " + percent_text(result.drift) +
         " of the contact force over the curve; give `--baseline offset` or a part of the curve by "
         "`--to`");
  const bool round = test.tip == Tip::Kind::paraboloid || test.tip == Tip::Kind::sphere;
  if (round && result.deepest > test.radius) {
    warn("the tip is " + rounded_text(result.deepest / test.radius, 3) +
         " radii deep, and beyond one radius its shape is no sphere; give the part of the curve "
         "up to a smaller depth by `--to`");
  } else if (test.tip == Tip::Kind::paraboloid) {
    const double error = error_of_hertz(result.deepest, test.radius);
    if (error > 0.02)
      warn("at the largest depth Hertz's law of a paraboloid is " + percent_text(error) +
           " stiffer than the exact law of a sphere" +
           (test.thickness ? "; give a smaller depth by `--to`"
                           : "; give `--tip sphere`, or a smaller depth by `--to`"));
  }
  if (const auto [depth, change] = change_by_strain(result); std::abs(change) > 0.02)
    fit.notes.push_back(
        "the law is that of small strains: in neo-Hookean tissue the force at " +
        (depth < result.deepest ? "a depth of " + rounded_text(unit::mm.from_si(depth)) + " mm"
                                : std::string("the largest depth")) +
        " is " + percent_text(std::abs(change)) + (change < 0.0 ? " lower" : " higher") +
        (depth < result.deepest ? " already, and how much beyond is not known"
                                : ", which `palpate identify` takes into account"));
  warn_of_residuals(fit);
}

void warn_of_residuals(Fit& fit) {
  const auto warn = [&](const std::string& sentence) { fit.warnings.push_back(sentence); };
  if (fit.r2 < 0.9)
    warn("R^2 is " + rounded_text(fit.r2, 3) +
         ", so that the law describes the curve poorly, and the estimates mean little");
  if (fit.rho > 0.0)
    warn(correlation_sentence(fit.durbin_watson, static_cast<std::size_t>(fit.n),
                              fit.effective_size));
}

}  // namespace palpate::fit
