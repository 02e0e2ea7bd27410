// Exact contact of a sphere or flat punch with an elastic layer: its integral equation, and the
// force law that is tabulated from its solution.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace palpate::contact {

// Support of the layer's lower face: bonded to the base, or sliding on it without lifting off.
enum class LayerBase { bonded, frictionless };

// A layer under the top one, bonded to its neighbours.
struct Sublayer {
  double thickness = 0.0;      // fraction of the total thickness H
  double stiffness = 1.0;      // shear modulus divided by that of the top layer
  double poisson_ratio = 0.5;  // -1 < nu <= 1/2
};

// One layer, or several bonded layers of total thickness H, without the value of H.
struct Layer {
  double poisson_ratio = 0.5;  // -1 < nu <= 1/2, top layer; no effect on one frictionless layer
  LayerBase base = LayerBase::bonded;
  // lambda_2 / (lambda_1 + lambda_2), the tissue's fraction of the compliance, 0 to 1; 1 under a
  // rigid finger. The finger is a half-space of compliance lambda_1.
  double share = 1.0;
  std::vector<Sublayer> below = {};  // from the second to the lowest; total thickness below 1

  [[nodiscard]] double top() const;  // thickness of the top layer divided by H
};

// L(u) for the wave number u = xi H > 0: the surface displacement under a sinusoidal pressure
// divided by that of a half-space of the top layer's tissue. Each layer has four plane waves, two
// that decay from its top and two from its bottom. Displacements and tractions are continuous
// between layers, the surface has no shear, and the base is that of layer.base. Exact for any nu up
// to 1/2, except for rounding of 1e-16 / u^3 near u = 0, where the waves become linearly dependent.
//                                           Mindlin's solutions; docs/theory.md [layer_stack]
[[nodiscard]] double stack_surface_displacement(double u, const Layer& layer);

// Discretisation of the equation: numbers of Gauss-Legendre points.
struct LayerResolution {
  int points = 0;  // over the contact's radius
  int waves = 0;   // over the wave number u = xi H
};

// Sufficient for an error of 1e-8 in every result below if a divided by the top layer's thickness
// is at most `greatest_ratio` <= 40, and for 1e-10 up to 6; tests/convergence/contact_layer.cpp.
// `top` is that thickness divided by H.
[[nodiscard]] LayerResolution layer_resolution(double greatest_ratio, double top = 1.0);

// p(r) of a sphere divided by its mean F / (pi a^2), so that the mean over the disc is 1:
//   p = sqrt(z) sum_k c_k T_k(2z - 1),   z = 1 - (r/a)^2,   T_k Chebyshev polynomials
// On a half-space it is Hertz's 3/2 sqrt(z).                       docs/theory.md [layer_pressure]
struct PressureProfile {
  // Truncation error below 1e-8 up to a/H = 6, the thinnest layers in a LayerLaw.
  static constexpr std::size_t terms = 20;
  std::array<double, terms> coefficients{};

  [[nodiscard]] double at(double radius_ratio) const;  // r/a; 0 outside the contact
};

// The solution for one contact radius `a` on a layer of thickness H.
struct LayerSolution {
  double ratio = 0.0;  // a / H
  double depth = 1.0;  // D = h R / a^2 of the sphere; 1 on a half-space
  double force = 1.0;  // of the sphere, divided by Hertz's force 4/3 E* a^3 / R for the same radius
  double chi = 0.0;    // sqrt(R h) / H = (a/H) sqrt(D)
  double chi_slope = 1.0;  // d chi / d(a/H)
  double punch = 1.0;      // kappa of a flat punch of this radius: F = 2 a E* h kappa
  PressureProfile pressure;

  [[nodiscard]] double force_factor() const;   // F / F_Hertz at the same depth h
  [[nodiscard]] double radius_factor() const;  // a / sqrt(R h)
};

// The equation below for one ratio a/H, without the layer's `share`, in coordinates in which its
// matrix is tridiagonal, so that a share takes but a few operations per point.
class LayerSystem {
 public:
  // The solution for this `share`, 0 to 1; its pressure is Hertz's unless that was wanted.
  [[nodiscard]] LayerSolution solve(double share) const;

 private:
  friend class LayerEquation;
  double ratio_ = 0.0;
  std::vector<double> diagonal_, beside_;  // of U^T sqrt(w) Q sqrt(w) U
  std::vector<double> right_;              // U^T sqrt(w) and U^T sqrt(w) s^2, by columns
  std::vector<double> sums_;               // rows that a solution is multiplied with, by columns
};

// The integral equation of one layer, prepared for any ratio a/H:
//   g(s) - int_0^1 Q(s,t) g(t) dt = D - s^2,   g(1) = 0,   0 <= s <= 1
// Hayes and others 1972, J. Biomech. 5; docs/theory.md [layer_waves], [layer]. Solved by Nystrom's
// method; one solution takes a quarter of a millisecond at the resolution of a/H = 6.
class LayerEquation {
 public:
  enum class Wanted { force, pressure };  // without the pressure it takes a third of the time

  LayerEquation(const Layer& layer, const LayerResolution& resolution);

  [[nodiscard]] LayerSystem system(double ratio, Wanted wanted) const;  // ratio = a / H >= 0
  [[nodiscard]] LayerSolution solve(double ratio, Wanted wanted = Wanted::pressure) const;
  // F / F_Hertz at chi >= 0, less 1 to 1e-9 of itself; takes about three solutions.
  [[nodiscard]] double force_factor(double chi) const;

 private:
  struct Rule {
    std::vector<double> nodes, weights;
  };
  double share_;
  Rule points_;  // s and t over [0, 1]
  Rule waves_;   // u over [0, 20 H / top]; the weights include 2/pi M(u)
};

// Points u_k of a quadrature int_0^inf share M(u) f(u) du = sum_k missing_k f(u_k).
struct LayerWave {
  double number = 0.0;   // u = xi H
  double missing = 0.0;  // share M(u) times the quadrature weight
};
[[nodiscard]] std::vector<LayerWave> layer_waves(const Layer& layer, int count);

// sum_k c_k T_k(2z - 1) and its derivative by z, for 0 <= z <= 1 and at least one coefficient.
struct ChebyshevSum {
  double value = 0.0, slope = 0.0;
};
[[nodiscard]] ChebyshevSum chebyshev_sum(std::span<const double> coefficients, double z);
// The value alone, with the same bits, in half the time.
[[nodiscard]] double chebyshev_value(std::span<const double> coefficients, double z);

// Chebyshev node i of n, of the first kind: z in (0, 1), in descending order.
[[nodiscard]] double chebyshev_node(std::size_t i, std::size_t n);
// The coefficients of the polynomial with these values at n nodes.
class ChebyshevFit {
 public:
  explicit ChebyshevFit(std::size_t n);
  void operator()(std::span<const double> values, std::span<double> coefficients) const;

 private:
  std::vector<double> cosines_;  // of a whole circle in 4n steps
};

// How much less the surface of a layer sinks than that of a half-space, around a force.
// Under a point force F the surface of a layer of thickness H sinks, at the distance r, by
//   u(r) = F / (pi E') (1/r - Gamma(r/H) / H),   E' = E / (1 - nu^2),
// where 1/r is the half-space's part. Gamma(rho) = int_0^inf M(u) J_0(u rho) du is smooth, is pi/2
// c_1 at 0, and tends to 1/rho far away, where the layer does not sink.
//                                                                    docs/theory.md [layer_surface]
class LayerSurfaceDisplacement {
 public:
  // Tabulates Gamma from 0 to `farthest`: a fifth of a millisecond per unit; for set-up only.
  LayerSurfaceDisplacement(const Layer& layer, double farthest);

  // 0 <= rho <= farthest; error < 1e-7 (several layers: 3e-5).
  [[nodiscard]] double gamma(double rho) const;

 private:
  struct Knot {
    double value, slope;
  };
  struct Table {
    double last_rho;
    int pieces;               // up to last_rho
    std::vector<Knot> knots;  // of those that are needed
  };
  std::vector<Table> tables_;  // for several layers a second one, farther away
};

// chi = sqrt(R h) / H for h (m), the effective radius R (m) and the thickness H (m); 0 for h <= 0.
[[nodiscard]] double layer_chi(double depth, double radius, double thickness);

// The largest chi of a LayerLaw: 3; less for several layers with a top layer much thinner than such
// a contact is wide.
[[nodiscard]] double last_layer_chi(const Layer& layer);

// The equations from which a LayerLaw is made, for a layer with any `share`.
class LayerTable {
 public:
  explicit LayerTable(const Layer& layer);

 private:
  friend class LayerLaw;
  void fill(const Layer& layer);
  [[nodiscard]] double error(const Layer& layer) const;

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
