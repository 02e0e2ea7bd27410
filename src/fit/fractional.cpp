// The shapes of the search are the logarithm of tau and the logit of beta.
#include "fit/prony.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

#include "base/error.h"
#include "base/index.h"
#include "fit/ceres_fit.h"

namespace palpate::fit {
namespace {

struct NamedLaw {
  const char* name;
  const char* law;
};
constexpr std::array<NamedLaw, 3> fractional_laws{{
    {"spring_pot", "y = c x^-beta / Gamma(1-beta), Blair 1947"},
    {"spring_pot_creep", "y = J x^beta / Gamma(1+beta), Blair 1947"},
    {"fractional_zener",
     "y = y_inf + (y_0 - y_inf) E_beta(-(x/tau)^beta), Mittag-Leffler's function, Mainardi 2010"},
}};

double exponent_of(double logit) { return 1.0 / (1.0 + std::exp(-logit)); }

// The parameters' units: a spring-pot's factor has a power of the time that depends on beta.
std::vector<Estimate> parameters_of(Fractional model, const Options& options) {
  const std::string& y = options.y_unit;
  const std::string& x = options.x_unit;
  const std::string power = x.empty() ? "" : x + "^beta";
  const std::string each = y.empty() ? "1" : y;
  if (model == Fractional::zener)
    return {{.name = "y_inf", .unit = y},
            {.name = "y_0", .unit = y},
            {.name = "tau", .unit = x},
            {.name = "beta"}};
  if (model == Fractional::spring_pot)
    return {{.name = "c",
             .unit = power.empty() ? y
                     : y.empty()   ? power
                                   : y + " " + power},
            {.name = "beta"}};
  return {{.name = "J", .unit = power.empty() ? y : each + "/" + power}, {.name = "beta"}};
}

}  // namespace

double mittag_leffler(double alpha, double z) {
  assert(alpha > 0.0 && alpha <= 1.0 && z >= 0.0);
  // f(1) = 1/(2 pi i) int e^s F(s) ds over s = mu (1 + i u)^2, with the trapezoidal rule of step h.
  constexpr int half = 16;  // the error falls as e^(-2 pi N / 3)
  constexpr double step = 3.0 / half;
  constexpr double mu = std::numbers::pi * half / 12.0;
  std::complex<double> sum = 0.0;
  for (int k = 0; k < half; ++k) {  // symmetric in u: the midpoints of one side
    const double u = step * (k + 0.5);
    const std::complex<double> along(1.0, u);
    const std::complex<double> s = mu * along * along;
    // By real functions, whose bits are the same on every processor.
    const double size = std::pow(mu * (1.0 + u * u), alpha);
    const double angle = 2.0 * alpha * std::atan2(u, 1.0);
    const std::complex<double> power(size * std::cos(angle), size * std::sin(angle));
    const std::complex<double> turned(std::cos(s.imag()), std::sin(s.imag()));
    sum += std::exp(s.real()) * turned * power / (s * (power + z)) * along;
  }
  return 2.0 * mu * step / std::numbers::pi * sum.real();
}

Fit fit_fractional(std::span<const double> x, std::span<const double> y, Fractional model,
                   const Options& options) {
  assert(x.size() == y.size());
  Fit fit;
  fit.name = fractional_laws[as_index(model)].name;
  fit.law = fractional_laws[as_index(model)].law;
  fit.x_origin = options.x_origin;
  fit.parameters = parameters_of(model, options);
  std::vector<double> times, values;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = x[i] - options.x_origin;
    if (!std::isfinite(t) || !std::isfinite(y[i]) || !(t > 0.0)) continue;
    times.push_back(t);
    values.push_back(y[i]);
    fit.range_low = std::fmin(fit.range_low, x[i]);
    fit.range_high = std::fmax(fit.range_high, x[i]);
  }
  fit.n = static_cast<int>(times.size());
  fit.excluded = static_cast<int>(x.size()) - fit.n;
  const std::size_t count = fit.parameters.size();
  need_points(fit.name, count + 1, times.size(), " after the step",
              "; record more points, or give `--origin`");
  const double y_scale = scale_to_one(values);
  const double length = *std::max_element(times.begin(), times.end());
  for (double& each : times) each /= length;

  Separable curve;
  const bool zener = model == Fractional::zener;
  curve.linear = zener ? 2 : 1;
  if (zener) {
    for (const double log : {-6.0, -4.0, -2.5, -1.0, 0.5})
      for (const double logit : {-2.0, -1.0, 0.0, 1.0, 2.5}) curve.starts.push_back({log, logit});
    curve.columns = [&](std::span<const double> s, std::span<double> phi) {
      const double tau = std::exp(s[0]);
      const double beta = exponent_of(s[1]);
      if (!(beta > 1e-3) || !std::isfinite(tau) || !(tau > 0.0)) return false;
      for (std::size_t i = 0; i < times.size(); ++i) {
        const double left = mittag_leffler(beta, std::pow(times[i] / tau, beta));
        phi[2 * i] = 1.0 - left;
        phi[2 * i + 1] = left;
      }
      return true;
    };
  } else {
    const double sign = model == Fractional::spring_pot ? -1.0 : 1.0;
    for (double logit = -4.0; logit < 4.1; logit += 0.5) curve.starts.push_back({logit});
    curve.columns = [&, sign](std::span<const double> s, std::span<double> phi) {
      const double beta = exponent_of(s[0]);
      const double gamma = std::tgamma(1.0 + sign * beta);
      for (std::size_t i = 0; i < times.size(); ++i)
        phi[i] = std::pow(times[i], sign * beta) / gamma;
      return true;
    };
  }
  Minimum minimum = minimise(values, curve, options.max_iterations);
  std::vector<double> scale(count, 1.0);
  if (minimum.status != Minimum::Status::failed) {
    const double beta = exponent_of(minimum.parameters.back());
    replace_parameter(minimum, count - 1, beta, beta * (1.0 - beta));
    if (zener) {
      const double tau = std::exp(minimum.parameters[2]);
      replace_parameter(minimum, 2, tau, tau);
      scale = {y_scale, y_scale, length, 1.0};
    } else {
      // c of y = c (x/L)^-beta is c L^beta of x^-beta, which depends on beta too.
      const double sign = model == Fractional::spring_pot ? 1.0 : -1.0;
      const double factor = std::pow(length, sign * beta);
      const double by_beta = sign * std::log(length) * minimum.parameters[0];
      add_to_parameter(minimum, 0, 1, by_beta);
      scale = {y_scale * factor, 1.0};
    }
  }
  settle(fit, minimum, {values, y_scale, scale, options.residuals});
  return fit;
}

}  // namespace palpate::fit
