// Closed forms for steps and ramps, a recursion for histories that were measured.
#include "fit/prony_basis.h"

#include <algorithm>
#include <cmath>

namespace palpate::fit {
namespace {

struct Term {
  double value, slope;
};

// e^(-t/tau), and d/d ln tau = t/tau e^(-t/tau)
Term after_step(double t, double tau) {
  const double left = std::exp(-t / tau);
  return {left, t / tau * left};
}

Term after_ramp(double t, double tau, double ramp) {
  if (t <= 0.0) return {0.0, 0.0};
  const double since_start = std::exp(-t / tau);
  if (t < ramp) {
    const double value = -tau / ramp * std::expm1(-t / tau);
    return {value, value - t / ramp * since_start};
  }
  const double since_end = std::exp(-(t - ramp) / tau);
  // since_end - since_start = since_end (1 - e^(-ramp/tau)), without cancellation
  const double value = -tau / ramp * since_end * std::expm1(-ramp / tau);
  return {value, value + (t - ramp) / ramp * since_end - t / ramp * since_start};
}

}  // namespace

BasisColumn relaxing(std::span<const double> t, double tau, const LoadingHistory& history) {
  BasisColumn column;
  column.value.reserve(t.size());
  column.slope.reserve(t.size());
  if (history.samples.empty()) {
    for (const double each : t) {
      const Term term =
          history.ramp > 0.0 ? after_ramp(each, tau, history.ramp) : after_step(each, tau);
      column.value.push_back(term.value);
      column.slope.push_back(term.slope);
    }
    return column;
  }
  // phi_i = phi_(i-1) e^(-d/tau) + r tau (1 - e^(-d/tau)), r the rate of the history in d
  double value = history.samples.front();
  double slope = 0.0;
  column.value.push_back(value);
  column.slope.push_back(slope);
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double d = t[i] - t[i - 1];
    const double change = history.samples[i] - history.samples[i - 1];
    if (d <= 0.0) {
      value += change;
    } else {
      const double left = std::exp(-d / tau);
      const double gain = -tau / d * std::expm1(-d / tau);  // of a ramp over d
      slope = left * (slope + value * d / tau) + change * (gain - left);
      value = left * value + change * gain;
    }
    column.value.push_back(value);
    column.slope.push_back(slope);
  }
  return column;
}

std::vector<double> loading(std::span<const double> t, const LoadingHistory& history) {
  if (!history.samples.empty()) return history.samples;
  std::vector<double> values;
  for (const double each : t)
    values.push_back(history.ramp > 0.0 ? std::clamp(each / history.ramp, 0.0, 1.0) : 1.0);
  return values;
}

}  // namespace palpate::fit
