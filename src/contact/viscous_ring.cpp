// Branches of a pressed ring, modes of a free ring, and the conversion between them.
#include "contact/viscous_ring.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpate::contact {
namespace {

// exp(-x) and (1 - exp(-x)) / x, accurate to x^3/6 and x^2/6 and decreasing from 1 to 0 as well.
double fade(double x) { return 1.0 / (1.0 + x + 0.5 * x * x); }
double mean_fade(double x) { return (1.0 + 0.5 * x) * fade(x); }

// Both at part * x, corrected so that they are exact for the whole step; the remaining error is of
// the next order. This avoids an exponential for every ring that enters or leaves within a step.
double fade_over(double part, double x, double whole) {
  return fade(part * x) + part * part * part * (whole - fade(x));
}
double mean_fade_over(double part, double x, double whole) {
  return mean_fade(part * x) + part * part * (whole - mean_fade(x));
}

}  // namespace

ViscousRing::ViscousRing(const Relaxation& relaxation)
    : relaxation_(sorted(relaxation)),
      creep_(creep(relaxation_)),
      branch_keep_(relaxation_.branches.size(), 1.0),
      mode_keep_(creep_.modes.size(), 1.0) {
  for (const Branch& branch : relaxation_.branches) branch_gain_.push_back(branch.ratio);
  // j_m = 1 / (T_m sum_k b_k tau_k / (T_m - tau_k)^2)
  for (const Branch& mode : creep_.modes) slopes_.push_back(1.0 / (mode.time * mode.ratio));
}

void ViscousRing::set_time_step(double time_step) {
  assert(time_step >= 0.0);
  if (time_step == time_step_) return;
  time_step_ = time_step;
  for (std::size_t k = 0; k < branch_keep_.size(); ++k) {
    const auto [tau, b] = relaxation_.branches[k];
    branch_keep_[k] = std::exp(-time_step / tau);
    // b tau/dt (1 - exp(-dt/tau))
    branch_gain_[k] = time_step > 0.0 ? -b * tau / time_step * std::expm1(-time_step / tau) : b;
  }
  for (std::size_t m = 0; m < mode_keep_.size(); ++m)
    mode_keep_[m] = std::exp(-time_step / creep_.modes[m].time);
}

void ViscousRing::press(double part, double sinking, std::span<double> branches) const {
  for (std::size_t k = 0; k < branches.size(); ++k) {
    const auto [tau, b] = relaxation_.branches[k];
    const double x = time_step_ / tau;
    branches[k] = fade_over(part, x, branch_keep_[k]) * branches[k] +
                  b * mean_fade_over(part, x, branch_gain_[k] / b) * sinking;
  }
}

void ViscousRing::rise(double part, std::span<double> modes) const {
  for (std::size_t m = 0; m < modes.size(); ++m)
    modes[m] *= fade_over(part, time_step_ / creep_.modes[m].time, mode_keep_[m]);
}

void ViscousRing::let_go(double sinking, std::span<const double> branches,
                         std::span<double> modes) const {
  // y_m = -sum_k q_k / (T_m - tau_k) / sum_k b_k tau_k / (T_m - tau_k)^2. For a ring that was only
  // pushed, no mode is negative; if interpolation in a long step makes one negative, it is set to 0
  // and the others are scaled to the sum w. Kelvin-Voigt has one mode, w.
  const std::size_t n = branches.size();
  double sum = 0.0;
  for (std::size_t m = 0; m < modes.size(); ++m) {
    double mode = 0.0;
    for (std::size_t k = 0; k < n; ++k) mode -= branches[k] / creep_.gaps[m * n + k];
    modes[m] = n > 0 ? std::max(mode / slopes_[m], 0.0) : 1.0;
    sum += modes[m];
  }
  const double scale = sum > 0.0 ? std::max(sinking, 0.0) / sum : 0.0;
  for (double& mode : modes) mode *= scale;
}

void ViscousRing::meet(std::span<const double> modes, std::span<double> branches) const {
  // q_k = -sum_m b_k tau_k / (T_m - tau_k) y_m
  const std::size_t n = branches.size();
  for (std::size_t k = 0; k < n; ++k) {
    branches[k] = 0.0;
    for (std::size_t m = 0; m < modes.size(); ++m) branches[k] -= modes[m] / creep_.gaps[m * n + k];
    branches[k] *= relaxation_.branches[k].ratio * relaxation_.branches[k].time;
  }
}

}  // namespace palpate::contact
