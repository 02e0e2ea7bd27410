// The force law of a sphere on an elastic layer on a rigid base, tabulated once from the exact
// solution (contact/layer_integral.h).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "contact/layer_integral.h"

namespace palpate::contact {

// chi = sqrt(R h) / H for the depth h (m), the effective radius R (m) and the thickness H (m); 0
// for h <= 0.
[[nodiscard]] double layer_chi(double depth, double radius, double thickness);

// F / F_Hertz and its like over chi in [0, last_chi()]: exactly 1 at chi = 0, values within 1e-7 of
// the integral equation, slopes and pressures within 1e-6; of several layers values within 1e-5.
// Beyond last_chi(), and below 0, every answer is NaN: a sphere that deep in so thin a layer is for
// the caller to refuse. To build it takes some 20 ms, of several layers up to 0.5 s; its functions
// allocate nothing and use + - * / and sqrt alone.
// docs/theory.md (57)-(59)
class LayerLaw {
 public:
  explicit LayerLaw(const Layer& layer);

  // 3; of several layers less, where the contact is very much wider than the top one is thick.
  [[nodiscard]] double last_chi() const { return last_chi_; }

  [[nodiscard]] double force_factor(double chi) const;      // f = F / F_Hertz(h)
  [[nodiscard]] double force_slope(double chi) const;       // df/dchi
  [[nodiscard]] double stiffness_factor(double chi) const;  // dF/dh / (2 E* sqrt(R h))
  [[nodiscard]] double radius_factor(double chi) const;     // a / sqrt(R h)
  [[nodiscard]] PressureProfile pressure(double chi) const;

  // The inverse: where chi^3 f(chi) is `load`, F over that of a Hertz contact as wide as the layer
  // is thick, 4/3 E* H^3 / R. Empty beyond last_chi(), 0 for no load.
  [[nodiscard]] std::optional<double> chi(double load) const;

 private:
  struct Factor {
    double value, slope;  // f and df/dchi
  };
  [[nodiscard]] Factor factor(double chi) const;

  [[nodiscard]] double place(double chi) const;
  [[nodiscard]] double place_slope(double chi) const;
  [[nodiscard]] bool known(double chi) const { return chi >= 0.0 && chi <= last_chi_; }

  double top_, last_chi_;
  using Series = std::vector<double>;  // of (quantity - its value at chi = 0) / chi
  Series force_, radius_;
  std::array<Series, PressureProfile::terms> pressure_;
};

// The same with sizes. Depths in m; without contact, at a depth of 0 or less, all answers are 0;
// beyond `last_depth` they are NaN, and there is no depth for the force.
struct LayerContact {
  double radius;     // R, m
  double modulus;    // E*, Pa
  double thickness;  // H, m
  LayerLaw law;

  [[nodiscard]] double last_depth() const;                             // m, where chi = last_chi()
  [[nodiscard]] double force(double depth) const;                      // N
  [[nodiscard]] double stiffness(double depth) const;                  // dF/dh, N/m
  [[nodiscard]] std::optional<double> depth(double force) const;       // the inverse of `force`
  [[nodiscard]] double contact_radius(double depth) const;             // m
  [[nodiscard]] double pressure(double distance, double depth) const;  // Pa, at r from the centre
};

}  // namespace palpate::contact
