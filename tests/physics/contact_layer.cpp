// A sphere on a layer: its pressure carries the force and bends the surfaces to fit one another.
#include "contact/layer.h"
#include "layer_at_chi.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace palpate::contact {
namespace {

constexpr double pi = std::numbers::pi;

Layer bonded(double poisson_ratio, double share = 1.0) {
  return {.poisson_ratio = poisson_ratio, .base = LayerBase::bonded, .share = share};
}
constexpr Layer frictionless{.poisson_ratio = 0.4, .base = LayerBase::frictionless};

std::string name(const Layer& layer) {
  return (layer.base == LayerBase::bonded ? "bonded " : "frictionless ") +
         std::to_string(layer.poisson_ratio) + " share " + std::to_string(layer.share);
}

// int over [from, to] by the trapezoidal rule in y, t = from + (to - from) s(y) with s a step whose
// first three derivatives vanish at both ends: it bears roots and logarithms there.
double integral(double from, double to, int points, const std::function<double(double)>& f) {
  double sum = 0.0;
  for (int i = 1; i < points; ++i) {
    const double y = static_cast<double>(i) / points, x = 1.0 - y;
    const double s = y * y * y * y * (35.0 - y * (84.0 - y * (70.0 - 20.0 * y)));
    sum += f(from + (to - from) * s) * 140.0 * x * x * x * y * y * y / points;
  }
  return (to - from) * sum;
}

double mean_pressure(const PressureProfile& profile) {
  return integral(0.0, 1.0, 400, [&](double r) { return 2.0 * r * profile.at(r); });
}

TEST(LayerPressure, AddsUpToTheForce) {
  for (const Layer& layer : {bonded(-0.9), bonded(0.33), bonded(0.5), frictionless,
                             bonded(0.45, 0.97), bonded(0.3, 0.5)}) {
    const LayerLaw law(layer);
    for (const double chi : {0.0, 0.3, 1.0, 3.0})
      EXPECT_NEAR(mean_pressure(law.pressure(chi)), 1.0, 1e-7) << name(layer) << " chi " << chi;
    for (double r = 0.0; r < 0.99; r += 0.01) {  // compression, least at the edge
      EXPECT_GT(law.pressure(2.5).at(r), law.pressure(2.5).at(r + 0.01)) << name(layer) << r;
      EXPECT_GE(law.pressure(2.5).at(r + 0.01), 0.0);
    }
    EXPECT_EQ(law.pressure(1.0).at(1.0), 0.0);
    EXPECT_EQ(law.pressure(1.0).at(1.5), 0.0);
  }
}

double bessel_0(double x) {
  constexpr int points = 64;  // exact to rounding for x < 100
  double sum = 0.0;
  for (int k = 0; k < points; ++k) sum += std::cos(x * std::sin(pi * (k + 0.5) / points));
  return sum / points;
}

// How a half-space of lambda = 1 sinks at r under rings of pressure p(t), t < 1:
// 4/pi int p t K(k)/(r + t) dt, and K(k)/(r + t) is pi/2 over a mean of r + t and |r - t|.
double half_space_surface_displacement(const std::function<double(double)>& p, double r) {
  const auto ring = [&](double t) {
    double a = r + t, g = std::abs(r - t);
    for (int pass = 0; pass < 40 && a - g > 1e-15 * a; ++pass) {
      const double next = 0.5 * (a + g);
      g = std::sqrt(a * g);
      a = next;
    }
    return 2.0 * p(t) * t / a;
  };
  return (r > 0.0 ? integral(0.0, r, 400, ring) : 0.0) + integral(r, 1.0, 400, ring);
}

// L(u) of the layer, as it stands in the books.
double surface_displacement_of_wave(const Layer& layer, double u) {
  if (layer.base == LayerBase::frictionless)
    return (std::cosh(2.0 * u) - 1.0) / (std::sinh(2.0 * u) + 2.0 * u);
  const double k = 3.0 - 4.0 * layer.poisson_ratio;
  return (2.0 * k * std::sinh(2.0 * u) - 4.0 * u) /
         (2.0 * k * std::cosh(2.0 * u) + 1.0 + k * k + 4.0 * u * u);
}

// The pressure bends layer and finger to fit one another all over the contact: the finger sinks
// like a half-space of lambda_1, the layer like one of lambda_2 with its waves lessened by L. This
// takes no step of the way by which the pressure was found. Sizes: a = R = E* = 1.
TEST(LayerPressure, MakesLayerAndFingerFit) {
  for (const Layer& layer : {bonded(0.3), bonded(0.5), frictionless, bonded(0.45, 0.6)}) {
    const double ratio = 1.3;  // a / H
    const double lambda_2 = layer.share, lambda_1 = 1.0 - layer.share;
    const LayerSolution contact = test::solve_layer(ratio, layer);
    const auto p = [&](double r) {
      return 4.0 / 3.0 * contact.force / pi * contact.pressure.at(r);
    };
    const int waves = 320;
    const double last = 18.0;  // 1 - L is 3e-13 there
    std::vector<double> transform(waves + 1);
    for (int k = 1; k <= waves; ++k)
      transform[static_cast<std::size_t>(k)] = integral(0.0, 1.0, 100, [&](double r) {
        return r * p(r) * bessel_0(ratio * last * k / waves * r);
      });
    const double whole = integral(0.0, 1.0, 100, [&](double r) { return r * p(r); });
    for (const double r : {0.0, 0.4, 0.8, 0.97}) {
      // 2 int (1 - L) p^(xi) J_0(xi r) d xi, u = xi H, by Simpson's rule
      double lessened = whole;
      for (int k = 1; k <= waves; ++k) {
        const double u = last * k / waves;
        lessened += (k == waves   ? 1.0
                     : k % 2 == 1 ? 4.0
                                  : 2.0) *
                    (1.0 - surface_displacement_of_wave(layer, u)) *
                    transform[static_cast<std::size_t>(k)] * bessel_0(ratio * u * r);
      }
      lessened *= 2.0 * ratio * last / waves / 3.0;
      const double alike = half_space_surface_displacement(p, r);
      const double sunk = lambda_1 * alike + lambda_2 * (alike - lessened);
      // Simpson's rule is the coarsest part: 2e-7, and a sixteenth with twice the waves.
      EXPECT_NEAR(sunk, contact.depth - 0.5 * r * r, 5e-7) << name(layer) << " r " << r;
    }
  }
}

// In N, m and Pa: a sphere of 11 mm, 1 mm deep in a skin of 10 mm.
TEST(LayerPressure, HasSizes) {
  const LayerContact contact{
      .radius = 0.011, .modulus = 78902.5, .thickness = 0.01, .law = LayerLaw(bonded(0.33))};
  for (const double depth : {1e-6, 1e-3, 0.05}) {
    const double a = contact.contact_radius(depth);
    const PressureProfile profile =
        contact.law.pressure(layer_chi(depth, contact.radius, contact.thickness));
    const double sum =
        integral(0.0, a, 400, [&](double r) { return 2.0 * r / (a * a) * profile.at(r / a); });
    EXPECT_NEAR(sum, 1.0, 1e-7);  // the table's terms; divided by the mean pressure
  }
}

}  // namespace
}  // namespace palpate::contact
