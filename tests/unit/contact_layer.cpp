// The layer of finite thickness: independent numbers, its table against its equation, its ends.
#include "contact/layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "contact/hertz.h"
#include "layer_at_chi.h"

namespace palpate::contact {
namespace {

constexpr double last_chi = 3.0;  // of one layer

constexpr double pi = std::numbers::pi;

Layer bonded(double poisson_ratio, double share = 1.0) {
  return {.poisson_ratio = poisson_ratio, .base = LayerBase::bonded, .share = share};
}
Layer frictionless(double share = 1.0) {
  return {.poisson_ratio = 0.4, .base = LayerBase::frictionless, .share = share};
}

std::string name(const Layer& layer) {
  return (layer.base == LayerBase::bonded ? "bonded " : "frictionless ") +
         std::to_string(layer.poisson_ratio) + " share " + std::to_string(layer.share);
}

const std::vector<Layer>& layers() {
  static const std::vector<Layer> list{bonded(-0.9),     bonded(0.0),        bonded(0.33),
                                       bonded(0.4999),   bonded(0.5),        frictionless(),
                                       bonded(0.3, 0.5), bonded(0.45, 0.97), frictionless(0.2)};
  return list;
}

// A printed value with eight digits: half a unit of the eighth is its own.
void expect_case(const std::string& id, double got, double value, double rel_tol) {
  const double printed = 0.5 * std::pow(10.0, std::floor(std::log10(std::abs(value))) - 7.0);
  EXPECT_NEAR(got, value, rel_tol * std::abs(value) + printed) << id;
}

// F / F_Hertz by the law and by the equation itself.
void expect_factor(const std::string& id, const Layer& layer, double chi, double value) {
  expect_case(id, LayerLaw(layer).force_factor(chi), value, 1e-5);
  const LayerEquation equation(layer, layer_resolution(2.0 * chi));
  expect_case(id, test::layer_at_chi(equation, chi).force_factor(), value, 1e-5);
}

// R = 11 mm, h = 1 mm, H = 10 mm: 0.33166, printed as 0.3317
const double thin_chi = layer_chi(1e-3, 0.011, 0.01);

TEST(LayerCases, FlatPunchOnABondedLayer) {
  const auto kappa = [](double ratio, double nu) {
    return test::flat_punch_factor(ratio, bonded(nu));
  };
  expect_case("hayes-01", kappa(0.2, 0.3), 1.2065582, 1e-5);
  expect_case("hayes-03", kappa(0.6, 0.3), 1.7847538, 1e-5);
  expect_case("hayes-05", kappa(2.0, 0.3), 4.3532443, 1e-5);
  expect_case("hayes-06", kappa(0.2, 0.5), 1.2806366, 1e-5);
  expect_case("hayes-09", kappa(1.0, 0.5), 3.6187358, 1e-5);
  // The other ratios of Hayes 1972, to the digits known: half a unit of the last.
  EXPECT_NEAR(kappa(0.4, 0.3), 1.4726, 5e-5);
  EXPECT_NEAR(kappa(1.0, 0.3), 2.4835, 5e-5);
  EXPECT_NEAR(kappa(3.0, 0.3), 6.261, 5e-4);
  EXPECT_NEAR(kappa(0.6, 0.5), 2.2129, 5e-5);
  EXPECT_NEAR(kappa(1.5, 0.5), 6.003, 5e-4);
  EXPECT_NEAR(kappa(3.0, 0.5), 18.157, 5e-4);
}

TEST(LayerCases, Sphere) {
  expect_factor("layer-05", bonded(0.5), 0.2, 1.2979456);
  expect_factor("layer-08", frictionless(), 0.2, 1.1770945);
  expect_factor("layer-09", bonded(0.5), thin_chi, 1.6005704);
  expect_factor("layer-12", frictionless(), thin_chi, 1.3288264);
  expect_factor("layer-13", bonded(0.5), 0.5, 2.156215);
  expect_factor("layer-17", bonded(0.5), 0.75, 3.3832332);
  expect_factor("layer-24", frictionless(), 1.0, 2.5045031);
  expect_factor("layer-25, skin", bonded(0.33), thin_chi, 1.4231705);
  expect_factor("layer-27, ligament", bonded(0.45), thin_chi, 1.5229834);
  expect_factor("layer-28, upper leg", bonded(0.3), thin_chi, 1.4083241);
}

TEST(LayerCases, FirstCoefficient) {
  expect_case("layer-29", test::layer_first_coefficient(bonded(0.27)), 0.85749745, 1e-6);
  expect_case("layer-30", test::layer_first_coefficient(bonded(0.30)), 0.87653259, 1e-6);
  expect_case("layer-31", test::layer_first_coefficient(bonded(0.33)), 0.89876047, 1e-6);
  expect_case("layer-34", test::layer_first_coefficient(bonded(0.5)), 1.126955, 1e-6);
  // Five printed digits.
  EXPECT_NEAR(test::layer_first_coefficient(frictionless()), 0.74330, 5e-6);
}

// An axisymmetric finite-element program at a/H = 1/2: 1.591, 1.857 (at nu = 0.4999, as near as it
// goes to 1/2) and 1.4815. Its own error is 1e-4, and half a unit of the last printed digit.
TEST(LayerCases, FiniteElements) {
  EXPECT_NEAR(test::solve_layer(0.5, bonded(0.3)).force_factor(), 1.591, 1.6e-4 + 5e-4);
  EXPECT_NEAR(test::solve_layer(0.5, bonded(0.4999)).force_factor(), 1.857, 1.9e-4 + 5e-4);
  EXPECT_NEAR(test::solve_layer(0.5, frictionless()).force_factor(), 1.4815, 1.5e-4 + 5e-5);
  // The same three by an integral equation solved elsewhere, to four digits.
  EXPECT_NEAR(test::solve_layer(0.5, bonded(0.3)).force_factor(), 1.5909, 5e-5);
  EXPECT_NEAR(test::solve_layer(0.5, bonded(0.4999)).force_factor(), 1.8569, 5e-5);
  EXPECT_NEAR(test::solve_layer(0.5, frictionless()).force_factor(), 1.4816, 5e-5);
}

double polynomial(const std::vector<double>& coefficients, double x) {
  double sum = 0.0;
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) sum = sum * x + *c;
  return sum;
}

// Garcia and Garcia 2018, bonded, nu = 1/2: close below chi = 0.5, not beyond.
TEST(LayerCases, PublishedPolynomialOfGarcia) {
  const LayerLaw law(bonded(0.5));
  const auto error = [&](double chi) {
    return polynomial({1.0, 1.133, 1.497, 1.469, 0.755}, chi) / law.force_factor(chi) - 1.0;
  };
  expect_case("layer-07", error(0.2), 0.001151392, 1e-3);
  expect_case("layer-11", error(thin_chi), 0.0016257136, 1e-3);
  expect_case("layer-19", error(0.75), 0.049420299, 1e-3);
  expect_case("layer-23", error(1.0), 0.14439341, 1e-3);
}

// Dimitriadis and others 2002; the deviations are known to the digits of the tolerances.
TEST(LayerCases, PublishedPolynomialsOfDimitriadis) {
  const auto error = [](const LayerLaw& law, double a0, double b0, double chi) {
    const double x = 2.0 * a0 * chi / pi;
    const double c3 = 8.0 / (pi * pi * pi) * (a0 * a0 * a0 + 4.0 * pi * pi / 15.0 * b0);
    const double c4 = 16.0 * a0 / (pi * pi * pi * pi) * (a0 * a0 * a0 + 0.6 * pi * pi * b0);
    return (1.0 - x + x * x - c3 * chi * chi * chi + c4 * chi * chi * chi * chi) /
               law.force_factor(chi) -
           1.0;
  };
  // The general formula at nu = 1/2 has its last term's sign the wrong way round: the special one
  // is printed with + 0.0975.
  const LayerLaw fixed(bonded(0.5));
  const std::vector<double> printed{1.0, 1.133, 1.283, 0.769, 0.0975};
  EXPECT_NEAR(polynomial(printed, 0.2) / fixed.force_factor(0.2) - 1.0, -0.011, 0.0005);
  EXPECT_NEAR(polynomial(printed, 0.5) / fixed.force_factor(0.5) - 1.0, -0.077, 0.0005);
  EXPECT_NEAR(polynomial(printed, 1.0) / fixed.force_factor(1.0) - 1.0, -0.16, 0.005);
  // "Unbonded", nu = 1/2: not a frictionless base.
  const LayerLaw sliding(frictionless());
  const double a0 = -0.347 * 2.0 / 0.5, b0 = 0.056 * 4.0 / 0.5;
  EXPECT_NEAR(error(sliding, a0, b0, 0.1), 0.014, 0.0005);
  EXPECT_NEAR(error(sliding, a0, b0, 0.44), 0.066, 0.001);
  EXPECT_NEAR(error(sliding, a0, b0, 0.82), 0.15, 0.005);
}

// Quintics fitted elsewhere to the same exact solution, with their largest errors, which hold up to
// chi = 0.99: at 1 the quintics leave the solution quickly and are off by up to 0.2 %.
TEST(LayerCases, FittedQuintics) {
  struct Fit {
    Layer layer;
    std::vector<double> coefficients;
    double error;
  };
  const std::vector<Fit> fits{
      {bonded(0.27), {1, 0.85750, 0.85785, 0.7175, -0.7240, 0.1235}, 0.0007},
      {bonded(0.33), {1, 0.89876, 0.94240, 0.8592, -0.7737, 0.0983}, 0.0009},
      {bonded(0.40), {1, 0.96684, 1.09058, 1.1089, -0.7117, -0.0302}, 0.0013},
      {bonded(0.45), {1, 1.03481, 1.24930, 1.3779, -0.4466, -0.2481}, 0.0016},
      {bonded(0.50), {1, 1.12695, 1.48170, 1.7394, 0.3674, -0.6104}, 0.0018},
      {frictionless(), {1, 0.74330, 0.64458, 0.4253, -0.3052, -0.0048}, 0.0005}};
  for (const Fit& fit : fits) {
    const LayerLaw law(fit.layer);
    for (int i = 1; i < 20; ++i) {
      const double chi = 0.05 * i;
      EXPECT_NEAR(polynomial(fit.coefficients, chi) / law.force_factor(chi), 1.0,
                  fit.error + 5e-5)  // the errors are printed to 0.01 %
          << name(fit.layer) << " chi " << chi;
    }
  }
}

TEST(LayerLaw, IsHertzOnAHalfSpace) {
  for (const Layer& layer : layers()) {
    const LayerLaw law(layer);
    EXPECT_EQ(law.force_factor(0.0), 1.0);
    EXPECT_EQ(law.radius_factor(0.0), 1.0);
    EXPECT_EQ(law.stiffness_factor(0.0), 1.0);
    // To rounding: twenty terms of 1.5 at most.
    for (const double r : {0.0, 0.3, 0.9, 1.0})
      EXPECT_NEAR(law.pressure(0.0).at(r), 1.5 * std::sqrt(1.0 - r * r), 1e-15);
  }
  // A tissue without compliance of its own: the finger alone, at any chi.
  const LayerLaw finger(bonded(0.5, 0.0));
  EXPECT_NEAR(finger.force_factor(2.0), 1.0, 1e-13);  // rounding of the solutions
  EXPECT_NEAR(finger.radius_factor(2.0), 1.0, 1e-13);
  EXPECT_NEAR(finger.pressure(2.0).at(0.6), 1.2, 1e-13);
}

// f = 1 + c1 chi + 7/6 c1^2 chi^2 + ...
TEST(LayerLaw, StartsWithItsSeries) {
  for (const Layer& layer : layers()) {
    const double c1 = test::layer_first_coefficient(layer);
    const LayerLaw law(layer);
    // f + chi/3 df/dchi = 1 + 4/3 c1 chi + ...
    EXPECT_NEAR((law.stiffness_factor(1e-6) - 1.0) / 1e-6, 4.0 / 3.0 * c1, 1e-5 * c1)
        << name(layer);
    // c2 + c3 chi + c4 chi^2 through three points, at chi = 0. What is left is c5 times the
    // product of the three, 8e-6, and c5 is less than c1.
    const LayerEquation equation(layer, layer_resolution(0.1));
    const auto rest = [&](double chi) {
      return (test::layer_at_chi(equation, chi).force_factor() - 1.0 - c1 * chi) / (chi * chi);
    };
    const double c2 = (8.0 * rest(0.01) - 6.0 * rest(0.02) + rest(0.04)) / 3.0;
    EXPECT_NEAR(c2, 7.0 / 6.0 * c1 * c1, 8e-6 * c1) << name(layer);
  }
}

// Against the equation at a finer resolution and between the nodes of the table.
TEST(LayerLaw, FollowsTheEquation) {
  for (const Layer& layer : layers()) {
    const LayerLaw law(layer);
    const LayerEquation equation(layer, {.points = 48, .waves = 128});
    for (const double chi : {1e-3, 0.03, 0.07, 0.2, 0.41, 0.77, 1.1, 1.6, 2.05, 2.6, 2.97, 3.0}) {
      const LayerSolution exact = test::layer_at_chi(equation, chi);
      const std::string where = name(layer) + " chi " + std::to_string(chi);
      EXPECT_NEAR(exact.chi, chi, 1e-13 * chi) << where;  // Newton's method to rounding
      EXPECT_NEAR((equation.force_factor(chi) - 1.0) / (exact.force_factor() - 1.0), 1.0, 1e-9)
          << where;
      // 1e-8 measured, 1e-7 promised
      EXPECT_NEAR(law.force_factor(chi) / exact.force_factor(), 1.0, 1e-7) << where;
      EXPECT_NEAR(law.radius_factor(chi) / exact.radius_factor(), 1.0, 1e-7) << where;
      // dF/dh = 2 E* a kappa: to press on is to press with a flat punch of the contact's size.
      // A table's slope is a digit worse than its values.
      EXPECT_NEAR(law.stiffness_factor(chi) / (exact.radius_factor() * exact.punch), 1.0, 1e-6)
          << where;
      const PressureProfile profile = law.pressure(chi);
      for (const double r : {0.0, 0.5, 0.9, 0.99})
        EXPECT_NEAR(profile.at(r), exact.pressure.at(r), 2e-7) << where;  // 20 terms of 1e-8
    }
  }
}

TEST(LayerLaw, GrowsSmoothly) {
  for (const Layer& layer : layers()) {
    const LayerLaw law(layer);
    constexpr double step = 1e-3;
    for (double chi = step; chi < last_chi - step; chi += step) {
      const double before = law.force_factor(chi - step), here = law.force_factor(chi),
                   after = law.force_factor(chi + step);
      ASSERT_LT(before, here) << name(layer) << " chi " << chi;
      // The contact widens. Under an elastic finger a / sqrt(R h) need not: on the thinnest layers
      // the finger's half-space alone is soft, and the ratio goes back to 1.
      ASSERT_LT((chi - step) * law.radius_factor(chi - step), chi * law.radius_factor(chi));
      ASSERT_GE(law.radius_factor(chi), 1.0) << name(layer) << " chi " << chi;
      // Central difference: step^2 / 6 of the third derivative, which is below 60 f.
      const double slope = 3.0 / chi * (law.stiffness_factor(chi) - here);
      ASSERT_NEAR((after - before) / (2.0 * step), slope, 1e-5 * here);
      ASSERT_GT(law.stiffness_factor(chi), here) << name(layer) << " chi " << chi;
    }
    EXPECT_TRUE(std::isfinite(law.force_factor(last_chi)));
  }
}

TEST(LayerLaw, AFirmerBaseIsStiffer) {
  for (const double chi : {0.1, 1.0, 3.0}) {
    EXPECT_LT(LayerLaw(frictionless()).force_factor(chi), LayerLaw(bonded(0.0)).force_factor(chi));
    EXPECT_LT(LayerLaw(bonded(0.3)).force_factor(chi), LayerLaw(bonded(0.45)).force_factor(chi));
    EXPECT_LT(LayerLaw(bonded(0.3, 0.5)).force_factor(chi),
              LayerLaw(bonded(0.3)).force_factor(chi));
    const Layer other{.poisson_ratio = -0.5, .base = LayerBase::frictionless};
    EXPECT_EQ(LayerLaw(other).force_factor(chi), LayerLaw(frictionless()).force_factor(chi));
  }
}

TEST(LayerLaw, KnowsNothingBeyondItsTable) {
  const LayerLaw law(bonded(0.5));
  for (const double chi : {last_chi * (1.0 + 1e-15), 10.0, -1e-9, std::nan("")}) {
    EXPECT_TRUE(std::isnan(law.force_factor(chi)));
    EXPECT_TRUE(std::isnan(law.stiffness_factor(chi)));
    EXPECT_TRUE(std::isnan(law.radius_factor(chi)));
    EXPECT_TRUE(std::isnan(law.pressure(chi).at(0.5)));
  }
}

constexpr double radius = 0.011, layer_modulus = 78902.5, thickness = 0.01;  // m, Pa, m

TEST(LayerContact, HasSizes) {
  const LayerContact contact{radius, layer_modulus, thickness, LayerLaw(bonded(0.33))};
  for (const double depth : {1e-6, 1e-3, 0.01, 0.08}) {
    const double chi = std::sqrt(radius * depth) / thickness;
    const double force = contact.force(depth);
    EXPECT_DOUBLE_EQ(force,
                     hertz::force(depth, radius, layer_modulus) * contact.law.force_factor(chi));
    const double a = contact.contact_radius(depth);
    EXPECT_DOUBLE_EQ(a, std::sqrt(radius * depth) * contact.law.radius_factor(chi));
    const double step = 1e-4 * depth;
    // Central difference: its error is about 1e-8 of the stiffness.
    EXPECT_NEAR((contact.force(depth + step) - contact.force(depth - step)) / (2.0 * step),
                contact.stiffness(depth), 1e-7 * contact.stiffness(depth));
    // dF/dh = 2 E* a kappa; 1e-6 of a table's slope
    EXPECT_NEAR(2.0 * layer_modulus * a * test::flat_punch_factor(a / thickness, bonded(0.33)),
                contact.stiffness(depth), 1e-6 * contact.stiffness(depth));
  }
}

TEST(LayerContact, EndsOnBothSides) {
  const LayerContact contact{radius, layer_modulus, thickness, LayerLaw(bonded(0.5))};
  for (const double none : {0.0, -1e-3}) {
    EXPECT_EQ(contact.force(none), 0.0);
    EXPECT_EQ(contact.stiffness(none), 0.0);
    EXPECT_EQ(contact.contact_radius(none), 0.0);
  }
  const double last = contact.last_depth();
  EXPECT_DOUBLE_EQ(layer_chi(last, radius, thickness), last_chi);
  EXPECT_TRUE(std::isfinite(contact.force(0.999999 * last)));
  EXPECT_TRUE(std::isnan(contact.force(1.000001 * last)));
  EXPECT_TRUE(std::isnan(contact.stiffness(1.000001 * last)));
}

}  // namespace
}  // namespace palpate::contact
