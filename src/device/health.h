// How a link did: latencies, misses, what the rules had to do. Filled in the loop, written after.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "device/arm_safety.h"
#include "device/safety.h"
#include "device/sample.h"

namespace palpate::device {

// Times by powers of two of a microsecond: bin 0 is below 1 us, bin n is 2^(n-1) us to 2^n us, the
// last one holds all that is longer.
class LatencyHistogram {
 public:
  static constexpr std::size_t bins = 28;  // the last from 67 s on
  void add(double time);                   // s; what is no number or below 0 counts in bin 0
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double longest() const { return longest_; }  // s
  [[nodiscard]] const std::array<std::uint64_t, bins>& counts() const { return counts_; }
  // s: the upper end of the bin that holds the `share` quantile; 0 where it is empty.
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
  LatencyHistogram lateness;  // of a frame's begin against its plan, s
  LatencyHistogram compute;   // our own time a frame, s
  std::uint64_t frames = 0;
  std::uint64_t deadline_misses = 0;  // frames that ended after the next one's begin
  std::uint64_t fresh = 0;
  std::uint64_t duplicates = 0;
  std::uint64_t dropped = 0;
  std::uint64_t missing = 0;  // frames in which nothing came
  double longest_gap = 0.0;   // s, between two fresh samples
  double least_energy = 0.0;  // J, of the passivity observer
  RuleCounts rules;
  std::array<std::uint64_t, fault_kinds> faults{};  // by Fault
  std::array<Transition, 64> transitions{};
  std::size_t transition_count = 0;  // may be more than are kept

  // One sample at `now` (s, since the start); allocates nothing.
  void count(double now, const Sample& sample);
  // Kept where the state is another one than before.
  void pass(const Transition& transition);

 private:
  double last_fresh_ = -1.0;
};

// The record of a link's health as JSON: who was there, limits, and all of the above.
[[nodiscard]] std::string health_json(const Identity& identity, const Limits& limits,
                                      const Traffic& traffic, const Health& health);

}  // namespace palpate::device
