// Viscoelastic contact against Lee and Radok's and Ting's integrals and against a half-space that
// knows no more than its compliance and that a contact can only push; orders in the time step.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "base/dense.h"
#include "contact/hertz.h"
#include "contact/viscous_contact.h"

namespace palpate::contact {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double radius = 0.011;        // m
constexpr double relaxed = 5e3 / 0.75;  // E_inf / (1 - nu^2), Pa

double phi(double depth) { return hertz::force(depth, radius, relaxed); }
double phi_slope(double depth) { return hertz::stiffness(depth, radius, relaxed); }

const std::vector<Relaxation>& solids() {
  static const std::vector<Relaxation> all{
      {.branches = {{.time = 0.3, .ratio = 1.0}}},
      {.branches = {{.time = 0.05, .ratio = 2.0}, {.time = 1.0, .ratio = 0.7}}}};
  return all;
}

// A press of 1 s that goes down until `turn` and up from then, smooth between `breaks`.
struct Press {
  const char* name;
  std::function<double(double)> depth, speed;  // m, m/s
  double turn;                                 // s
  std::vector<double> breaks;                  // s, from 0 to 1; they lie on every step used here
};

const std::vector<Press>& presses() {
  constexpr double deepest = 1e-3;
  static const std::vector<Press> all{
      {"ramp, hold, retreat",
       [](double t) {
         return deepest * std::min({1.0, t / 0.2, (1.0 - t) / 0.4});
       },
       [](double t) { return t < 0.2 ? deepest / 0.2 : (t < 0.6 ? 0.0 : -deepest / 0.4); },
       0.6,
       {0.0, 0.2, 0.6, 1.0}},
      {"triangle",
       [](double t) { return deepest * std::min(2.0 * t, 2.0 - 2.0 * t); },
       [](double t) { return t < 0.5 ? 2.0 * deepest : -2.0 * deepest; },
       0.5,
       {0.0, 0.5, 1.0}},
      {"half a sine",
       [](double t) { return deepest * std::sin(std::numbers::pi * t); },
       [](double t) { return deepest * std::numbers::pi * std::cos(std::numbers::pi * t); },
       0.5,
       {0.0, 1.0}}};
  return all;
}

// Gauss's rule of five points on panels that crowd towards the begin of each smooth piece, where
// a force starts like t^(1/2).
template <class Function>
double integral(Function f, double from, double to, const std::vector<double>& breaks) {
  constexpr std::array nodes{0.0, 0.53846931010568309, 0.90617984593866399};
  constexpr std::array weights{128.0 / 225.0, 0.47862867049936647, 0.23692688505618909};
  constexpr int panels = 40;
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double a = std::max(from, breaks[i]);
    const double width = std::min(to, breaks[i + 1]) - a;
    if (width <= 0.0) continue;
    for (int panel = 0; panel < panels; ++panel)
      for (int node = -2; node <= 2; ++node) {
        const auto n = static_cast<std::size_t>(std::abs(node));
        const double u = (panel + 0.5 + (node < 0 ? -0.5 : 0.5) * nodes[n]) / panels;
        sum += weights[n] / (2.0 * panels) * f(a + width * u * u) * 2.0 * u * width;
      }
  }
  return sum;
}

struct Answer {
  double force = 0.0;  // N
  double edge = 0.0;   // m, the depth at t_1
};

// F(t) = integral to t_1 of E(t-s) dphi, t_1 = t until the turn and from then with
// integral from t_1 to t of E(t-s) h'(s) ds = 0.
Answer lee_radok_ting(const Relaxation& relaxation, const Press& press, double t) {
  const auto push_since = [&](double start) {
    return integral([&](double s) { return relaxation.modulus_ratio(t - s) * press.speed(s); },
                    start, t, press.breaks);
  };
  double t_1 = t;
  if (t > press.turn) {
    if (push_since(0.0) <= 0.0) return {};
    double low = 0.0, high = press.turn;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (push_since(middle) > 0.0 ? low : high) = middle;
    }
    t_1 = low;
  }
  const double force = integral(
      [&](double s) {
        return relaxation.modulus_ratio(t - s) * phi_slope(press.depth(s)) * press.speed(s);
      },
      0.0, t_1, press.breaks);
  return {.force = force, .edge = press.depth(t_1)};
}

// The errors of force and edge, root mean square of 50 moments, over the greatest of each.
Answer errors(const Relaxation& relaxation, const Press& press, const std::vector<Answer>& exact,
              int steps) {
  ViscousContact contact(relaxation);
  Answer squares, largest;
  for (int i = 1; i <= steps; ++i) {
    const double depth = press.depth(static_cast<double>(i) / steps);
    const double force = contact.step(1.0 / steps, depth, phi(depth));
    const int every = steps / 50;
    if (i % every != 0) continue;
    const Answer& expected = exact[static_cast<std::size_t>(i / every)];
    squares.force += std::pow(force - expected.force, 2) / 50.0;
    squares.edge += std::pow(contact.contact_depth() - expected.edge, 2) / 50.0;
    largest.force = std::max(largest.force, expected.force);
    largest.edge = std::max(largest.edge, expected.edge);
  }
  return {.force = std::sqrt(squares.force) / largest.force,
          .edge = std::sqrt(squares.edge) / largest.edge};
}

TEST(ViscousContact, ConvergesToLeeRadokAndTing) {
  for (const Relaxation& relaxation : solids())
    for (const Press& press : presses()) {
      std::vector<Answer> exact(1);
      for (int i = 1; i <= 50; ++i) exact.push_back(lee_radok_ting(relaxation, press, i / 50.0));
      EXPECT_EQ(exact.back().force, 0.0) << press.name;  // contact is lost before h = 0
      const Answer coarse = errors(relaxation, press, exact, 250);
      const Answer fine = errors(relaxation, press, exact, 2000);
      EXPECT_GT(std::log2(coarse.force / fine.force) / 3.0, 1.9) << press.name;
      // The edge's error also depends on where between two rings it is: from nothing to all.
      EXPECT_GT(std::log2(coarse.edge / fine.edge) / 3.0, 1.6) << press.name;
      // (dt / 0.05 s)^2 / 12 = 8e-6 of what the fast branch holds, for a part of the press
      EXPECT_LT(fine.force, 1e-6) << press.name;
      EXPECT_LT(fine.edge, 1e-6) << press.name;
    }
}

TEST(ViscousContact, OfKelvinVoigtIsOfFirstOrder) {
  constexpr double tau = 0.1;
  const Press& press = presses()[2];
  const auto error = [&](int steps) {
    ViscousContact contact({.branches = {}, .retardation_time = tau});
    double worst = 0.0;
    for (int i = 1; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const double depth = press.depth(t), speed = press.speed(t);
      const double force = contact.step(1.0 / steps, depth, phi(depth));
      const double expected =
          speed > 0.0 ? phi(depth) + tau * phi_slope(depth) * speed : phi(depth + tau * speed);
      worst = std::max(worst, std::abs(force - expected));
    }
    return worst / phi(1e-3);
  };
  EXPECT_NEAR(std::log2(error(1000) / error(2000)), 1.0, 0.05);
  EXPECT_LT(error(1000), 2e-3);  // tau h'' dt / 2 of the rate, times phi'
}

// Presses, partial retreats and returns, loss of contact and presses into what has not recovered.
double restless(double t) {
  const double swing = 0.35 + 0.6 * std::sin(3.1 * t) + 0.25 * std::sin(8.3 * t + 0.5);
  return 0.02 * swing * -std::expm1(-25.0 * t * t);
}

// In units of R = 1 and E*_inf = 1.
double unit_phi(double depth) { return hertz::force(depth, 1.0, 1.0); }

TEST(ViscousContact, ReturningConvergesToo) {
  for (const Relaxation& relaxation : solids()) {
    const auto forces = [&](int steps) {
      ViscousContact contact(relaxation, 20000);
      std::vector<double> all;
      for (int i = 1; i <= steps; ++i) {
        const double depth = restless(4.0 * i / steps);
        const double force = contact.step(4.0 / steps, depth, unit_phi(depth));
        if (i % (steps / 250) == 0) all.push_back(force);
      }
      return all;
    };
    const std::vector<double> exact = forces(16000);
    const double largest = *std::max_element(exact.begin(), exact.end());
    const auto error = [&](int steps) {
      const std::vector<double> got = forces(steps);
      double worst = 0.0;
      for (std::size_t i = 0; i < exact.size(); ++i)
        worst = std::max(worst, std::abs(got[i] - exact[i]));
      return worst / largest;
    };
    EXPECT_GT(std::log2(error(1000) / error(2000)), 1.85);  // the reference errs by 1/64 of it
    EXPECT_LT(error(2000), 3e-5);  // as in the test above, dt twice as long
  }
}

// E(m) and K(m) by arithmetic-geometric means.
struct Elliptic {
  double K, E;
};
Elliptic elliptic(double m) {
  double a = 1.0, g = std::sqrt(1.0 - m), part = 0.5, sum = 0.5 * m;
  for (int i = 0; i < 12; ++i) {
    const double c = 0.5 * (a - g);
    const double mean = 0.5 * (a + g);
    g = std::sqrt(a * g);
    a = mean;
    part *= 2.0;
    sum += part * c * c;
  }
  const double K = 0.5 * std::numbers::pi / a;
  return {.K = K, .E = K * (1.0 - sum)};
}

// How far a half-space of E' = 1 sinks at r under a pressure of 1 on a disc of radius a
// (Johnson 1985, section 3.4).
double under_disc(double a, double r) {
  if (a == 0.0) return 0.0;
  if (r <= a) return 4.0 * a / std::numbers::pi * elliptic(r * r / (a * a)).E;
  const double m = a * a / (r * r);
  const auto [K, E] = elliptic(m);
  return 4.0 * r / std::numbers::pi * (E - (1.0 - m) * K);
}

// A viscoelastic half-space in annuli of constant pressure, A p = u + tau u' + sum_k U_k: in each
// step the pressures are found that push nowhere in and pull nowhere.
class HalfSpace {
 public:
  HalfSpace(const Relaxation& relaxation, int annuli, double outer)
      : relaxation_(relaxation),
        r_(annuli),
        area_(annuli),
        A_(annuli, annuli),
        u_(VectorXd::Zero(annuli)),
        U_(relaxation.branches.size(), VectorXd::Zero(annuli)),
        touching_(static_cast<std::size_t>(annuli), 0) {
    const auto edge = [&](int i) { return outer * i / annuli; };
    for (int i = 0; i < annuli; ++i) {
      r_[i] = 0.5 * (edge(i) + edge(i + 1));
      area_[i] = std::numbers::pi * (edge(i + 1) * edge(i + 1) - edge(i) * edge(i));
      for (int j = 0; j < annuli; ++j)
        A_(i, j) = under_disc(edge(j + 1), r_[i]) - under_disc(edge(j), r_[i]);
    }
  }

  double step(double dt, double depth) {
    const VectorXd target = VectorXd::Constant(r_.size(), depth) - 0.5 * r_.cwiseProduct(r_);
    // A p = gain u + past at the step's end
    double gain = 1.0 + relaxation_.retardation_time / dt;
    VectorXd past = -relaxation_.retardation_time / dt * u_;
    for (std::size_t k = 0; k < U_.size(); ++k) {
      const auto [tau, b] = relaxation_.branches[k];
      const double g = b * tau / dt * -std::expm1(-dt / tau);
      gain += g;
      past += std::exp(-dt / tau) * U_[k] - g * u_;
    }
    VectorXd p, u;
    for (bool changed = true; changed;) {
      std::vector<int> at;
      for (int i = 0; i < r_.size(); ++i)
        if (touching_[static_cast<std::size_t>(i)]) at.push_back(i);
      p = VectorXd::Zero(r_.size());
      if (!at.empty()) {
        const MatrixXd within = A_(at, at);
        const VectorXd wanted = gain * target(at) + past(at);
        const VectorXd pressures = dense::least_squares(within, wanted);
        p(at) = pressures;
      }
      u = (A_ * p - past) / gain;
      changed = false;
      for (const int i : at)
        if (p[i] < 0.0) {
          touching_[static_cast<std::size_t>(i)] = 0;
          changed = true;
        }
      if (changed) continue;
      for (int i = 0; i < r_.size(); ++i)
        if (!touching_[static_cast<std::size_t>(i)] && u[i] < target[i] - 1e-15) {
          touching_[static_cast<std::size_t>(i)] = 1;
          changed = true;
        }
    }
    for (std::size_t k = 0; k < U_.size(); ++k) {
      const auto [tau, b] = relaxation_.branches[k];
      U_[k] = std::exp(-dt / tau) * U_[k] + b * tau / dt * -std::expm1(-dt / tau) * (u - u_);
    }
    u_ = u;
    return p.dot(area_);
  }

  [[nodiscard]] double surface_displacement_in_the_middle() const { return u_[0]; }

 private:
  Relaxation relaxation_;
  VectorXd r_, area_;
  MatrixXd A_;
  VectorXd u_;
  std::vector<VectorXd> U_;
  std::vector<char> touching_;
};

// The theory itself: nothing here knows of rings, t_1 or edges.
TEST(ViscousContact, IsWhatAHalfSpaceDoes) {
  const auto error = [](const Relaxation& relaxation, int annuli, int steps) {
    HalfSpace half_space(relaxation, annuli, 0.166);  // sqrt of somewhat more than the depth
    ViscousContact contact(relaxation);
    int apart = 0, growing = 0, shrinking = 0, returning = 0;
    double widest = 0.0;
    double worst = 0.0, largest = 0.0;
    for (int i = 1; i <= steps; ++i) {
      const double depth = restless(4.0 * i / steps);
      const double edge = contact.contact_depth();
      const double force = contact.step(4.0 / steps, depth, unit_phi(depth));
      worst = std::max(worst, std::abs(half_space.step(4.0 / steps, depth) - force));
      largest = std::max(largest, force);
      if (contact.contact_depth() > widest)
        ++growing;
      else if (contact.contact_depth() > edge)
        ++returning;
      else if (contact.contact_depth() < edge)
        ++shrinking;
      widest = std::max(widest, contact.contact_depth());
      if (contact.contact_depth() > 0.0) continue;
      ++apart;
      // The innermost annulus is not quite the middle.
      EXPECT_NEAR(half_space.surface_displacement_in_the_middle(), contact.surface_depth(), 1e-4)
          << i;
    }
    for (const int seen : {apart, growing, shrinking, returning}) EXPECT_GT(seen, steps / 10);
    return worst / largest;
  };
  for (const Relaxation& relaxation : solids()) {
    const double coarse = error(relaxation, 40, 800);
    const double fine = error(relaxation, 80, 800);
    EXPECT_LT(fine, 2e-4);          // an annulus has 1/80 of the radius
    EXPECT_LT(fine, 0.5 * coarse);  // and the error is theirs
  }
  // Its damper sees mean rates on either side, and edges that jump from annulus to annulus.
  EXPECT_LT(error({.branches = {}, .retardation_time = 0.1}, 80, 800), 3e-2);
}

}  // namespace
}  // namespace palpate::contact
