// Moduli of uniaxial tests whose truth is known.
#include "fit/uniaxial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "contact/platens.h"
#include "refusal.h"

namespace palpate::fit {
namespace {

using Loading = UniaxialTest::Loading;
using Model = UniaxialTest::Model;

constexpr double specimen_young = 14.7e3;  // Pa

struct StressCurve {
  std::vector<double> strain, stress;
};
StressCurve curve_of(double sign, double most, const std::function<double(double)>& nominal) {
  StressCurve curve;
  for (int i = 0; i <= 80; ++i) {
    const double strain = most * i / 80.0;
    curve.strain.push_back(strain);
    curve.stress.push_back(sign * nominal(1.0 + sign * strain));
  }
  return curve;
}
double neo(double stretch) { return specimen_young / 3.0 * (stretch - 1.0 / (stretch * stretch)); }
double ogden(double stretch, double alpha) {
  return 2.0 * specimen_young / (3.0 * alpha) *
         (std::pow(stretch, alpha - 1.0) - std::pow(stretch, -0.5 * alpha - 1.0));
}
Fit fit_of(const StressCurve& curve, const UniaxialTest& test) {
  return fit_uniaxial(curve.strain, curve.stress, test);
}
std::string refusal(const StressCurve& curve, const UniaxialTest& test) {
  return test::refusal([&] { return fit_of(curve, test); });
}

TEST(Uniaxial, NeoHookeanAndOgdenExactly) {
  for (const auto& [loading, sign] :
       {std::pair{Loading::compression, -1.0}, std::pair{Loading::tension, 1.0}}) {
    Fit fit = fit_of(curve_of(sign, 0.5, neo), {.model = Model::neo_hookean, .loading = loading});
    EXPECT_NEAR(fit.parameters[0].estimate, 14.7, 1e-9 * 14.7);  // exact data
    for (const double alpha : {-6.3, 1.5, 2.0, 9.1}) {
      const StressCurve curve = curve_of(sign, 0.5, [&](double l) { return ogden(l, alpha); });
      fit = fit_of(curve, {.model = Model::ogden, .loading = loading});
      EXPECT_NEAR(fit.parameters[0].estimate, 14.7, 1e-9 * 14.7) << alpha;  // exact data
      EXPECT_NEAR(fit.parameters[1].estimate, alpha, 1e-8) << alpha;        // likewise
    }
  }
}

// Ogden's law with alpha = 2 is the neo-Hookean one.
TEST(Uniaxial, SignsAreTurnedTogether) {
  StressCurve curve = curve_of(-1.0, 0.4, neo);
  for (double& each : curve.strain) each = -each;
  for (double& each : curve.stress) each = -each;
  const Fit fit = fit_of(curve, {.model = Model::ogden});
  EXPECT_NEAR(fit.parameters[0].estimate, 14.7, 1e-9 * 14.7);  // exact data
  EXPECT_NEAR(fit.parameters[1].estimate, 2.0, 1e-8);          // likewise
  ASSERT_EQ(fit.notes.size(), 1U);
  EXPECT_EQ(fit.notes[0], "strain and stress are negative in compression; both signs changed");
}

TEST(Uniaxial, ModulusOverARange) {
  // sigma = 200 + 1000 e + 5000 e^2 Pa: over 0.1 to 0.3 the line has the slope 1000 + 5000 * 0.4.
  StressCurve curve;
  for (int i = 0; i <= 100; ++i) {
    const double e = 0.005 * i;
    curve.strain.push_back(e);
    curve.stress.push_back(200.0 + 1000.0 * e + 5000.0 * e * e);
  }
  const Fit fit = fit_of(curve, {.from = 0.1, .to = 0.3});
  EXPECT_NEAR(fit.parameters[0].estimate, 3.0, 1e-9);  // kPa, exact for even spacing
  EXPECT_EQ(fit.parameters[2].name, "E_secant");
  EXPECT_NEAR(fit.parameters[2].estimate, 2.5, 1e-9);  // 1000 + 5000 * 0.3 Pa, a parabola exactly
  EXPECT_EQ(fit.n, 41);
  EXPECT_EQ(fit.excluded, 60);
}

// Diameter 20 mm, height 10 mm: S = 1/2 and 1 + 2 S^2 = 1.5.
TEST(Uniaxial, BondedPlatens) {
  EXPECT_EQ(contact::bonded_stiffening(0.5), 1.5);
  StressCurve curve;
  for (int i = 0; i <= 20; ++i) {
    curve.strain.push_back(0.002 * i);
    curve.stress.push_back(1.5 * specimen_young * curve.strain.back());
  }
  const Fit fit = fit_of(curve, {.shape_factor = 0.5});
  EXPECT_NEAR(fit.parameters[0].estimate, 14.7, 1e-9 * 14.7);  // exact data
  EXPECT_NE(fit.law.find("Gent and Lindley 1959"), std::string::npos);
  // 1 + 1 / (1/(2 S^2) + 1/(M/E - 1)), M/E = (1 - nu) / ((1 + nu) (1 - 2 nu)): 1.424 at nu 0.45,
  // 1.205 at 0.3.
  ASSERT_EQ(fit.warnings.size(), 1U);
  EXPECT_NE(
      fit.warnings[0].find("at nu = 0.45 the modulus would be 5.3 % higher, at nu = 0.3 25 %;"),
      std::string::npos)
      << fit.warnings[0];
}

// A flat disc whose tissue can be compressed is stiffened by less than its modulus of uniaxial
// strain over E, whatever its shape.
TEST(Uniaxial, BondedPlatensOfCompressibleTissue) {
  const double confined = 0.7 / (1.3 * 0.4);                            // of nu 0.3
  EXPECT_NEAR(contact::bonded_stiffening(100.0, 0.3), confined, 1e-4);  // 1 / (2 S^2)
  EXPECT_EQ(contact::bonded_stiffening(0.5, 0.5), 1.5);
  EXPECT_EQ(contact::bonded_stiffening(0.5, 0.0), 1.0) << "it does not widen";
  StressCurve curve;
  const double factor = 1.0 + 1.0 / (1.0 / 2.0 + 1.0 / (confined - 1.0));  // S = 1
  for (int i = 0; i <= 20; ++i) {
    curve.strain.push_back(0.002 * i);
    curve.stress.push_back(factor * specimen_young * curve.strain.back());
  }
  const Fit fit = fit_of(curve, {.shape_factor = 1.0, .poisson_ratio = 0.3});
  EXPECT_NEAR(fit.parameters[0].estimate, 14.7, 1e-9 * 14.7);  // exact data
  EXPECT_TRUE(fit.warnings.empty());
  EXPECT_NE(fit.law.find("for nu = 0.3"), std::string::npos) << fit.law;
}

TEST(Uniaxial, Refusals) {
  const StressCurve curve = curve_of(-1.0, 0.4, neo);
  EXPECT_EQ(refusal(curve, {.model = Model::neo_hookean}),
            "the model `neo_hookean` differs between compression and tension, and both columns are "
            "positive; give `--loading compression` or `--loading tension`");
  EXPECT_EQ(refusal(curve, {.from = 0.1, .to = 0.11}),
            "the model `modulus` needs at least 4 points, and 3 are usable; widen `--from` and "
            "`--to`, or record more points");
  StressCurve turned = curve;
  for (double& each : turned.stress) each = -each;
  EXPECT_TRUE(refusal(turned, {}).starts_with("the stress falls as the strain grows"));
  StressCurve percent = curve;
  for (double& each : percent.strain) each *= 100.0;
  EXPECT_TRUE(refusal(percent, {.model = Model::neo_hookean, .loading = Loading::compression})
                  .starts_with("a strain of "));
}

}  // namespace
}  // namespace palpate::fit
