// The closed forms of Hertz contact; the ellipse by arithmetic-geometric means.
#include "contact/hertz.h"

#include <algorithm>

#include "base/numerics.h"

namespace palpate::contact {

double Elastic::compliance() const { return (1.0 - poisson_ratio * poisson_ratio) / young_modulus; }

namespace hertz {

double effective_modulus(double compliance_1, double compliance_2) {
  return 1.0 / (compliance_1 + compliance_2);
}

double effective_radius(double sphere_radius, double curvature) {
  return 1.0 / (1.0 / sphere_radius + curvature);
}

double force(double depth, double radius, double modulus) {
  if (depth <= 0.0) return 0.0;
  // F = 4/3 E* sqrt(R) h^(3/2)                   Chen 2007 eq. (2); docs/theory.md [hertz]
  return 4.0 / 3.0 * modulus * std::sqrt(radius) * depth * std::sqrt(depth);
}

double depth(double force, double radius, double modulus) {
  if (force <= 0.0) return 0.0;
  // h = (3 F / (4 E* sqrt(R)))^(2/3); not used in solver steps, so cbrt is allowed
  const double root = std::cbrt(0.75 * force / (modulus * std::sqrt(radius)));
  return root * root;
}

double stiffness(double depth, double radius, double modulus) {
  if (depth <= 0.0) return 0.0;
  return 2.0 * modulus * std::sqrt(radius * depth);
}

double contact_radius(double depth, double radius) {
  return depth > 0.0 ? std::sqrt(radius * depth) : 0.0;
}

double peak_pressure(double force, double contact_radius) {
  if (contact_radius <= 0.0) return 0.0;
  // P_0 = 3 F / (2 pi a^2)                    Chen 2007 eq. (3); docs/theory.md [pressure]
  return 1.5 * force / (std::numbers::pi * contact_radius * contact_radius);
}

}  // namespace hertz

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
