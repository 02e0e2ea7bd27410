// A mass with a damper under forces that are constant during each frame.
#include "stability/sampled_wall.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.h"

namespace palpate::stability {
namespace {

// The exact motion during one frame under a constant force.
struct Frame {
  double keep;          // factor of the velocity, exp(-b T / m)
  double glide;         // s, displacement per initial velocity
  double push, thrust;  // m/N and m/(s N), displacement and velocity per force

  explicit Frame(const Device& device) {
    const double time = device.sampled.frame;
    const double x = device.sampled.damping * time / device.mass;
    keep = std::exp(-x);
    // mean = (1 - e^-x) / x and rest = (1 - mean) / x, for small x by their series
    const double mean = x > 1e-4 ? -std::expm1(-x) / x : 1.0 - x / 2.0 + x * x / 6.0;
    const double rest = x > 1e-4 ? (1.0 - mean) / x : 0.5 - x / 6.0 + x * x / 24.0;
    glide = time * mean;
    push = time * time / device.mass * rest;
    thrust = time / device.mass * mean;
  }
  void pass(double force, double& place, double& speed) const {
    place += glide * speed + push * force;
    speed = keep * speed + thrust * force;
  }
};

}  // namespace

bool wall_gains_energy(const Device& device, double stiffness) {
  const Frame frame(device);
  const contact::SampledDevice& sampled = device.sampled;
  // At a stiffness that is e (relative) above the bound the energy grows at the rate e b / m: by
  // exp(6 e) from the second to the fourth quarter, 1.02 at e = 0.0033.
  const double settling = device.mass / (sampled.damping * sampled.frame);
  const int frames = static_cast<int>(std::clamp(12.0 * settling, 2000.0, 1e7));
  std::array<double, 4> greatest{};
  double place = 1e-3;
  double before = place;
  double speed = 0.0;
  const double first = 0.5 * stiffness * place * place;
  for (int i = 0; i < frames; ++i) {
    const double force =
        -stiffness * place - sampled.virtual_damping * (place - before) / sampled.frame;
    before = place;
    frame.pass(force, place, speed);
    const double energy = 0.5 * device.mass * speed * speed + 0.5 * stiffness * place * place;
    if (!(energy < 1e9 * first)) return true;
    double& most = greatest[as_index(4LL * i / frames)];
    most = std::max(most, energy);
  }
  return greatest[3] > 1e-20 * first && greatest[3] > 1.02 * greatest[1];
}

double chatter_share(const Device& device, double stiffness, const Push& push) {
  const Frame frame(device);
  double place = 0.0;
  double speed = 0.0;
  bool touching = false;
  int flips = 0;
  for (int i = 0; i < push.frames; ++i) {
    const bool touches = place > 0.0;
    if (2 * i >= push.frames && touches != touching) ++flips;
    touching = touches;
    frame.pass(push.force - (touches ? stiffness * place : 0.0), place, speed);
  }
  return 2.0 * flips / push.frames;
}

}  // namespace palpate::stability
