// Options, context and result shared by the two loops, of a stand and of an arm.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "device/clock.h"
#include "device/health.h"
#include "device/link.h"
#include "device/safety.h"
#include "live/log.h"
#include "live/model.h"
#include "scene/scene.h"

namespace palpate::live {

constexpr double stepped_wait = 1.0;  // s of wire time, for a reply in lock-step

struct LiveOptions {
  std::string link;
  enum class Act { look, command };
  Act act = Act::look;
  device::Clock::Kind clock = device::Clock::Kind::monotonic;
  enum class Priority { ordinary, realtime };
  Priority priority = Priority::ordinary;
  // m, position of the undeformed surface along the device's z. If empty, a stand feels for it, for
  // an arm it is `below_hand` below the first position of the hand, and for a recording it is 0.
  std::optional<double> surface;
  enum class Traffic { unheard, kept };
  Traffic traffic = Traffic::unheard;
  std::optional<double> most_force;                          // N; empty: the default of the rules
  double longest = std::numeric_limits<double>::infinity();  // s, for the whole run
  static constexpr double below_hand = 0.020;                // m
};

// Readings of the gauge out of contact, before the loading history: the first ones.
struct FreeReadings {
  std::array<double, 256> force{};  // N
  std::size_t count = 0;
  void add(double reading) {  // allocates nothing
    if (count < force.size()) force[count++] = reading;
  }
};

// All objects that a loop uses, created before it starts.
struct LiveLoop {
  const scene::Scene& scene;
  const LiveOptions& options;
  device::Link& link;
  device::Clock& clock;
  LiveModel& model;
  LiveLog& log;
  device::Health& health;
  const std::atomic<bool>& stop;
  std::function<void(const std::string&)> say = {};  // gauge: tells the person at it
  std::uint64_t softened = 0;  // arm: number of frames with a stiffness reduced for passivity
  FreeReadings free = {};      // stand
  double moved_until = std::numeric_limits<double>::infinity();  // gauge: s; then it was waited for
  std::vector<std::string> warnings = {};                        // about what the device showed
  double dropped = 0.0;  // arm: s, time of late frames by which the model was not advanced
};

// How a loop ended.
struct LiveEnd {
  enum class Why {
    done,         // the loading history is over
    too_long,     // LiveOptions::longest, or the end of a recording
    interrupted,  // by a signal
    link,         // lost, or stopped for safety
    model,        // the model diverged or its law does not apply
  };
  Why why = Why::done;
  std::string sentence;  // the reason, without a full stop; may be empty if done
};

// Runs an arm until its person has carried out the loading history: the hand moves, the model
// follows, and the model's force is sent. A recording is followed likewise, without sending.
[[nodiscard]] LiveEnd run_arm(LiveLoop& loop);

// Runs a gauge: a person moves it, and the model follows the travel in its lines. Without travel
// only the forces are written: from the contact on, which Limits::start_force tells, for the time
// that the loading history takes.
[[nodiscard]] LiveEnd run_gauge(LiveLoop& loop);

// Runs a stand: the loading history moves it, and the model follows its measured position.
[[nodiscard]] LiveEnd run_stand(LiveLoop& loop);

// The ceiling of the force, N: LiveOptions::most_force, or the default for this kind of device.
[[nodiscard]] double most_force(const LiveOptions& options, device::Kind kind);

// The end of a run by its link, with a sentence that explains trip and fault.
[[nodiscard]] LiveEnd ended_by_link(device::Trip trip, device::Fault fault);

}  // namespace palpate::live
