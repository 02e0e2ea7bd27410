// The energy balance of a mesh, docs/theory.md [balance], which also detects instability.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"

namespace palpate::mechanics {

// Sentences on runs that end early, each with a remedy.
inline constexpr const char* not_finite =
    "the motion is no longer finite; take a smaller `solver.time_step`, and no "
    "`solver.allow_unstable`";
inline constexpr const char* energy_grew =
    "energy grew without input; take a smaller `solver.time_step`, and no `solver.allow_unstable`";
// Whether a run ended with one of the two above, in which the motion itself is wrong.
[[nodiscard]] inline bool tells_instability(const std::string& sentence) {
  return sentence == not_finite || sentence == energy_grew;
}
inline constexpr const char* not_positive =
    "the tangent stiffness is not positive; press less deep, or take a smaller `solver.time_step`";

class EnergyMonitor {
 public:
  explicit EnergyMonitor(const scene::SpringBody& body) : body_(&body) {}

  // Counts the energy of `state` as given, for example that of a strain applied at once.
  void begin(const integrate::State& state);

  // Continues with another body, such as another part of the specimen, at `state`; the difference
  // in energy is counted as given.
  void go_on(const scene::SpringBody& body, const integrate::State& state);

  // Accounts for a step under the loads (N) at its start and its end. Returns a sentence if the
  // motion is unstable: a number is not finite, or stored plus kinetic energy exceeds ten times the
  // largest energy that was ever put in.
  [[nodiscard]] std::optional<std::string> step(const integrate::State& before,
                                                const integrate::State& after,
                                                const integrate::Vector& load_before,
                                                const integrate::Vector& load_after);

  // Replaces the sums by those of a method that adds them up itself (modal steps), J: all work, all
  // dissipated energy, and stored plus kinetic energy now.
  void take_over(double work, double lost, double held);

  // The energy imbalance of docs/theory.md [balance], a fraction; 0 if no energy was ever put in.
  [[nodiscard]] double imbalance() const;

 private:
  const scene::SpringBody* body_;
  double given_ = 0.0;  // J, as the next ones
  double work_ = 0.0;
  double lost_ = 0.0;
  double held_ = 0.0;      // stored plus kinetic energy now
  double greatest_ = 0.0;  // largest value of given_ + work_ so far
};

}  // namespace palpate::mechanics
