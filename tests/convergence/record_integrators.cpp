// Every integrator on one mass: declared order, stability limit, groups start, period, damp, dt.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "cases.h"
#include "integrate/central_difference.h"
#include "integrate/implicit.h"
#include "integrate/modal.h"
#include "one_mass.h"

namespace palpate {
namespace {

using integrate::CentralDifference;
using integrate::DampingVelocity;
using integrate::Implicit;
using integrate::MemoryRule;
using integrate::Modal;
using integrate::Start;
using integrate::TrBdf2;
using test::expect_case;
using test::load_of;
using test::OneMass;
using test::state_at;

// The displacement at `time` under a constant force.
using Solution =
    std::function<double(const OneMass&, double u, double v, double force, double dt, double time)>;

double central(const OneMass& body, Start start, double u, double v, double force, double dt,
               double time) {
  CentralDifference method(body, dt, start);
  auto state = state_at(u, v);
  const auto steps = std::lround(time / dt);
  for (long i = 0; i < steps; ++i) method.step(state, load_of(force));
  return state.displacement[0];
}

template <class Method>
double implicit(Method method, MemoryRule rule, double u, double v, double force, double dt,
                double time) {
  auto state = state_at(u, v);
  const auto steps = std::lround(time / dt);
  for (long i = 0; i < steps; ++i) {
    method.begin(state, dt, rule);
    EXPECT_TRUE(method.linearise(state.displacement, load_of(force)));
    const integrate::Vector end = method.base();
    method.finish(state, end, load_of(force));
  }
  return state.displacement[0];
}

double two_stages(double u, double v, double force, double dt, double time, const OneMass& body) {
  TrBdf2 method(body);
  auto state = state_at(u, v);
  const auto steps = std::lround(time / dt);
  for (long i = 0; i < steps; ++i) {
    method.start_under(load_of(force));
    for (int stage = 0; stage < 2; ++stage) {
      method.begin(state, dt, MemoryRule::exact);
      EXPECT_TRUE(method.linearise(state.displacement, load_of(force)));
      const integrate::Vector end = method.base();
      method.finish(state, end, load_of(force));
    }
  }
  return state.displacement[0];
}

// u'' + u = 1 from rest: 1 - cos t.
double oscillator_error(Start start, double dt) {
  OneMass body;
  return std::abs(central(body, start, 0, 0, 1, dt, 5.0) - (1.0 - std::cos(5.0)));
}

TEST(CentralDifference, StartsOfThePaperAndConsistent) {
  expect_case("start-01", oscillator_error(Start::paper, 0.05));
  expect_case("start-02", std::log2(oscillator_error(Start::paper, 0.05) /
                                    oscillator_error(Start::paper, 0.025)));
  expect_case("start-03", oscillator_error(Start::consistent, 0.05));
  EXPECT_NEAR(std::log2(oscillator_error(Start::consistent, 0.05) /
                        oscillator_error(Start::consistent, 0.025)),
              2.0, 0.02);  // the next term of the error at dt = 0.05
}

// The period from the turning of the phase: u_n = cos(n theta) for u_0 = 1, v_0 = 0.
double period_ratio(double omega_dt) {
  OneMass body;
  const double second = central(body, Start::consistent, 1, 0, 0, omega_dt, omega_dt);
  return omega_dt / std::acos(second);
}

TEST(CentralDifference, PeriodShortens) {
  expect_case("period-02", period_ratio(0.5));
  expect_case("period-04", period_ratio(1.9));
}

// |A| of a method, from the states that a step makes of (1, 0) and (0, 1): the root of their
// determinant.
template <class Step>
double amplification_of(const Step& step) {
  const auto [a, b] = step(1, 0);
  const auto [c, d] = step(0, 1);
  return std::sqrt(std::abs(a * d - b * c));
}

// |A| of TR-BDF2 without damping.
double amplification(double omega_dt) {
  OneMass body;
  const auto step = [&](double u, double v) {
    TrBdf2 method(body);
    auto state = state_at(u, v);
    method.start_under(load_of(0));
    for (int stage = 0; stage < 2; ++stage) {
      method.begin(state, omega_dt, MemoryRule::exact);
      EXPECT_TRUE(method.linearise(state.displacement, load_of(0)));
      const integrate::Vector end = method.base();
      method.finish(state, end, load_of(0));
    }
    return std::pair(state.displacement[0], state.velocity[0]);
  };
  return amplification_of(step);
}

TEST(TrBdf2, Amplification) {
  // On u' = z u a step multiplies by R(z) = (1 + sqrt(2) a z) / (1 - a z)^2, a = 1 - 1 / sqrt(2).
  const double a = 1.0 - std::sqrt(0.5);
  for (const double w : {0.1, 1.0, 10.0, 1e6})
    EXPECT_NEAR(amplification(w), std::sqrt(1.0 + 2.0 * a * a * w * w) / (1.0 + a * a * w * w),
                1e-10);  // rounding of a determinant near 1e-6 and below
  // The digits of the brief.
  EXPECT_NEAR(amplification(0.1), 0.9999996, 5e-8);  // half a unit of the last digit
  EXPECT_NEAR(amplification(1.0), 0.99687, 5e-6);
  EXPECT_NEAR(amplification(10.0), 0.445, 5e-4);
  // L-stable: what is far too fast is gone after a step, as 1 / (omega dt).
  EXPECT_LT(amplification(1e6), 1e-5);
}

TEST(BackwardDifference, Amplification) {
  OneMass body;
  Implicit method(body, Implicit::Inertia::backward_difference);
  const auto step = [&](double u, double v) {
    auto state = state_at(u, v);
    method.begin(state, 1.0, MemoryRule::exact);
    EXPECT_TRUE(method.linearise(state.displacement, load_of(0)));
    const integrate::Vector end = method.base();
    method.finish(state, end, load_of(0));
    return std::pair(state.displacement[0], state.velocity[0]);
  };
  expect_case("damp-02", amplification_of(step));
}

// Damped, loaded, moving: the exact solution of m u'' + c u' + k u = F.
double exact(const OneMass& body, double u, double v, double force, double time) {
  const double c = body.d + body.tau * body.k;
  const double omega = std::sqrt(body.k / body.m);
  const double zeta = c / (2.0 * std::sqrt(body.k * body.m));
  const double rest = force / body.k;
  const double damped = omega * std::sqrt(1.0 - zeta * zeta);
  const double a = u - rest;
  const double b = (v + zeta * omega * a) / damped;
  return rest + std::exp(-zeta * omega * time) *
                    (a * std::cos(damped * time) + b * std::sin(damped * time));
}

TEST(Integrators, DeclaredOrders) {
  struct Declared {
    const char* name;
    double order;
    Solution run;
  };
  const Declared methods[] = {
      {"central_difference, consistent", 2.0,
       [](const OneMass& body, double u, double v, double f, double dt, double time) {
         return central(body, Start::consistent, u, v, f, dt, time);
       }},
      {"central_difference, paper", 1.0,
       [](const OneMass& body, double u, double v, double f, double dt, double time) {
         return central(body, Start::paper, u, v, f, dt, time);
       }},
      {"backward_difference", 1.0,
       [](const OneMass& body, double u, double v, double f, double dt, double time) {
         return implicit(Implicit(body, Implicit::Inertia::backward_difference), MemoryRule::exact,
                         u, v, f, dt, time);
       }},
      {"semi_implicit_euler", 1.0,
       [](const OneMass& body, double u, double v, double f, double dt, double time) {
         CentralDifference method(body, dt, Start::consistent, DampingVelocity::ahead);
         auto state = state_at(u, v);
         for (long i = 0; i < std::lround(time / dt); ++i) method.step(state, load_of(f));
         return state.displacement[0];
       }},
      {"tr_bdf2", 2.0,
       [](const OneMass& body, double u, double v, double f, double dt, double time) {
         return two_stages(u, v, f, dt, time, body);
       }}};
  for (const double tau : {0.0, 0.3}) {
    for (const double drag : {0.0, 0.4}) {
      OneMass body;
      body.k = 2.0;
      body.m = 1.5;
      body.d = drag;
      body.tau = tau;
      body.update();
      for (const Declared& method : methods) {
        // U(-dt) = U(0) knows no start velocity.
        const double v = std::string(method.name).ends_with("paper") ? 0.0 : 0.5;
        const auto error = [&](double dt) {
          return std::abs(method.run(body, 0.2, v, 1.0, dt, 4.0) - exact(body, 0.2, v, 1.0, 4.0));
        };
        // Errors at these steps are in the asymptotic range: a tenth of an order is left over.
        EXPECT_NEAR(std::log2(error(1.0 / 128) / error(1.0 / 256)), method.order, 0.1)
            << method.name << ", tau " << tau << ", drag " << drag;
      }
    }
  }
}

TEST(Modal, ExactWhateverTheStep) {
  for (const double tau : {0.0, 0.3}) {
    OneMass body;
    body.k = 2.0;
    body.m = 1.5;
    body.d = 0.4;
    body.tau = tau;
    body.update();
    for (const double dt : {0.01, 0.5, 4.0}) {
      const double got = implicit(Modal(body), MemoryRule::held, 0, 0, 1.0, dt, 4.0);
      EXPECT_NEAR(got, exact(body, 0, 0, 1.0, 4.0), 1e-12);  // rounding of the exponentials
    }
  }
}

TEST(Modal, ExactForARamp) {
  // u'' + u = t: u = t - sin t
  OneMass body;
  Modal method(body);
  auto state = state_at(0, 0);
  for (int i = 1; i <= 4; ++i) {
    method.begin(state, 0.7, MemoryRule::exact);
    ASSERT_TRUE(method.linearise(state.displacement, load_of(0.7 * i)));
    const integrate::Vector end = method.base();
    method.finish(state, end, load_of(0.7 * i));
  }
  EXPECT_NEAR(state.displacement[0], 2.8 - std::sin(2.8), 1e-12);
  EXPECT_NEAR(state.velocity[0], 1.0 - std::cos(2.8), 1e-12);
}

template <class Method>
bool grows(Method method) {
  auto state = state_at(1, 0);
  double largest = 0.0;
  for (int i = 0; i < 4000; ++i) {
    method.step(state, load_of(0));
    largest = std::max(largest, std::abs(state.displacement[0]));
  }
  return largest > 1e3;
}

TEST(CentralDifference, StableBelowTwoOverOmegaWhateverTheDamping) {
  for (const double drag : {0.0, 0.5, 5.0}) {
    OneMass body;
    body.d = drag;
    body.update();
    EXPECT_FALSE(grows(CentralDifference(body, 0.95 * 2.0, Start::consistent))) << drag;
    EXPECT_TRUE(grows(CentralDifference(body, 1.05 * 2.0, Start::consistent))) << drag;
  }
}

// omega = 100 1/s and zeta = 0.5 of drag (100 1/s) or of dashpots (10 ms): the formula of the cases
// and what the method does.
TEST(ExplicitLimit, OfDampingThatLagsOrGoesAhead) {
  const integrate::FastestMode mode{.squared = 1e4, .rate = 100.0};
  const double lagged = explicit_limit(DampingVelocity::lagged, mode);
  const double ahead = explicit_limit(DampingVelocity::ahead, mode);
  EXPECT_DOUBLE_EQ(explicit_limit(DampingVelocity::centred, mode), 0.02);
  expect_case("dt-03", lagged);
  expect_case("dt-04", ahead);
  for (const bool dashpots : {false, true}) {
    OneMass body;
    body.k = 100.0;
    body.m = 0.01;
    (dashpots ? body.tau : body.d) = dashpots ? 0.01 : 1.0;
    body.update();
    const auto lags = [&](double part) {
      return grows(
          CentralDifference(body, part * lagged, Start::consistent, DampingVelocity::lagged));
    };
    EXPECT_FALSE(lags(0.98)) << dashpots;
    EXPECT_TRUE(lags(1.02)) << dashpots;
    const auto goes_ahead = [&](double part) {
      return grows(
          CentralDifference(body, part * ahead, Start::consistent, DampingVelocity::ahead));
    };
    EXPECT_FALSE(goes_ahead(0.98)) << dashpots;
    EXPECT_TRUE(goes_ahead(1.02)) << dashpots;
  }
}

// Heavy dashpots that lag: 2 / (beta omega^2) is left, 1.98 ms of 20 ms at k = 100 N/m, m = 10 g,
// beta = 0.1 s.
TEST(ExplicitLimit, CollapsesWhereHeavyDashpotsLag) {
  const double beta = 0.1;
  const double limit =
      explicit_limit(integrate::DampingVelocity::lagged, {.squared = 1e4, .rate = beta * 1e4});
  EXPECT_NEAR(limit, -beta + std::sqrt(beta * beta + 4e-4), 1e-13);  // rounding of the difference
  EXPECT_NEAR(limit, 1.98e-3, 5e-6);
}

TEST(TrBdf2, StableForEveryStep) {
  OneMass body;
  for (const double dt : {1.0, 100.0, 1e6})
    EXPECT_LE(std::abs(two_stages(1, 0, 0, dt, 50 * dt, body)), 1.0);
}

TEST(BackwardDifference, StableForEveryStep) {
  OneMass body;
  for (const double dt : {1.0, 100.0, 1e6})
    EXPECT_LE(std::abs(implicit(Implicit(body, Implicit::Inertia::backward_difference),
                                MemoryRule::exact, 1, 0, 0, dt, 50 * dt)),
              1.0);
}

}  // namespace
}  // namespace palpate
