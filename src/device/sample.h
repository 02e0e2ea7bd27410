// What a live link says: who is there, what it allows, and one sample of position and force.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec3.h"

namespace palpate::device {

// What a link is opened for. To look at it, nothing moves, no force but zero is sent, and no unit
// is changed.
enum class Purpose { look, command };

enum class Kind { stand, arm, recording };

// What a sample() call brought.
enum class Arrival {
  fresh,      // a new sample
  duplicate,  // the same reply once more
  none,       // nothing within the time allowed; ask again
  dropped,    // something that is no valid sample
  lost,       // the link is gone and stays so
};

// Why a sample was dropped or doubted, or why a link is lost.
enum class Fault : std::uint8_t {
  none,
  garbage,          // bytes that are no reply
  truncated,        // a reply that did not end in time
  error_reply,      // the device refused: `*10` and its like
  unit_changed,     // another unit than at the start; converted
  overload,         // beyond what the gauge can measure
  not_finite,       // NaN, infinite, or beyond any device's reach
  missing_field,    // a reply without a position
  wrong_device,     // another device's id than at the start
  jump,             // farther than the device can have gone
  brake,            // the device's own safety has acted
  stalled,          // an arm's service says that a motor stalls
  unstable,         // an arm's service says that its stability ceiling is reached
  not_verified,     // a setting that did not read back as it was set
  refused,          // a command this link or its state does not allow
  hung_up,          // unplugged, closed or reset
  silent,           // no answer for longer than the link may be silent
  recording_ended,  // the end of a replayed file
};
inline constexpr std::size_t fault_kinds = static_cast<std::size_t>(Fault::recording_ended) + 1;
[[nodiscard]] std::string_view fault_text(Fault fault);  // a clause: "the device hung up"

// Position and velocity of the stand's crosshead are along z, up; of the arm in its own frame.
struct Sample {
  Arrival arrival = Arrival::none;
  Fault fault = Fault::none;     // may be set beside `fresh`: unit_changed, overload, brake
  Vec3 position = Vec3::Zero();  // m
  Vec3 velocity = Vec3::Zero();  // m/s; of the stand, a difference of its last two positions
  double force = nan;            // N, pressing is positive; NaN where the link measures none
  double received = 0.0;         // s, our clock
  double device_time = nan;      // s, the device's clock; NaN where it tells none
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
};

struct Identity {
  Kind kind = Kind::stand;
  std::string id;                  // serial number or device id; empty where the device tells none
  std::string model;               // as the device says it
  std::string firmware;            // of the gauge, or of the service
  std::string dialect;             // what we speak with it: "gauge in N", "vector", "values"
  std::vector<std::string> notes;  // sentences for people: what was found, set or assumed
};

// Infinite where the device states no limit.
struct Limits {
  static constexpr double none = std::numeric_limits<double>::infinity();
  bool measures_force = false;
  bool takes_motion = false;
  bool takes_force = false;
  double force = none;       // N
  double speed = none;       // m/s
  double slowest = 0.0;      // m/s
  double low = -none;        // m, of travel, along z
  double high = none;        // m
  double period = 0.0;       // s, between samples as planned
  double stale_after = 0.0;  // s without a new sample
  double lost_after = 0.0;   // s without a new sample
};

// What an arm's service tells by itself: device/events.h.
enum class Event : std::uint8_t {
  other,          // of no concern here
  garbage,        // no JSON object
  other_device,   // of safety, but about another device
  brake,          // the emergency brake holds
  released,       // it was let go
  stage_raised,   // its stage of safety changed towards risk
  stage_lowered,  // and back
  stall,          // a motor stalls
  ceiling,        // the stability ceiling is reached
  safety,         // of a kind that is not known here, a warning or worse
  notice,         // of a kind that is not known here, nothing to worry about
  disconnected,   // the arm is gone
  busy,           // another session uses the arm
};
inline constexpr std::size_t event_kinds = static_cast<std::size_t>(Event::busy) + 1;
struct Events {
  enum class Port : std::uint8_t {
    none,     // the link has none
    unheard,  // nobody serves it, or the link's address says not to listen
    heard,
    lost,  // it was heard and closed
  };
  Port port = Port::none;
  std::array<std::uint64_t, event_kinds> counts{};  // by Event
};

// What went over the wire, of which a link keeps count.
struct Traffic {
  std::uint64_t sent = 0;        // requests or commands that ask for a reply
  std::uint64_t received = 0;    // replies
  std::uint64_t duplicates = 0;  // replies that came once too often
  std::uint64_t discarded = 0;   // bytes that nobody asked for
  Events events = {};
};

// What the stand is told to do.
struct Motion {
  enum class Act { stop, up, down };
  Act act = Act::stop;
  double speed = 0.0;  // m/s, above 0 unless it is a stop
};

}  // namespace palpate::device
