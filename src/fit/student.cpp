// The distribution by a continued fraction of the beta function, its quantile by Newton's method.
#include "fit/student.h"

#include <cassert>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <utility>

namespace palpate::fit {
namespace {

// Regularised incomplete beta function for x < (a + 1) / (a + b + 2), where this converges fast:
// I_x(a, b) = x^a (1-x)^b / (a B(a, b)) / (1 + d1/(1 + d2/(1 + ...)))       DLMF 8.17.22
// The fraction is evaluated by Lentz's method (Thompson and Barnett 1986).
double beta_fraction(double x, double a, double b) {
  constexpr double tiny = 1e-300;
  double c = 1.0;
  double d = 1.0 / (1.0 - (a + b) * x / (a + 1.0));
  double fraction = d;
  for (int m = 1; m < 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double change = 1.0;
    for (const double term : {even, odd}) {
      d = 1.0 + term * d;
      c = 1.0 + term / c;
      if (d == 0.0) d = tiny;
      if (c == 0.0) c = tiny;
      d = 1.0 / d;
      change = c * d;
      fraction *= change;
    }
    if (std::abs(change - 1.0) < 4e-16) break;  // rounding: a smaller limit is met by chance
  }
  const double log_beta = std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
  return std::exp(a * std::log(x) + b * std::log1p(-x) - log_beta) / a * fraction;
}

// P(T > t) for t >= 0: 1/2 I_(v/(v+t^2))(v/2, 1/2)                          DLMF 8.17, A&S 26.7.1
double upper_tail(double t, double degrees) {
  const double a = degrees / 2.0;
  const double x = degrees / (degrees + t * t);
  if (t == 0.0) return 0.5;
  if (x < (a + 1.0) / (a + 2.5)) return 0.5 * beta_fraction(x, a, 0.5);
  return 0.5 - 0.5 * beta_fraction(t * t / (degrees + t * t), 0.5, a);
}

double density(double t, double degrees) {
  const double half = degrees / 2.0;
  const double log_scale =
      std::lgamma(half + 0.5) - std::lgamma(half) - 0.5 * std::log(degrees * std::numbers::pi);
  return std::exp(log_scale - (half + 0.5) * std::log1p(t * t / degrees));
}

}  // namespace

double student_t_cdf(double t, double degrees) {
  assert(degrees > 0.0);
  const double tail = upper_tail(std::abs(t), degrees);
  return t > 0.0 ? 1.0 - tail : tail;
}

double student_t_quantile(double probability, double degrees) {
  assert(probability > 0.0 && probability < 1.0 && degrees >= 1.0);
  if (probability < 0.5) return -student_t_quantile(1.0 - probability, degrees);
  // The last ones of this thread: the fits of a sweep's cases have the same degrees of freedom.
  thread_local std::map<std::pair<double, double>, double> known;
  const auto found = known.find({probability, degrees});
  if (found != known.end()) return found->second;
  if (known.size() >= 16) known.clear();
  const double tail = 1.0 - probability;
  // The tail decreases and is convex for t >= 0, so that Newton's steps from 0 never pass the root.
  double t = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double step = (upper_tail(t, degrees) - tail) / density(t, degrees);
    t += step;
    if (step <= 1e-8 * t) break;  // what is left is its square; smaller steps are rounding
  }
  known.emplace(std::pair(probability, degrees), t);
  return t;
}

}  // namespace palpate::fit
