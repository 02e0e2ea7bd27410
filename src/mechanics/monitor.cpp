// The energy balance, step by step.
#include "mechanics/monitor.h"

#include <algorithm>
#include <cmath>

#include "integrate/wide_loops.h"

namespace palpate::mechanics {

void EnergyMonitor::begin(const integrate::State& state) {
  given_ = body_->stored(state) + body_->kinetic(state);
  held_ = given_;
  greatest_ = given_;
}

void EnergyMonitor::go_on(const scene::SpringBody& body, const integrate::State& state) {
  body_ = &body;
  const double now = body.stored(state) + body.kinetic(state);
  given_ += now - held_;
  held_ = now;
  greatest_ = std::max(greatest_, given_ + work_);
}

std::optional<std::string> EnergyMonitor::step(const integrate::State& before,
                                               const integrate::State& after,
                                               const integrate::Vector& load_before,
                                               const integrate::Vector& load_after) {
  const double work = integrate::wide::work(as_index(after.displacement.size()), load_before.data(),
                                            load_after.data(), before.displacement.data(),
                                            after.displacement.data());
  take_over(work_ + work, lost_ + body_->dissipated(before, after),
            body_->stored(after) + body_->kinetic(after));
  if (!std::isfinite(held_) || !std::isfinite(work_)) return not_finite;
  // Near the stability limit the energy of the highest mode oscillates by the factor
  // 1 / (1 - (omega dt / 2)^2), 5 at 0.9 of the limit; a factor above 10 is a real growth.
  constexpr double swing = 10.0;
  if (held_ > swing * greatest_ && held_ > 1e-30) return energy_grew;
  return std::nullopt;
}

void EnergyMonitor::take_over(double work, double lost, double held) {
  work_ = work;
  lost_ = lost;
  held_ = held;
  greatest_ = std::max(greatest_, given_ + work_);
}

double EnergyMonitor::imbalance() const {
  if (greatest_ <= 0.0) return 0.0;
  return std::abs(given_ + work_ - held_ - lost_) / greatest_;
}

}  // namespace palpate::mechanics
