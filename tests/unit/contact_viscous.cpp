// Viscoelastic contact: closed forms of loading, unloading and recovery, rows of group SLS, and
// what holds for every press.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "contact/hertz.h"
#include "contact/viscous_contact.h"

namespace palpate::contact {
namespace {

constexpr double viscous_radius = 0.011;  // m
constexpr double relaxed = 5e3 / 0.75;    // E_inf / (1 - nu^2), Pa: nu = 0.5
constexpr double mm = 1e-3;

double phi(double depth) { return hertz::force(depth, viscous_radius, relaxed); }
double phi_slope(double depth) { return hertz::stiffness(depth, viscous_radius, relaxed); }

// The solid of group SLS: E_inf = 5 kPa, E_0 = 10 kPa, tau = 1 s.
const Relaxation solid{.branches = {{.time = 1.0, .ratio = 1.0}}};
const Relaxation two{.branches = {{.time = 0.05, .ratio = 2.0}, {.time = 1.0, .ratio = 0.7}}};
const Relaxation voigt{.branches = {}, .retardation_time = 0.2};

// The depth of a Hertz contact under a constant force, applied at once, after the time t (s); the
// force presses an elastic tissue to `relaxed_depth` (m) in the end:
//   h^(3/2) = h_inf^(3/2) J(t) E_inf                         Lee and Radok 1960
double depth_under_constant_force(const Creep& creep, double relaxed_depth, double time) {
  const double root = std::cbrt(creep.compliance_ratio(time));
  return relaxed_depth * root * root;
}

double step(ViscousContact& contact, double time_step, double depth) {
  return contact.step(time_step, depth, phi(depth));
}

// From the present depth in a straight line.
void ramp(ViscousContact& contact, double time, double from, double to, int steps) {
  for (int i = 1; i <= steps; ++i) step(contact, time / steps, from + (to - from) * i / steps);
}

// Zero of a falling function.
template <class Function>
double zero_of(Function function, double low, double high) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

TEST(ViscousContact, StepAtOnceRelaxesWithTheModulus) {
  EXPECT_NEAR(phi(mm) * solid.modulus_ratio(1.0), 0.040326603, 5e-10);  // SLS-02, nine digits
  for (const Relaxation& relaxation : {solid, two}) {
    ViscousContact contact(relaxation);
    EXPECT_DOUBLE_EQ(step(contact, 0.0, mm), phi(mm) * relaxation.modulus_ratio(0.0));
    for (int i = 1; i <= 300; ++i) {
      const double expected = phi(mm) * relaxation.modulus_ratio(0.01 * i);
      EXPECT_NEAR(step(contact, 0.01, mm), expected, 1e-13 * expected);  // rounding of 300 steps
      EXPECT_EQ(contact.contact_depth(), mm);
      EXPECT_EQ(contact.contact_depth(), mm);
    }
  }
}

// Rows SLS-05, SLS-08, SLS-09: 1 mm/s down for 2 s, then back.
TEST(ViscousContact, TriangleOfTing) {
  ViscousContact contact(solid);
  const double dt = 1.0 / 4000;  // of which dt^2 / 12 tau^2 = 5e-9 is the error
  const auto depth = [](int i) { return (i <= 8000 ? i : 16000 - i) / 4000.0 * mm; };
  ViscousContact before = contact;
  double lost = 0.0;
  double last = 0.0;
  for (int i = 1; i <= 16000; ++i) {
    if (i > 13700 && i < 13800) before = contact;
    const double force = step(contact, dt, depth(i));
    if (i == 8000) last = force;
    // As steep on both sides of the turn as F' allows, and no jump.
    if (i == 8001) {
      EXPECT_NEAR(force, last, 2e-3 * last);
    }
    // t_1 = 1.3851100 s at t = 2.5 s, on a press of 1 mm/s
    if (i == 10000) {
      EXPECT_NEAR(contact.contact_depth(), 1.38511 * mm, 1e-7 * 1.38511 * mm);
    }
    if (i == 12000) {
      EXPECT_NEAR(force, 0.016260296, 1e-6 * 0.016260296);
    }
    if (i > 8000 && force == 0.0) {
      // The moment within the last step.
      lost = dt * (i - 1) + zero_of(
                                [&](double part) {
                                  ViscousContact again = before;
                                  return step(again, part, depth(i - 1) - part * mm);
                                },
                                0.0, dt);
      break;
    }
  }
  EXPECT_NEAR(lost, 3.4412423, 1e-6 * 3.4412423);
  EXPECT_EQ(contact.contact_depth(), 0.0);
  // The finger is still below the surface at rest: the impression follows it up.
  EXPECT_NEAR(contact.surface_depth(), (4.0 - lost) * mm, 1e-3 * mm);
}

TEST(ViscousContact, WithoutBranchesItIsTheElasticForce) {
  EXPECT_TRUE(rc::check([] {
    ViscousContact contact{Relaxation{}};
    for (int i = 0; i < 50; ++i) {
      const double depth = *rc::gen::inRange(-1000, 3000) * 1e-6;
      RC_ASSERT(step(contact, *rc::gen::inRange(0, 100) * 1e-3, depth) == phi(depth));
      RC_ASSERT(contact.contact_depth() == std::max(depth, 0.0));
    }
  }));
}

// F = phi + tau dphi/dt down, F = phi(h + tau h') up, lost where that is nothing.
TEST(ViscousContact, KelvinVoigtInClosedForm) {
  constexpr double tau = 0.2, speed = 2.0 * mm, dt = 1e-3;  // s, m/s, s
  ViscousContact contact(voigt);
  double depth = 0.0;
  for (int i = 1; i <= 1000; ++i) {
    depth = speed * dt * i;
    const double expected = phi(depth) + tau * speed * phi_slope(depth);
    // Every step has Hertz's own slope, from the difference of neighbours.
    EXPECT_NEAR(step(contact, dt, depth), expected, 1e-12 * expected);
    EXPECT_EQ(contact.contact_depth(), depth);
  }
  EXPECT_DOUBLE_EQ(step(contact, dt, depth), phi(depth));  // held
  for (int i = 1; i < 1000; ++i) {
    depth = speed * dt * (1000 - i);
    const double force = step(contact, dt, depth);
    const double edge = depth - tau * speed;
    if (edge > 1e-12 * mm) {
      EXPECT_NEAR(contact.contact_depth(), edge, 1e-12 * mm);  // rounding
      EXPECT_NEAR(force, phi(edge), 1e-12 * phi(mm));          // rounding
    } else if (edge < -1e-12 * mm) {
      EXPECT_EQ(force, 0.0);
      EXPECT_EQ(contact.contact_depth(), 0.0);
    }
  }
  EXPECT_EQ(contact.contact_depth(), 0.0);
}

// Stopped on the way up, the surface beside the contact rises against the finger. A ring of level c
// was left tau v behind the finger, when that was at c - tau v.
TEST(ViscousContact, KelvinVoigtComesBackToAFingerThatStops) {
  constexpr double tau = 0.2, speed = 2.0 * mm, stop = 1.2 * mm;
  ViscousContact contact(voigt);
  ramp(contact, 1.0, 0.0, 2.0 * mm, 1000);
  ramp(contact, 0.4, 2.0 * mm, stop, 1600);
  for (int i = 1; i <= 400; ++i) {
    const double time = 1e-3 * i;
    const double force = step(contact, 1e-3, stop);
    const double edge = zero_of(
        [&](double c) {
          const double since = time + (c - (stop - tau * speed)) / speed;
          return stop - (c + tau * speed * std::exp(-since / tau));
        },
        stop - tau * speed, stop);
    EXPECT_NEAR(contact.contact_depth(), edge, 1e-6 * mm);  // rings straight between 0.5 um
    const double expected = phi(edge) + (stop - edge) * phi_slope(edge);
    EXPECT_NEAR(force, expected, 1e-5 * expected);  // as above, times phi'/phi
  }
}

// Between an elastic finger that hardly yields and none at all there is no jump.
TEST(ViscousContact, KelvinVoigtIsTheLimitOfAStiffFinger) {
  ViscousContact bare(voigt), behind(behind_finger(voigt, 1e-7));
  for (int i = 1; i <= 20000; ++i) {
    const double depth = mm * std::sin(4e-4 * i) * (1.0 + 0.2 * std::sin(5e-3 * i));
    const double force = step(bare, 1e-4, depth);
    // 1e-7 tau is far shorter than the step, over which the one then takes the mean slope of phi
    // and the other the last. The difference is a third of the force in the first step of a press.
    EXPECT_NEAR(step(behind, 1e-4, depth), force, 2e-2 * phi(mm)) << i;
  }
}

// A ring in the middle that was held at h_0 for a time t and is let go at once, with B = E_0/E_inf
// - 1:
//   w = h_0 B (1 - exp(-t/tau)) / (1 + B), fading with tau (1 + B)
TEST(ViscousContact, TheImpressionRecovers) {
  constexpr double B = 1.5, tau = 0.4, held = 0.3;
  ViscousContact contact({.branches = {{.time = tau, .ratio = B}}});
  step(contact, 0.0, mm);
  for (int i = 0; i < 30; ++i) step(contact, held / 30, mm);
  EXPECT_EQ(step(contact, 0.0, -0.5 * mm), 0.0);
  EXPECT_EQ(contact.contact_depth(), 0.0);
  const double left = mm * B * -std::expm1(-held / tau) / (1.0 + B);
  EXPECT_NEAR(contact.surface_depth(), left, 1e-13 * mm);  // rounding
  for (int i = 0; i < 10; ++i) step(contact, 0.1, -0.5 * mm);
  const double later = left * std::exp(-1.0 / (tau * (1.0 + B)));
  EXPECT_NEAR(contact.surface_depth(), later, 1e-13 * mm);
  // The next press meets what is left, not the surface that was.
  EXPECT_EQ(step(contact, 0.0, 0.999 * later), 0.0);
  EXPECT_EQ(contact.contact_depth(), 0.0);
  EXPECT_GT(step(contact, 0.0, 1.001 * later), 0.0);
  EXPECT_LT(contact.contact_depth(), later);
}

TEST(ViscousContact, ASecondPressIsWeakerUntilTheSurfaceHasRecovered) {
  const auto press = [](ViscousContact& contact) {
    ramp(contact, 0.5, 0.0, mm, 250);
    const double force = contact.force();
    ramp(contact, 0.5, mm, 0.0, 250);
    step(contact, 1e-3, -0.01 * mm);
    return force;
  };
  for (const Relaxation& relaxation : {solid, two}) {
    ViscousContact contact(relaxation);
    const double first = press(contact);
    step(contact, 1e-3, 0.0);
    const double second = press(contact);
    EXPECT_LT(second, 0.97 * first);
    EXPECT_GT(second, 0.5 * first);
    step(contact, 100.0, -0.01 * mm);
    step(contact, 1e-3, 0.0);
    // dt^2: the edge comes back over rings that lie elsewhere in the step than new ones would
    EXPECT_NEAR(press(contact), first, 1e-6 * first);
  }
}

// Held on the way up, the contact widens and the force rises again; pushed deeper than ever, it
// grows onto new surface.
TEST(ViscousContact, MovesItsEdge) {
  for (const Relaxation& relaxation : {solid, two, voigt}) {
    ViscousContact contact(relaxation);
    EXPECT_EQ(contact.contact_depth(), 0.0);
    ramp(contact, 0.5, 0.0, mm, 100);
    EXPECT_EQ(contact.contact_depth(), mm);
    ramp(contact, 0.05, mm, mm, 10);
    EXPECT_EQ(contact.contact_depth(), mm);
    ramp(contact, 0.5, mm, 0.4 * mm, 100);
    const double least = contact.force();
    const double edge = contact.contact_depth();
    EXPECT_LT(edge, 0.4 * mm);
    ramp(contact, 0.1, 0.4 * mm, 0.4 * mm, 20);
    EXPECT_GT(contact.force(), least);
    EXPECT_GT(contact.contact_depth(), edge);
    EXPECT_LT(contact.contact_depth(), 0.4 * mm);
    ramp(contact, 0.1, 0.4 * mm, 1.1 * mm, 20);
    EXPECT_EQ(contact.contact_depth(), 1.1 * mm);
  }
}

TEST(ViscousContact, AConstantForceCreeps) {
  // KV-03 as depths: h^(3/2) has grown to 1 - 1/e of the last after tau.
  EXPECT_NEAR(std::pow(depth_under_constant_force(creep(voigt), mm, 0.2) / mm, 1.5), 0.63212056,
              5e-9);
  for (const Relaxation& relaxation : {solid, two}) {
    const Creep slow = creep(relaxation);
    ViscousContact contact(relaxation);
    EXPECT_NEAR(step(contact, 0.0, depth_under_constant_force(slow, mm, 0.0)), phi(mm),
                1e-14 * phi(mm));  // rounding
    for (int i = 1; i <= 5000; ++i) {
      const double depth = depth_under_constant_force(slow, mm, 1e-3 * i);
      // dt^2 / (12 T^2) of the creep in a time of 0.05 s, 3e-5, times its share
      EXPECT_NEAR(step(contact, 1e-3, depth), phi(mm), 2e-5 * phi(mm)) << i;
    }
  }
}

// Any depths at any times, down to steps far longer than the tissue's times.
TEST(ViscousContact, NeverPullsAndNeverOutgrowsThePress) {
  EXPECT_TRUE(rc::check([] {
    const Relaxation choices[] = {solid,
                                  two,
                                  voigt,
                                  behind_finger(voigt, 0.03),
                                  {.branches = {{.time = 0.01, .ratio = 20.0},
                                                {.time = 0.1, .ratio = 0.1},
                                                {.time = 2.0, .ratio = 4.0}}}};
    const Relaxation& relaxation = choices[*rc::gen::inRange(0, 5)];
    ViscousContact contact(relaxation, 16);
    // Steps within the shortest time here, 6 ms, or up to 0.4 s.
    const double unit = *rc::gen::element(2e-5, 2e-3);  // s
    double deepest = 0.0;
    for (int i = 0; i < 60; ++i) {
      const double depth = *rc::gen::inRange(-500, 2000) * 1e-6;
      deepest = std::max(deepest, depth);
      const double force = step(contact, *rc::gen::inRange(0, 200) * unit, depth);
      RC_ASSERT(std::isfinite(force) && force >= 0.0);
      RC_ASSERT(contact.contact_depth() >= 0.0 && contact.contact_depth() <= deepest);
      RC_ASSERT(contact.contact_depth() <= std::max(depth, 0.0) + 1e-12 * mm);  // rounding
      RC_ASSERT(contact.surface_depth() <= deepest);
      RC_ASSERT(contact.surface_depth() >= std::min(depth, 0.0));
      const double stiffest = relaxation.modulus_ratio(0.0) * phi(deepest);
      if (contact.contact_depth() == 0.0) {
        RC_ASSERT(force == 0.0);
        RC_ASSERT(contact.surface_depth() >= depth - 1e-12 * mm);  // rounding
      } else {
        RC_ASSERT(force <= 1.000001 * stiffest || relaxation.retardation_time > 0.0);
      }
    }
  }));
}

// Nor is the surface left above a finger that goes, in steps of fifty times the shortest time.
TEST(ViscousContact, RisesNoFartherThanToTheFinger) {
  ViscousContact contact(behind_finger(voigt, 0.03));  // 6 ms
  step(contact, 0.0, 1.8 * mm);
  step(contact, 0.1, 1.2 * mm);
  EXPECT_EQ(step(contact, 0.3, 0.4 * mm), 0.0);
  EXPECT_EQ(contact.contact_depth(), 0.0);
  EXPECT_GE(contact.surface_depth(), 0.4 * mm * (1.0 - 1e-15));
}

// The work done on a tissue that was at rest, at any time of any history, is not less than 0; over
// a closed press it is what was lost.
TEST(ViscousContact, TakesEnergyAndGivesNone) {
  EXPECT_TRUE(rc::check([] {
    const Relaxation choices[] = {solid, two, voigt, behind_finger(voigt, 0.03)};
    ViscousContact contact(choices[*rc::gen::inRange(0, 4)]);
    double work = 0.0, scale = 0.0, depth = 0.0, before = 0.0;
    for (int leg = 0; leg < 20; ++leg) {
      const double to = leg < 19 ? *rc::gen::inRange(-300, 2000) * 1e-6 : -mm;
      const double time = *rc::gen::inRange(1, 100) * 1e-2;
      constexpr int n = 100;
      const double from = depth;
      for (int i = 1; i <= n; ++i) {
        const double next = from + (to - from) * i / n;
        const double force = step(contact, time / n, next);
        // At a leg's begin the rate jumps, and with it Kelvin-Voigt's force.
        work += (i == 1 ? force : 0.5 * (force + before)) * (next - depth);
        scale = std::max(scale, force * std::abs(to - from));
        depth = next;
        before = force;
      }
      RC_ASSERT(work >= -1e-6 * scale);  // the trapezoidal rule over steps of time / 100
    }
  }));
}

TEST(ViscousContact, ForceAndTimeScale) {
  ViscousContact contact(two), stiff(two);
  ViscousContact slow({.branches = {{.time = 0.5, .ratio = 2.0}, {.time = 10.0, .ratio = 0.7}}});
  for (int i = 1; i <= 1500; ++i) {
    const double depth = mm * std::sin(0.01 * i) * std::cos(0.003 * i);
    const double force = contact.step(1e-3, depth, phi(depth));
    EXPECT_EQ(stiff.step(1e-3, depth, 4.0 * phi(depth)), 4.0 * force);
    EXPECT_NEAR(slow.step(1e-2, depth, phi(depth)), force, 1e-12 * phi(mm));  // rounding
  }
}

// Steps of other lengths, and a way that is cut otherwise, lead to the same place.
TEST(ViscousContact, DoesNotMindUnequalSteps) {
  ViscousContact even(two), uneven(two);
  ramp(even, 1.0, 0.0, mm, 4000);
  ramp(even, 0.5, mm, 0.6 * mm, 2000);
  for (int i = 1; i <= 3000; ++i)
    step(uneven, (i % 2 == 1 ? 2.0 : 4.0) / 9000, mm * (i / 2 * 6 + i % 2 * 2) / 9000);
  for (int i = 1; i <= 1500; ++i)
    step(uneven, (i % 2 == 1 ? 1.0 : 3.0) / 6000, mm - 0.4 * mm * (i / 2 * 4 + i % 2) / 3000);
  EXPECT_NEAR(uneven.force(), even.force(), 1e-5 * even.force());  // dt^2 of either
  EXPECT_NEAR(uneven.contact_depth(), even.contact_depth(), 1e-5 * mm);
}

// A long swinging press with a small memory stays near the one that forgets nothing.
TEST(ViscousContact, ForgetsTheClosestRingsFirst) {
  ViscousContact all(two, 20000), few(two, 256);
  double worst = 0.0, largest = 0.0;
  for (int i = 1; i <= 10000; ++i) {
    const double depth = mm * (0.7 + 0.5 * std::sin(0.01 * i)) * -std::expm1(-0.001 * i);
    const double force = step(all, 1e-3, depth);
    worst = std::max(worst, std::abs(step(few, 1e-3, depth) - force));
    largest = std::max(largest, force);
  }
  EXPECT_LT(worst, 1e-3 * largest);  // the square of the spacing 2/256, and its many renewals
  EXPECT_GT(worst, 0.0);             // it did forget
}

}  // namespace
}  // namespace palpate::contact
