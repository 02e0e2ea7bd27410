// Statistics of a live run: late frames, missing samples, faults and actions of the safety rules.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "device/safety.h"
#include "device/sample.h"

namespace palpate::device {

enum class LinkState : std::uint8_t { open, armed, stale, tripped, lost, closed };

struct Transition {
  double time = 0.0;  // s, since the start
  LinkState to = LinkState::open;
  Trip why = Trip::none;
  Fault fault = Fault::none;
};

struct Health {
  LatencyHistogram lateness;  // actual minus planned start of a frame, s
  LatencyHistogram compute;   // palpate's computing time per frame, s
  std::uint64_t frames = 0;
  std::uint64_t deadline_misses = 0;  // planned frame starts that were missed
  std::uint64_t fresh = 0;
  std::uint64_t duplicates = 0;
  std::uint64_t dropped = 0;
  std::uint64_t missing = 0;  // frames without any reply
  double longest_gap = 0.0;   // s, without a fresh sample, also up to the end of the run
  double least_energy = 0.0;  // J, PassivityObserver::least
  RuleCounts rules;
  std::array<std::uint64_t, fault_kinds> faults{};  // by Fault
  std::size_t transition_count = 0;                 // may exceed the number of transitions kept

  // Counts one sample at `now` (s, since the start); allocates nothing.
  void count(double now, const Sample& sample);
  // No more samples are taken from `now` (s, since the start) on: the time without one ends here.
  void end_of_samples(double now);
  // Stores the transition if its state differs from that of the last one.
  void pass(const Transition& transition);

  // The first and the last transitions, in order: those between them are only counted.
  [[nodiscard]] std::vector<Transition> transitions() const;

  // Frames without a new sample: duplicate, dropped or missing.
  [[nodiscard]] std::uint64_t without_sample() const { return duplicates + dropped + missing; }

 private:
  static constexpr std::size_t first_kept = 48;
  static constexpr std::size_t last_kept = 16;
  std::array<Transition, first_kept> first_{};
  std::array<Transition, last_kept> last_{};  // a ring
  LinkState state_ = LinkState::open;         // of the last transition, if there is one
  double last_fresh_ = 0.0;                   // s; the first frame, as long as no sample has come
};

// Sentences for a run in which more than 1 % of the frames had no new sample, or a sample that was
// too old for the safety rules.
[[nodiscard]] std::vector<std::string> health_warnings(const Health& health);

// Sentences for people on an events port that closed and on all events that were counted, except
// `other`.
[[nodiscard]] std::vector<std::string> event_sentences(const Events& events);

// The text of device_health.json: identity, limits, traffic and the statistics above.
[[nodiscard]] std::string health_json(const Identity& identity, const Limits& limits,
                                      const Traffic& traffic, const Health& health);

}  // namespace palpate::device
