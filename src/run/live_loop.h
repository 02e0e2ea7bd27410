// What the two loops, of a stand and of an arm, have in common.
#pragma once

#include <atomic>
#include <limits>
#include <optional>
#include <string>

#include "device/clock.h"
#include "device/health.h"
#include "device/link.h"
#include "device/safety.h"
#include "run/live_log.h"
#include "run/live_model.h"
#include "scene/scene.h"

namespace palpate::run {

struct LiveOptions {
  std::string link;
  enum class Act { look, command };
  Act act = Act::look;
  device::Clock::Kind clock = device::Clock::Kind::monotonic;
  enum class Priority { ordinary, realtime };
  Priority priority = Priority::ordinary;
  // m, where the undeformed surface is, along the device's z; empty: a stand feels for it, under an
  // arm it lies `below_hand` below where the hand is at first, a recording has it at 0.
  std::optional<double> surface;
  enum class Traffic { unheard, kept };
  Traffic traffic = Traffic::unheard;
  std::optional<double> most_force;                          // N; empty: the rules' own
  double longest = std::numeric_limits<double>::infinity();  // s
  static constexpr double below_hand = 0.020;                // m
};

// Everything a loop uses; made before it starts.
struct LiveLoop {
  const scene::Scene& scene;
  const LiveOptions& options;
  device::Link& link;
  device::Clock& clock;
  LiveModel& model;
  LiveLog& log;
  device::Health& health;
  const std::atomic<bool>& stop;
  std::uint64_t softened = 0;  // frames of an arm, in which the tissue was shown less stiff
  double left_out = 0.0;       // s, of late frames of an arm, that its model did not pass through
};

// How a loop ended.
struct LiveEnd {
  enum class Why {
    done,         // the programme is over
    too_long,     // LiveOptions::longest
    interrupted,  // by a signal
    link,         // lost, or stopped for safety
    model,        // cannot follow any further
  };
  Why why = Why::done;
  std::string sentence;  // without an end; empty where it is done
};

// The hand moves, the model's force is sent; of a recording nothing is sent. Until the programme,
// as guidance, is over.
[[nodiscard]] LiveEnd run_arm(LiveLoop& loop);

// The programme moves the stand, the model follows what the stand says.
[[nodiscard]] LiveEnd run_stand(LiveLoop& loop);

// The ceilings that hold without LiveOptions::most_force, N.
[[nodiscard]] double most_force(const LiveOptions& options, device::Kind kind);

// A sentence on a link that ended the run.
[[nodiscard]] LiveEnd ended_by_link(device::Trip trip, device::Fault fault);

}  // namespace palpate::run
