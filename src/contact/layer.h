// The force law of a sphere on an elastic layer, tabulated from the solution in layer_integral.h.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "contact/layer_integral.h"

namespace palpate::contact {

// chi = sqrt(R h) / H for h (m), the effective radius R (m) and the thickness H (m); 0 for h <= 0.
[[nodiscard]] double layer_chi(double depth, double radius, double thickness);

// The equations from which a LayerLaw is made, for a layer with any `share`.
class LayerTable {
 public:
  explicit LayerTable(const Layer& layer);

 private:
  friend class LayerLaw;
  double top_, last_chi_;
  std::size_t terms_;           // of the law's series
  std::vector<double> ratios_;  // a/H
  std::vector<LayerSystem> systems_;
};

// The table of F / F_Hertz and related factors over chi in [0, last_chi()]. The factors are exactly
// 1 at chi = 0; values deviate by less than 1e-7 from the integral equation (several layers: 1e-5),
// slopes and pressures by less than 1e-6. Outside [0, last_chi()] every result is NaN; the caller
// has to refuse such a deep press into a thin layer. Construction takes about 5 ms, from a table
// half a millisecond, for several layers up to 0.5 s; the functions allocate nothing and use + - *
// / and sqrt only.
//
//                                                            docs/theory.md [layer], [layer_series]
class LayerLaw {
 public:
  explicit LayerLaw(const Layer& layer);
  // The same with this `share` of the layer of the table, in 0 to 1, to the bit.
  LayerLaw(const LayerTable& table, double share);

  // 3; less for several layers with a top layer much thinner than such a contact is wide.
  [[nodiscard]] double last_chi() const { return scale_.last; }

  [[nodiscard]] double force_factor(double chi) const;      // f = F / F_Hertz(h)
  [[nodiscard]] double stiffness_factor(double chi) const;  // dF/dh / (2 E* sqrt(R h))
  [[nodiscard]] double radius_factor(double chi) const;     // a / sqrt(R h)
  [[nodiscard]] PressureProfile pressure(double chi) const;

 private:
  friend class LayerTable;
  // [0, last] on the interval [0, 1] of Chebyshev's polynomials.
  struct Scale {
    double top;   // thickness of the top layer divided by H
    double last;  // the largest chi or a/H
    [[nodiscard]] double place(double x) const;
    [[nodiscard]] double slope(double x) const;      // of place()
    [[nodiscard]] double value(double place) const;  // the inverse of place()
  };
  struct Factor {
    double value, slope;  // f and df/dchi
  };
  [[nodiscard]] Factor factor(double chi) const;
  [[nodiscard]] bool known(double chi) const { return chi >= 0.0 && chi <= scale_.last; }

  Scale scale_;
  using Series =
      std::vector<double>;  // Chebyshev coefficients of (quantity - value at chi = 0) / chi
  Series force_, radius_;
  std::array<Series, PressureProfile::terms> pressure_;
};

// The law for given sizes. Depths in m; all results are 0 at a depth of 0 or less, and NaN
// beyond last_depth().
struct LayerContact {
  double radius;     // R, m
  double modulus;    // E*, Pa
  double thickness;  // H, m
  LayerLaw law;

  [[nodiscard]] double last_depth() const;                  // m, where chi = last_chi()
  [[nodiscard]] double force(double depth) const;           // N
  [[nodiscard]] double stiffness(double depth) const;       // dF/dh, N/m
  [[nodiscard]] double contact_radius(double depth) const;  // m
};

}  // namespace palpate::contact
