// The hand's motion. It is exact if force and intended acceleration are constant during a step.
#include "emulator/hand.h"

#include <algorithm>
#include <cmath>

namespace emulator {
namespace {

using Matrix = std::array<double, 4>;  // 2 x 2, by rows

Matrix product(const Matrix& a, const Matrix& b) {
  return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
          a[2] * b[1] + a[3] * b[3]};
}

// exp(A t) for y'' + (b/m) y' + (k/m) y = 0 with any damping: a Taylor series for a fraction of t,
// then squarings (Moler and Van Loan 2003, method 3). For a short step there are mostly none.
Matrix exponential(double k_over_m, double b_over_m, double t) {
  int squarings = 0;
  double part = t;
  for (; (1.0 + k_over_m + b_over_m) * part > 0.5; part *= 0.5) ++squarings;
  const Matrix a{0.0, part, -k_over_m * part, -b_over_m * part};
  Matrix sum{1.0, 0.0, 0.0, 1.0};
  Matrix term = sum;
  for (int n = 1; n <= 16; ++n) {  // 0.5^17 / 17! is below the last bit
    term = product(term, a);
    for (std::size_t i = 0; i < 4; ++i) sum[i] += (term[i] /= n);
  }
  for (; squarings > 0; --squarings) sum = product(sum, sum);
  return sum;
}

}  // namespace

// x(s) = x0 + (x1 - x0)(10 s^3 - 15 s^4 + 6 s^5), s from 0 to 1     Flash and Hogan 1985, eq. (3)
Intent intent_at(const HandSettings& settings, double t) {
  Waypoint from{0.0, settings.start};
  for (const Waypoint& to : settings.waypoints) {
    if (t >= to.at) {
      from = to;
      continue;
    }
    const double length = to.at - from.at;
    const double s = (t - from.at) / length;
    const double along = s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
    const double speed = 30.0 * s * s * (1.0 + s * (-2.0 + s)) / length;
    const double change = 60.0 * s * (1.0 + s * (-3.0 + 2.0 * s)) / (length * length);
    Intent intent{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double way = to.position[i] - from.position[i];
      intent.position[i] = from.position[i] + way * along;
      intent.velocity[i] = way * speed;
      intent.acceleration[i] = way * change;
    }
    return intent;
  }
  return {from.position, {}, {}};
}

Hand make_hand(const HandSettings& settings, double step) {
  Hand hand{.settings = settings,
            .step = step,
            .propagator = exponential(settings.stiffness / settings.mass,
                                      settings.damping / settings.mass, step)};
  hand.position = settings.start;
  return hand;
}

// With y = x - x_intent: m y'' + b y' + k y = F - m x_intent''. The offset from the equilibrium
// y = (F - m a)/k is multiplied by the propagator.
void move(Hand& hand, const Vec3& device_force, const Vec3& other_force) {
  const HandSettings& s = hand.settings;
  const Intent before = intent_at(s, hand.t);
  const Intent middle = intent_at(s, hand.t + 0.5 * hand.step);
  hand.t += hand.step;
  const Intent after = intent_at(s, hand.t);
  const auto& [p00, p01, p10, p11] = hand.propagator;
  for (std::size_t i = 0; i < 3; ++i) {
    const double force = device_force[i] + other_force[i];
    const double rest = (force - s.mass * middle.acceleration[i]) / s.stiffness;
    const double offset = hand.position[i] - before.position[i] - rest;
    const double speed = hand.velocity[i] - before.velocity[i];
    const double position = after.position[i] + rest + p00 * offset + p01 * speed;
    hand.work += device_force[i] * (position - hand.position[i]);
    hand.position[i] = position;
    hand.velocity[i] = after.velocity[i] + p10 * offset + p11 * speed;
  }
  hand.most_work = std::max(hand.most_work, hand.work);
  hand.most_energy = std::max(hand.most_energy, energy_of(hand));
}

void hold(Hand& hand) {
  hand.t += hand.step;
  hand.velocity = {};
}

double energy_of(const Hand& hand) {
  const Intent intent = intent_at(hand.settings, hand.t);
  double energy = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double offset = hand.position[i] - intent.position[i];
    energy += 0.5 * hand.settings.mass * hand.velocity[i] * hand.velocity[i] +
              0.5 * hand.settings.stiffness * offset * offset;
  }
  return energy;
}

}  // namespace emulator
