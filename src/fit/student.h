// Student's t distribution, for confidence intervals with an estimated variance.
#pragma once

namespace palpate::fit {

// P(T <= t) for `degrees` > 0 degrees of freedom, by the regularised incomplete beta function.
[[nodiscard]] double student_t_cdf(double t, double degrees);

// The t for which P(T <= t) = probability, with 0 < probability < 1 and degrees >= 1.
[[nodiscard]] double student_t_quantile(double probability, double degrees);

}  // namespace palpate::fit
