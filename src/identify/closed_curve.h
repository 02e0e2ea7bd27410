// Curves with a closed formula, as templates for numbers and for Ceres's dual numbers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "identify/unknowns.h"

namespace palpate::identify {

struct ClosedCurve {
  enum class Form {
    hertz_press,
    voigt_creep,
    solid_creep,
    solid_relaxation,
    voigt_compression,
    solid_compression
  };
  // The parameters of the formulas; each is an unknown or has its value in `known`.
  enum Slot { modulus, poisson, time, ratio, contact_point, force_offset, slots };

  Form form = Form::hertz_press;
  std::array<double, slots> known{};  // SI
  std::vector<Unknown> unknowns;
  std::vector<Slot> slot_of;  // one per unknown

  double radius = 0.0;             // m, of the finger
  double finger_compliance = 0.0;  // 1/Pa, lambda_1
  double load = 0.0;               // creep: stress, Pa; otherwise strain
  double load_time = 0.0;          // s, duration of the stress, or of the growth of the strain
  bool over_strain = false;        // compression: `x` is the strain while it grows
  std::vector<double> x;           // m or s, one per measured point
};

namespace closed {

template <class T>
T from_unit(const Unknown& unknown, const T& u) {
  using std::exp;
  if (unknown.scale == Unknown::Scale::logarithmic)
    return unknown.low * exp(u * std::log(unknown.high / unknown.low));
  return unknown.low + u * (unknown.high - unknown.low);
}

// F = 4/3 E* sqrt(R) h^(3/2), 1/E* = lambda_1 + (1 - nu^2) / E, h = x - contact point
//                                             Chen 2007 eq. (2); docs/theory.md [modulus], [radius]
template <class T>
T hertz_press(const ClosedCurve& curve, const std::array<T, ClosedCurve::slots>& p, double x) {
  using std::sqrt;
  const T depth = x - p[ClosedCurve::contact_point];
  if (!(depth > 0.0)) return p[ClosedCurve::force_offset];
  const T& nu = p[ClosedCurve::poisson];
  const T modulus = 1.0 / (curve.finger_compliance + (1.0 - nu * nu) / p[ClosedCurve::modulus]);
  return 4.0 / 3.0 * modulus * std::sqrt(curve.radius) * depth * sqrt(depth) +
         p[ClosedCurve::force_offset];
}

// Strain under a stress from time 0 to `load_time`, by superposition: unloading adds the opposite
// stress. `creep(t)` is the creep compliance J(t), 1/Pa.
//                                                        docs/theory.md [fit_creep], [fit_recovery]
template <class T, class Creep>
T loaded_and_freed(const ClosedCurve& curve, double t, const Creep& creep) {
  T strain = curve.load * creep(t);
  if (t > curve.load_time) strain -= curve.load * creep(t - curve.load_time);
  return strain;
}

// Kelvin-Voigt, tau = eta / E: J(t) = (1 - e^(-t/tau)) / E
//                                                        docs/theory.md [kelvin_voigt], [fit_creep]
template <class T>
T voigt_creep(const ClosedCurve& curve, const std::array<T, ClosedCurve::slots>& p, double x) {
  using std::exp;
  return loaded_and_freed<T>(curve, x, [&](double t) -> T {
    return (1.0 - exp(-t / p[ClosedCurve::time])) / p[ClosedCurve::modulus];
  });
}

// Standard linear solid with the moduli E (relaxed) and r E (instantaneous):
// J(t) = 1/E - (1/E - 1/(r E)) e^(-t/tau_c), tau_c = r tau        docs/theory.md [branches]
template <class T>
T solid_creep(const ClosedCurve& curve, const std::array<T, ClosedCurve::slots>& p, double x) {
  using std::exp;
  const T r = p[ClosedCurve::ratio];
  return loaded_and_freed<T>(curve, x, [&](double t) -> T {
    return (1.0 - (1.0 - 1.0 / r) * exp(-t / (r * p[ClosedCurve::time]))) / p[ClosedCurve::modulus];
  });
}

// sigma(t) = strain E (1 + (r - 1) e^(-t/tau))        docs/theory.md [branches], [fit_relaxation]
template <class T>
T solid_relaxation(const ClosedCurve& curve, const std::array<T, ClosedCurve::slots>& p, double x) {
  using std::exp;
  return curve.load * p[ClosedCurve::modulus] *
         (1.0 + (p[ClosedCurve::ratio] - 1.0) * exp(-x / p[ClosedCurve::time]));
}

// The time since a compression began, s.
inline double compression_time(const ClosedCurve& curve, double x) {
  return curve.over_strain ? x / curve.load * curve.load_time : x;
}

// The stress under a strain that grows for `load_time` and stays: sigma = E (strain + tau strain')
//                                                             docs/theory.md [kelvin_voigt]
template <class T>
T voigt_compression(const ClosedCurve& curve, const std::array<T, ClosedCurve::slots>& p,
                    double x) {
  const double t = compression_time(curve, x);
  const double rate = curve.load / curve.load_time;
  if (!(t < curve.load_time)) return curve.load * p[ClosedCurve::modulus];
  return p[ClosedCurve::modulus] * rate * (t + p[ClosedCurve::time]);
}

// The same by superposition of solid_relaxation(); elastic where r = 1.
//                                                       docs/theory.md [branches], [fit_relaxation]
template <class T>
T solid_compression(const ClosedCurve& curve, const std::array<T, ClosedCurve::slots>& p,
                    double x) {
  using std::exp;
  const double t = compression_time(curve, x);
  const double grown = std::min(t, curve.load_time);
  const double rate = curve.load / curve.load_time;
  const T& tau = p[ClosedCurve::time];
  return p[ClosedCurve::modulus] * rate *
         (grown + (p[ClosedCurve::ratio] - 1.0) * tau * (exp((grown - t) / tau) - exp(-t / tau)));
}

// Computes the curve at its points `curve.x` (SI) for the unknowns u in [0, 1].
template <class T>
void values(const ClosedCurve& curve, const T* u, T* out) {
  std::array<T, ClosedCurve::slots> p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = T(curve.known[i]);
  for (std::size_t i = 0; i < curve.unknowns.size(); ++i)
    p[curve.slot_of[i]] = from_unit(curve.unknowns[i], u[i]);
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double x = curve.x[i];
    switch (curve.form) {
      case ClosedCurve::Form::hertz_press: out[i] = hertz_press(curve, p, x); break;
      case ClosedCurve::Form::voigt_creep: out[i] = voigt_creep(curve, p, x); break;
      case ClosedCurve::Form::solid_creep: out[i] = solid_creep(curve, p, x); break;
      case ClosedCurve::Form::solid_relaxation: out[i] = solid_relaxation(curve, p, x); break;
      case ClosedCurve::Form::voigt_compression: out[i] = voigt_compression(curve, p, x); break;
      case ClosedCurve::Form::solid_compression: out[i] = solid_compression(curve, p, x); break;
    }
  }
}

}  // namespace closed
}  // namespace palpate::identify
