// Durbin-Watson statistic and runs test.
#include "fit/residual_tests.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"

namespace palpate::fit {

double durbin_watson(std::span<const double> residuals) {
  double steps = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    squares += residuals[i] * residuals[i];
    if (i > 0) {
      const double step = residuals[i] - residuals[i - 1];
      steps += step * step;
    }
  }
  return squares > 0.0 ? steps / squares : 2.0;
}

double runs_z(std::span<const double> residuals) {
  double above = 0.0;
  double below = 0.0;
  double runs = 0.0;
  int last = 0;
  for (const double each : residuals) {
    const int sign = each > 0.0 ? 1 : each < 0.0 ? -1 : 0;
    if (sign == 0) continue;
    (sign > 0 ? above : below) += 1.0;
    if (sign != last) runs += 1.0;
    last = sign;
  }
  // mean 2 n m / (n + m) + 1, variance (mean - 1) (mean - 2) / (n + m - 1)
  const double all = above + below;
  if (all < 2.0) return 0.0;
  if (above == 0.0 || below == 0.0) return -std::numeric_limits<double>::infinity();
  const double mean = 2.0 * above * below / all + 1.0;
  const double variance = (mean - 1.0) * (mean - 2.0) / (all - 1.0);
  return variance > 0.0 ? (runs - mean) / std::sqrt(variance) : 0.0;
}

bool systematic(std::span<const double> residuals) {
  constexpr double quantile = 3.09;  // of the normal distribution, 1 in 1000
  const auto n = static_cast<double>(residuals.size());
  // The variance of the Durbin-Watson statistic of independent residuals is about 4 / n.
  return n >= 10.0 && durbin_watson(residuals) < 2.0 - quantile * 2.0 / std::sqrt(n) &&
         runs_z(residuals) < -quantile;
}

std::string correlation_sentence(double durbin_watson, std::size_t points, double effective) {
  return "neighbouring residuals are correlated (Durbin-Watson " + rounded_text(durbin_watson, 3) +
         ", independent noise gives 2), by slow noise or by a law that does not fit. The intervals "
         "count the " +
         std::to_string(points) + " points as " + rounded_text(std::max(1.0, effective), 3) +
         " independent ones, as slow noise wants; the bias of a wrong law is not in them" +
         (effective < 10.0 ? ", and an effective sample size below 10 cannot tell the two "
                             "apart: record a longer curve"
                           : "");
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
