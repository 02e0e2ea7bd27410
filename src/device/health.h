// Statistics of a link: latencies, missed frames, faults and actions of the safety rules.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "device/arm_safety.h"
#include "device/safety.h"
#include "device/sample.h"

namespace palpate::device {

// Histogram of times in powers of two of a microsecond: bin 0 contains times below 1 us, bin n
// those from 2^(n-1) us to 2^n us, and the last bin all longer times.
class LatencyHistogram {
 public:
  static constexpr std::size_t bins = 28;  // the last begins at 67 s
  void add(double time);                   // s; NaN and times below 0 are counted in bin 0
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double longest() const { return longest_; }  // s
  [[nodiscard]] const std::array<std::uint64_t, bins>& counts() const { return counts_; }
  // s: the upper end of the bin that contains the quantile `share`; 0 for an empty histogram.
  [[nodiscard]] double quantile(double share) const;
  [[nodiscard]] static double upper_end(std::size_t bin);  // s

 private:
  std::array<std::uint64_t, bins> counts_{};
  std::uint64_t count_ = 0;
  double longest_ = 0.0;
};

enum class LinkState : std::uint8_t { open, armed, stale, tripped, lost, closed };
[[nodiscard]] const char* link_state_text(LinkState state);

struct Transition {
  double time = 0.0;  // s, since the start
  LinkState to = LinkState::open;
  Trip why = Trip::none;
  Fault fault = Fault::none;
};

struct Health {
  LatencyHistogram reply;     // from request to reply, s
  LatencyHistogram lateness;  // actual minus planned start of a frame, s
  LatencyHistogram compute;   // palpate's computing time per frame, s
  std::uint64_t frames = 0;
  std::uint64_t deadline_misses = 0;  // planned frame starts that were missed
  std::uint64_t fresh = 0;
  std::uint64_t duplicates = 0;
  std::uint64_t dropped = 0;
  std::uint64_t missing = 0;  // frames without any reply
  double longest_gap = 0.0;   // s, between two fresh samples
  double least_energy = 0.0;  // J, PassivityObserver::least
  RuleCounts rules;
  std::array<std::uint64_t, fault_kinds> faults{};  // by Fault
  std::array<Transition, 64> transitions{};
  std::size_t transition_count = 0;  // may exceed the number of transitions stored

  // Counts one sample at `now` (s, since the start); allocates nothing.
  void count(double now, const Sample& sample);
  // Stores the transition if its state differs from that of the last one.
  void pass(const Transition& transition);

 private:
  double last_fresh_ = -1.0;
};

// The text of device_health.json: identity, limits, traffic and the statistics above.
[[nodiscard]] std::string health_json(const Identity& identity, const Limits& limits,
                                      const Traffic& traffic, const Health& health);

}  // namespace palpate::device
