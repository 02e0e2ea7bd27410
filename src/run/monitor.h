// Watches a run: energy in against energy stored and lost, and the first sign of instability.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"

namespace palpate::run {

class EnergyMonitor {
 public:
  explicit EnergyMonitor(const scene::SpringBody& body) : body_(&body) {}

  // Energy that is in the body without work of ours, such as that of a strain applied at once.
  void begin(const integrate::State& state);

  // Another body goes on from `state`, such as another part of the specimen: the energy that the
  // change brings or takes is not the motion's.
  void go_on(const scene::SpringBody& body, const integrate::State& state);

  // Accounts for a step under the loads (N) at its start and its end. Returns what is wrong where
  // the motion has left the stable: numbers that are not finite, or more energy than ever came in.
  [[nodiscard]] std::optional<std::string> step(const integrate::State& before,
                                                const integrate::State& after,
                                                const integrate::Vector& load_before,
                                                const integrate::Vector& load_after);

  // The same of a step whose numbers are known, J: work of the loads, what was lost, and what is
  // stored and kinetic after it.
  [[nodiscard]] std::optional<std::string> account(double work, double lost, double held);

  // Motion that keeps its own account: all work done on it, all that was lost, and what it holds,
  // J.
  void take_over(double work, double lost, double held);

  // |in - stored - lost| over the greatest energy so far; 0 where nothing moved.
  [[nodiscard]] double imbalance() const;

 private:
  const scene::SpringBody* body_;
  double given_ = 0.0;
  double work_ = 0.0;
  double lost_ = 0.0;
  double held_ = 0.0;      // stored and kinetic now
  double greatest_ = 0.0;  // energy that came in, at its highest
};

}  // namespace palpate::run
