// Student's t distribution: how wide an interval must be where the variance is itself estimated.
#pragma once

namespace palpate::fit {

// P(T <= t) for `degrees` > 0 degrees of freedom, by the regularised incomplete beta function.
[[nodiscard]] double student_t_cdf(double t, double degrees);

// The t with P(T <= t) = probability, 0 < probability < 1, degrees >= 1.
[[nodiscard]] double student_t_quantile(double probability, double degrees);

}  // namespace palpate::fit
