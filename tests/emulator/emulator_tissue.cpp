// The emulator's tissue against what Lee and Radok's integral gives by itself.
#include "emulator/tissue.h"

#include <gtest/gtest.h>

#include <cmath>

namespace emulator {
namespace {

constexpr double stand_step = 1.0 / 7000.0;  // s, the stand's step
const TissueSettings skin{.E0 = 40e3, .E_inf = 10e3, .tau = 0.3, .nu = 0.45, .R = 6e-3};

// N, at the time t after a jump to `depth` (m): F(t) = 4/3 sqrt(R)/(1 - nu^2) E(t) depth^(3/2).
double relaxation_force(const TissueSettings& s, double depth, double t) {
  const double modulus = s.E_inf + (s.E0 - s.E_inf) * std::exp(-t / s.tau);
  return 4.0 / 3.0 * std::sqrt(s.R) / (1.0 - s.nu * s.nu) * modulus * depth * std::sqrt(depth);
}

// F = C int_0^t E(t - s) 3/2 v^(3/2) s^(1/2) ds by Simpson; s = u^2 takes the root away.
double ramp_force(double speed, double t) {
  const int intervals = 2000;
  const double width = std::sqrt(t) / intervals;
  double sum = 0.0;
  for (int i = 0; i <= intervals; ++i) {
    const double u = i * width;
    const double modulus = skin.E_inf + (skin.E0 - skin.E_inf) * std::exp(-(t - u * u) / skin.tau);
    const double weight = i == 0 || i == intervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    sum += weight * modulus * 3.0 * speed * std::sqrt(speed) * u * u;
  }
  const double coefficient = 4.0 / 3.0 * std::sqrt(skin.R) / (1.0 - skin.nu * skin.nu);
  return coefficient * sum * width / 3.0;
}

double stepped_ramp(double speed, double t, double step) {
  Tissue tissue = make_tissue(skin, step);
  const int steps = static_cast<int>(std::lround(t / step));
  double force = 0.0;
  for (int i = 1; i <= steps; ++i) force = press(tissue, speed * i * step);
  return force;
}

TEST(EmulatorTissue, HoldsAsItsModulusRelaxes) {
  Tissue tissue = make_tissue(skin, stand_step);
  const double depth = 1.5e-3;
  press(tissue, depth);
  for (int i = 1; i <= 7000; ++i) {
    const double force = press(tissue, depth);
    if (i % 700 != 0) continue;
    const double exact = relaxation_force(skin, depth, i * stand_step);
    // The step took dt where the formula jumps: dt / (2 tau) of the relaxing part.
    EXPECT_NEAR(force, exact, stand_step / skin.tau * exact) << i * stand_step;
  }
  const double late = relaxation_force(skin, depth, 100.0);
  const double coefficient = 4.0 / 3.0 * std::sqrt(skin.R) / (1.0 - skin.nu * skin.nu);
  EXPECT_NEAR(late, coefficient * skin.E_inf * std::pow(depth, 1.5), 1e-12 * late);  // rounding
}

TEST(EmulatorTissue, FollowsTheIntegralOnARamp) {
  for (const double speed : {0.5e-3, 5e-3})
    for (const double t : {0.05, 0.2, 0.4}) {
      const double exact = ramp_force(speed, t);
      // Linear pieces of h^(3/2) err by (dt/tau)^2 and by dt/t at the root's beginning.
      EXPECT_NEAR(stepped_ramp(speed, t, stand_step), exact, 1e-5 * exact)
          << speed << " m/s, " << t << " s";
    }
}

TEST(EmulatorTissue, ConvergesWithItsStep) {
  const double exact = ramp_force(2e-3, 0.4);
  const double coarse = std::abs(stepped_ramp(2e-3, 0.4, 0.02) - exact);
  const double fine = std::abs(stepped_ramp(2e-3, 0.4, 0.01) - exact);
  EXPECT_GT(coarse / fine, 2.5);  // between the root's order 3/2 and second order
}

TEST(EmulatorTissue, NeverPullsAndForgets) {
  Tissue tissue = make_tissue(skin, stand_step);
  for (int i = 0; i <= 700; ++i) press(tissue, 1e-3);
  for (int i = 700; i >= -700; --i) EXPECT_GE(press(tissue, i * 1e-3 / 700.0), 0.0);
  EXPECT_EQ(force_of(tissue), 0.0);
  EXPECT_LT(tissue.memory, 0.0);  // pressed before, softer for a while
  for (int i = 0; i < 7000 * 12; ++i) press(tissue, -1e-3);
  Tissue fresh = make_tissue(skin, stand_step);
  EXPECT_NEAR(press(tissue, 1e-3), press(fresh, 1e-3), 1e-12);  // exp(-40) is left
}

}  // namespace
}  // namespace emulator
