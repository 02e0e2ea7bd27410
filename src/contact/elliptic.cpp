// Computes the contact ellipse from elliptic integrals, by arithmetic-geometric means.
#include "contact/elliptic.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/numerics.h"
#include "contact/hertz.h"

namespace palpate::contact {
namespace {

// Complete elliptic integrals K and E of the parameter m = 1 - q^2, written without differences of
// nearly equal numbers for circles and for line contact:
//   mean = pi / (2 K),   t = (K - E) / (m K) - 1/2,   slope = t / m
struct Integrals {
  double mean = 1.0;
  double t = 0.0;
  double slope = 1.0 / 16.0;
};

// For 0 < q <= 1. Abramowitz and Stegun 1964, 17.6: with a_0 = 1, g_0 = q and
// c_n = (a_(n-1) - g_(n-1)) / 2,   (K - E)/K = m/2 + sum over n > 0 of 2^(n-1) c_n^2.
Integrals integrals(double q) {
  double a = 0.5 * (1.0 + q);
  double g = std::sqrt(q);
  // c_1^2 / m^2 = 1 / (4 (1 + q)^2), and c_(n+1) = c_n^2 / (4 a_(n+1)).
  const double m = (1.0 - q) * (1.0 + q);
  double c = 0.5 * (1.0 - q);
  double part = 0.25 / ((1.0 + q) * (1.0 + q));  // 2^(n-1) c_n^2 / m^2
  double sum = part;
  for (int n = 0; n < 20; ++n) {
    const double next_a = 0.5 * (a + g);
    g = std::sqrt(a * g);
    a = next_a;
    const double shrink = c / (4.0 * a);  // c_(n+1) / c_n
    part *= 2.0 * shrink * shrink;
    c *= shrink;
    sum += part;
    if (part < 1e-17 * sum) break;
  }
  return {.mean = a, .t = m * sum, .slope = sum};
}

// The ratio q = b/a of the axes for r = B/A >= 1, the ratio of the relative curvatures:
//   q^2 r (1/2 + t) = 1/2 - t                                          docs/theory.md [axes]
double axis_ratio(double r) {
  // d(ln r)/d(ln q) goes from -3/2 at the circle to -2, so q is between r^(-2/3) and r^(-1/2), and
  // a fortiori above 1/(2 r).
  const double most = 1.0 / std::sqrt(r);
  return numerics::root(most, {0.5 * most * most, most}, [&](double q) {
    const auto [mean, t, slope] = integrals(q);
    const double u = 0.5 - t;
    // q du/dq = u^2 - 2 q^2 t / m
    const double du = u * u - 2.0 * q * q * slope;
    return numerics::Tangent{q * q * r * (1.0 - u) - u,
                             (2.0 * q * q * r * (1.0 - u) - q * q * r * du - du) / q};
  });
}

}  // namespace

std::optional<EllipticLaw> elliptic_law(double sphere_radius, double kappa_1, double kappa_2) {
  const double least = 1.0 / sphere_radius + std::min(kappa_1, kappa_2);     // 2 A
  const double greatest = 1.0 / sphere_radius + std::max(kappa_1, kappa_2);  // 2 B
  const bool finite = std::isfinite(kappa_1 + kappa_2) && std::isfinite(greatest / least);
  if (!finite || least <= 0.0) return std::nullopt;
  const double q = axis_ratio(greatest / least);
  const auto [mean, t, slope] = integrals(q);
  // a^2 / h = (1/2 + t) / A = (1 + 2 t) / (2 A)                     docs/theory.md [ellipse]
  // F = (2 pi / 3) E* a h / K                                  docs/theory.md [ellipse_force]
  const double along_radius = (1.0 + 2.0 * t) / least;
  return EllipticLaw{
      .force_radius = mean * mean * along_radius, .along_radius = along_radius, .axis_ratio = q};
}

bool nearly_conforming(double sphere_radius, double kappa_1, double kappa_2) {
  return std::min(kappa_1, kappa_2) < -0.5 / sphere_radius;
}

double mean_radius(double sphere_radius, double kappa_1, double kappa_2) {
  return hertz::effective_radius(sphere_radius, 0.5 * (kappa_1 + kappa_2));
}

double geometric_radius(double sphere_radius, double kappa_1, double kappa_2) {
  return std::sqrt(hertz::effective_radius(sphere_radius, kappa_1) *
                   hertz::effective_radius(sphere_radius, kappa_2));
}

}  // namespace palpate::contact
