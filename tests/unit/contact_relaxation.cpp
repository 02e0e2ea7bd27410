// Relaxation, creep and the finger before them: closed forms, their convolution, rows of group KV.
#include "contact/viscous_contact.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <vector>

namespace palpate::contact {
namespace {

// The relaxation behind an elastic finger, whose compliance adds to the tissue's creep.
void expect_series(const Relaxation& tissue, double share, double tolerance) {
  const Creep own = creep(tissue);
  const Creep together = creep(behind_finger(tissue, share));
  for (const double t : {0.0, 1e-4, 1e-2, 0.1, 0.5, 1.0, 3.0, 20.0, 1e3}) {
    const double expected = share + (1.0 - share) * own.compliance_ratio(t);
    // and 1 - sum j, which cancels
    EXPECT_NEAR(together.compliance_ratio(t), expected, tolerance * expected + 1e-15)
        << share << " " << t;
  }
}

// integral over 0 < s < t of E(t-s) dJ(s), the jump of J at 0 included: a stress of 1 that was
// brought on at once and stays. Every exponential is integrated exactly.
double stress_under_its_own_creep(const Relaxation& relaxation, const Creep& creep, double t) {
  double stress = relaxation.modulus_ratio(t) * creep.compliance_ratio(0.0);
  for (const auto& [T, j] : creep.modes) {
    stress += -j * std::expm1(-t / T);
    for (const auto& [tau, b] : relaxation.branches)
      stress += j * b * tau / (T - tau) * (std::exp(-t / T) - std::exp(-t / tau));
  }
  return stress;
}

const std::vector<Relaxation>& spectra() {
  static const std::vector<Relaxation> all{
      {.branches = {{.time = 0.3, .ratio = 1.0}}},
      {.branches = {{.time = 0.05, .ratio = 2.0}, {.time = 1.0, .ratio = 0.7}}},
      // a fingerpad's three times, the fastest strongest
      {.branches = {{.time = 1.4, .ratio = 0.8},
                    {.time = 0.004, .ratio = 5.0},
                    {.time = 0.07, .ratio = 1.5}}},
      {.branches = {{.time = 1.0, .ratio = 1e-6}, {.time = 1.001, .ratio = 30.0}}},
      {.branches = {{.time = 1.0, .ratio = 30.0}, {.time = 1.001, .ratio = 1e-6}}}};
  return all;
}

TEST(Relaxation, FallsFromTheGlassyToTheRelaxedModulus) {
  const Relaxation solid{.branches = {{.time = 2.0, .ratio = 1.5}}};
  EXPECT_DOUBLE_EQ(solid.modulus_ratio(0.0), 2.5);
  EXPECT_DOUBLE_EQ(solid.modulus_ratio(2.0), 1.0 + 1.5 * std::exp(-1.0));
  EXPECT_DOUBLE_EQ(solid.modulus_ratio(1e4), 1.0);
  EXPECT_FALSE(solid.elastic());
  const Relaxation voigt{.branches = {}, .retardation_time = 0.1};
  EXPECT_EQ(voigt.modulus_ratio(1.0), 1.0);
  EXPECT_FALSE(voigt.elastic());
  EXPECT_TRUE(Relaxation{}.elastic());
  EXPECT_EQ(Relaxation{}.modulus_ratio(1.0), 1.0);
  EXPECT_EQ(creep(Relaxation{}).compliance_ratio(1.0), 1.0);
}

// One branch: J = 1/E_inf - (1/E_inf - 1/E_0) exp(-t/tau_c), tau_c = tau E_0 / E_inf.
TEST(Creep, OfTheStandardLinearSolid) {
  for (const double b : {1e-12, 1e-3, 1.0, 40.0, 1e9}) {
    const Creep got = creep({.branches = {{.time = 0.3, .ratio = b}}});
    ASSERT_EQ(got.modes.size(), 1u);
    EXPECT_NEAR(got.modes[0].time, 0.3 * (1.0 + b), 1e-15 * 0.3 * (1.0 + b));  // rounding
    EXPECT_NEAR(got.modes[0].ratio, b / (1.0 + b), 1e-15 * b / (1.0 + b));     // rounding
    ASSERT_EQ(got.gaps.size(), 1u);
    EXPECT_DOUBLE_EQ(got.gaps[0], 0.3 * b);
  }
}

// Rows KV-01 to KV-06 of the reference cases, eight digits of each.
TEST(Creep, OfKelvinVoigt) {
  constexpr double tau = 0.25;  // s
  const Creep voigt = creep({.branches = {}, .retardation_time = tau});
  constexpr double printed = 5e-9;  // half a unit of the eighth digit
  const auto after = [&](double times) { return voigt.compliance_ratio(times * tau); };
  EXPECT_NEAR(after(0.1), 0.095162582, 5e-10);                   // KV-01, nine digits
  EXPECT_NEAR(after(0.5), 0.39346934, printed);                  // KV-02
  EXPECT_NEAR(after(1.0), 0.63212056, printed);                  // KV-03
  EXPECT_NEAR(after(2.0), 0.86466472, printed);                  // KV-04
  EXPECT_NEAR(after(5.0), 0.99326205, printed);                  // KV-05
  EXPECT_NEAR(after(4.0) - after(1.0), 0.3495638, 1e-9 + 5e-9);  // KV-06: withdrawn after 3 tau
  EXPECT_EQ(after(0.0), 0.0);
  // Early creep keeps its digits: t/tau - (t/tau)^2 / 2.
  EXPECT_DOUBLE_EQ(after(1e-9), 1e-9 - 5e-19);
}

TEST(Creep, IsTheInverseOfTheRelaxation) {
  for (const Relaxation& relaxation : spectra()) {
    const Creep inverse = creep(relaxation);
    for (const double t : {0.0, 1e-4, 1e-2, 0.1, 0.5, 1.0, 3.0, 20.0, 1e3})
      // Rounding, times b tau / (T - tau) where two times nearly meet, up to 1e3 here.
      EXPECT_NEAR(stress_under_its_own_creep(relaxation, inverse, t), 1.0, 2e-12) << t;
  }
}

TEST(Creep, ModesLieBehindTheirBranches) {
  EXPECT_TRUE(rc::check([] {
    const int n = *rc::gen::inRange(1, 9);
    Relaxation relaxation;
    for (int k = 0; k < n; ++k)
      relaxation.branches.push_back({.time = std::exp(*rc::gen::inRange(-9000, 9000) * 1e-3),
                                     .ratio = std::exp(*rc::gen::inRange(-20000, 7000) * 1e-3)});
    const std::vector<Branch> branches = sorted(relaxation).branches;
    const Creep got = creep(relaxation);
    RC_ASSERT(got.modes.size() == branches.size());
    double at_once = 1.0;
    for (std::size_t m = 0; m < branches.size(); ++m) {
      RC_ASSERT(got.modes[m].time >= branches[m].time);
      if (m + 1 < branches.size()) RC_ASSERT(got.modes[m].time <= branches[m + 1].time);
      RC_ASSERT(got.modes[m].ratio > 0.0);
      at_once -= got.modes[m].ratio;
      for (std::size_t k = 0; k < branches.size(); ++k) {
        const double gap = got.gaps[m * branches.size() + k];
        RC_ASSERT((k <= m) == (gap > 0.0));
        const double size = got.modes[m].time + branches[k].time;
        RC_ASSERT(std::abs(gap - (got.modes[m].time - branches[k].time)) <= 1e-15 * size);
      }
    }
    // What yields at once is E_inf / E_0.
    RC_ASSERT(std::abs(at_once - 1.0 / relaxation.modulus_ratio(0.0)) < 1e-13);  // rounding
  }));
}

TEST(Relaxation, SortsMergesAndDrops) {
  const Relaxation got = sorted({.branches = {{.time = 3.0, .ratio = 1.0},
                                              {.time = 0.5, .ratio = 0.25},
                                              {.time = 1.0, .ratio = 0.0},
                                              {.time = 3.0, .ratio = 2.0}}});
  ASSERT_EQ(got.branches.size(), 2u);
  EXPECT_EQ(got.branches[0].time, 0.5);
  EXPECT_EQ(got.branches[0].ratio, 0.25);
  EXPECT_EQ(got.branches[1].time, 3.0);
  EXPECT_EQ(got.branches[1].ratio, 3.0);
}

// tau* = tau (1 + lambda_1 E_0') / (1 + lambda_1 E_inf'), E' = E / (1 - nu^2), and
// E* = 1 / (lambda_1 + 1/E') at either end.
TEST(BehindFinger, OfTheStandardLinearSolid) {
  constexpr double tau = 0.3, relaxed = 6000.0 / 0.76, glassy = 3.5 * relaxed;  // s, Pa
  for (const double finger : {1e-12, 3e-7, 1e-5, 1e-3, 1.0}) {                  // lambda_1, 1/Pa
    const double share = finger / (finger + 1.0 / relaxed);
    const Relaxation got = behind_finger({.branches = {{.time = tau, .ratio = 2.5}}}, share);
    ASSERT_EQ(got.branches.size(), 1u);
    const double time = tau * (1.0 + finger * glassy) / (1.0 + finger * relaxed);
    EXPECT_NEAR(got.branches[0].time, time, 1e-14 * time);  // rounding
    const double at_once = (finger + 1.0 / relaxed) / (finger + 1.0 / glassy);
    EXPECT_NEAR(got.modulus_ratio(0.0), at_once, 1e-14 * at_once);
  }
}

// tau* = tau lambda_1 E' / (1 + lambda_1 E'), E_0* = 1 / lambda_1.
TEST(BehindFinger, MakesASolidOfKelvinVoigt) {
  for (const double share : {1e-9, 1e-3, 0.029, 0.5, 0.99985}) {
    const Relaxation got = behind_finger({.branches = {}, .retardation_time = 0.2}, share);
    EXPECT_EQ(got.retardation_time, 0.0);
    ASSERT_EQ(got.branches.size(), 1u);
    EXPECT_NEAR(got.branches[0].time, 0.2 * share, 1e-15 * 0.2);
    const double rounding = 1e-15 / share;  // of 1 - share
    EXPECT_NEAR(got.branches[0].time / (0.2 * share), 1.0, rounding);
    EXPECT_NEAR(got.modulus_ratio(0.0) * share, 1.0, rounding);
  }
}

TEST(BehindFinger, ItsComplianceAddsToTheCreep) {
  for (const Relaxation& tissue : spectra())
    for (const double share : {1e-6, 0.01, 0.3, 0.9})
      expect_series(tissue, share, 1e-12);  // rounding, there and back again
  for (const double share : {1e-6, 0.01, 0.3, 0.9})
    expect_series({.branches = {}, .retardation_time = 0.2}, share, 1e-12);
}

TEST(BehindFinger, RigidFingerAndRigidTissue) {
  const Relaxation tissue = spectra()[2];
  const Relaxation own = behind_finger(tissue, 0.0);
  ASSERT_EQ(own.branches.size(), 3u);
  for (const double t : {0.0, 0.01, 1.0})
    EXPECT_DOUBLE_EQ(own.modulus_ratio(t), tissue.modulus_ratio(t));
  EXPECT_EQ(behind_finger({.branches = {}, .retardation_time = 0.2}, 0.0).retardation_time, 0.2);
  EXPECT_TRUE(behind_finger(tissue, 1.0).elastic());
  EXPECT_TRUE(behind_finger({}, 0.3).elastic());
}

}  // namespace
}  // namespace palpate::contact
