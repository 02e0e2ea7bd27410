// Power laws, and Sneddon's sphere by Newton's method for the contact radius.
#include "fit/tip.h"

#include <array>
#include <cmath>
#include <numbers>

#include "base/index.h"
#include "base/numerics.h"

namespace palpate::fit {
namespace {

// t with t artanh(t) = d. The left side is convex, so that Newton's steps from the right do not
// pass the root: t <= sqrt(d) because artanh(t) >= t, and t <= tanh(d / tanh(d)) because
// artanh(t) >= d.
double relative_radius(double d) {
  return numerics::root(d < 0.5 ? std::sqrt(d) : std::tanh(d / std::tanh(d)), {0.0, 1.0},
                        [&](double t) {
                          const double inverse = std::atanh(t);
                          return numerics::Tangent{t * inverse - d, inverse + t / (1.0 - t * t)};
                        });
}

// (1 + t^2) artanh(t) - t. For small t the terms cancel, and the series
// sum 4k / (4k^2 - 1) t^(2k+1), k = 1, 2, ..., is used.
double sphere_factor(double t) {
  if (t > 0.3) return (1.0 + t * t) * std::atanh(t) - t;
  double power = t * t * t;
  double sum = 0.0;
  for (int k = 1; k < 20; ++k) {
    sum += 4.0 * k / (4.0 * k * k - 1.0) * power;
    power *= t * t;
  }
  return sum;
}

struct Row {
  Tip::Kind kind;
  std::string_view word;
  const char* law;
};

constexpr std::array<Row, 6> tips{{
    {Tip::Kind::paraboloid, "paraboloid",
     "F = 4/3 E/(1-nu^2) sqrt(R) (h-h_0)^(3/2), Hertz 1881, Sneddon 1965"},
    {Tip::Kind::sphere, "sphere",
     "F = E/(1-nu^2) ((a^2+R^2) artanh(a/R) - a R), h-h_0 = a artanh(a/R), Sneddon 1965"},
    {Tip::Kind::cone, "cone", "F = 2/pi E/(1-nu^2) tan(alpha) (h-h_0)^2, Sneddon 1965"},
    {Tip::Kind::pyramid_3, "pyramid3", "F = 0.8887 E/(1-nu^2) tan(alpha) (h-h_0)^2, Bilodeau 1992"},
    {Tip::Kind::pyramid_4, "pyramid4", "F = 0.7453 E/(1-nu^2) tan(alpha) (h-h_0)^2, Bilodeau 1992"},
    {Tip::Kind::flat_punch, "punch", "F = 2 E/(1-nu^2) R (h-h_0), Sneddon 1965"},
}};

}  // namespace

TipForce tip_force(const Tip& tip, double depth) {
  if (!(depth > 0.0)) return {0.0, 0.0};
  const double radius = tip.radius;
  const auto square = [&](double factor) {
    const double slope = factor * std::tan(tip.half_angle);
    return TipForce{slope * depth * depth, 2.0 * slope * depth};
  };
  switch (tip.kind) {
    case Tip::Kind::paraboloid: {
      const double root = std::sqrt(radius * depth);
      return {4.0 / 3.0 * root * depth, 2.0 * root};
    }
    case Tip::Kind::sphere: {
      const double t = relative_radius(depth / radius);
      return {radius * radius * sphere_factor(t), 2.0 * radius * t};
    }
    case Tip::Kind::cone: return square(2.0 / std::numbers::pi);
    case Tip::Kind::pyramid_3: return square(0.8887);
    case Tip::Kind::pyramid_4: return square(0.7453);
    case Tip::Kind::flat_punch: return {2.0 * radius * depth, 2.0 * radius};
  }
  return {0.0, 0.0};
}

double error_of_hertz(double depth, double radius) {
  const Tip paraboloid{Tip::Kind::paraboloid, radius, 0.0};
  const Tip sphere{Tip::Kind::sphere, radius, 0.0};
  return tip_force(paraboloid, depth).force / tip_force(sphere, depth).force - 1.0;
}

std::string_view word(Tip::Kind kind) { return tips[as_index(kind)].word; }

std::optional<Tip::Kind> find_tip(std::string_view word) {
  for (const Row& row : tips)
    if (row.word == word) return row.kind;
  return std::nullopt;
}

std::string law_text(Tip::Kind kind) { return tips[as_index(kind)].law; }

}  // namespace palpate::fit
