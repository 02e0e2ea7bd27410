// Formulas of stability limits: against independent numbers, against each other, against roots.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>

#include "cases.h"
#include "stability/measure.h"

namespace palpate::stability {
namespace {

using tissue::Viscosity;
using tissue::ViscousLaw;

// m = 0.01 kg on k = 100 N/m: omega = 100/s. Drag of 100/s is zeta = 0.5.
constexpr double omega = 100.0;
const ViscousLaw drag{.kind = Viscosity::nodal_drag, .drag = 100.0};

TEST(LimitTheory, OfTheBrief) {
  test::expect_case("dt-03", *limit_theory(lagged, omega, drag));
  test::expect_case("dt-04", *limit_theory({Integrator::semi_implicit_euler}, omega, drag));
  EXPECT_NEAR(*limit_theory({Integrator::central_difference}, omega, drag), 0.02,
              1e-15);  // 2 / omega
  EXPECT_NEAR(damping_ratio(omega, drag), 0.5, 1e-15);
}

TEST(LimitTheory, KelvinVoigt) {
  const double tau = 0.1;
  const ViscousLaw law{.kind = Viscosity::kelvin_voigt, .time = tau};
  const double root = std::sqrt(tau * tau + 4.0 / (omega * omega));
  EXPECT_NEAR(*limit_theory(lagged, omega, law), root - tau, 1e-15);  // rounding
  EXPECT_NEAR(*limit_theory({Integrator::semi_implicit_euler}, omega, law), root + tau, 1e-15);
  EXPECT_NEAR(*limit_theory({Integrator::central_difference}, omega, law), 0.02, 1e-15);
  EXPECT_NEAR(1e3 * *limit_theory(lagged, omega, law), 1.98, 0.001);  // the brief's digits, ms
}

TEST(LimitTheory, MethodsWithoutALimit) {
  for (const Method& method : methods())
    EXPECT_EQ(limit_theory(method, omega, drag).has_value(), method.explicit_steps())
        << method.name();
}

// Central differences of one mode with one branch, memory exact for a linear course: the matrix
// from (u, u_before, q) to the next; its spectral radius is 1 at the limit.
double spectral_radius(double ratio, double x, double omega_step) {
  const double keep = std::exp(-x);
  const double mean = (1.0 - keep) / x;
  const double w2 = omega_step * omega_step;
  Eigen::Matrix3d step;
  step.row(0) << 2.0 - w2 * (1.0 + ratio), -1.0, w2 * ratio;
  step.row(1) << 1.0, 0.0, 0.0;
  // q' = keep q + (mean - keep) u + (1 - mean) u'
  step.row(2) = (1.0 - mean) * step.row(0);
  step(2, 0) += mean - keep;
  step(2, 2) += keep;
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(LimitTheory, BranchesByTheRootsOfTheirStep) {
  for (const double ratio : {0.2, 2.6, 20.0}) {
    for (const double time : {1e-4, 1e-3, 1e-2, 1.0}) {
      const ViscousLaw law{.kind = Viscosity::standard_linear_solid, .branches = {{time, ratio}}};
      const double limit = *limit_theory({Integrator::central_difference}, omega, law);
      const auto radius = [&](double step) {
        return spectral_radius(ratio, step / time, omega * step);
      };
      EXPECT_LE(radius(0.999 * limit), 1.0 + 1e-12) << ratio << " " << time;
      EXPECT_GT(radius(1.001 * limit), 1.0 + 1e-5) << ratio << " " << time;
      // Between the tissue at once and the relaxed one.
      EXPECT_GT(limit, 0.02 / std::sqrt(1.0 + ratio));
      EXPECT_LT(limit, 0.02);
      EXPECT_EQ(limit, *limit_theory(lagged, omega, law));  // no damper that could lag
    }
  }
}

TEST(LimitTheory, Amplification) {
  test::expect_case("damp-02", *amplification(Integrator::backward_difference, 1.0));
  // gamma = 2 - sqrt 2, to the digits of the brief.
  EXPECT_NEAR(*amplification(Integrator::tr_bdf2, 0.1), 0.9999996, 5e-8);
  EXPECT_NEAR(*amplification(Integrator::tr_bdf2, 1.0), 0.99687, 5e-6);
  EXPECT_NEAR(*amplification(Integrator::tr_bdf2, 10.0), 0.445, 5e-4);
  EXPECT_EQ(amplification(Integrator::central_difference, 1.9), 1.0);
  EXPECT_FALSE(amplification(Integrator::central_difference, 2.1));
  EXPECT_FALSE(amplification(Integrator::quasi_static, 0.1));
}

TEST(LimitTheory, GrowthIsARoot) {
  const double root = growth_beyond(2.1);
  EXPECT_NEAR(root + 1.0 / root, 2.1 * 2.1 - 2.0, 1e-14);  // s^2 - (x^2 - 2) s + 1
  EXPECT_GT(root, 1.0);
}

}  // namespace
}  // namespace palpate::stability
