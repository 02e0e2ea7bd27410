// What a link reports: the identity and limits of the device, samples, faults, events, counts and
// times of replies.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "device/clock.h"

namespace palpate::device {

// With `look` nothing moves, no force except zero is sent, and no unit is changed; with `stop` a
// stand is told to stop as well, and nothing else.
enum class Purpose { look, command, stop };

enum class Kind { stand, arm, gauge, recording };

// The result of a call of sample().
enum class Arrival {
  fresh,      // a new sample
  duplicate,  // the same reply again
  none,       // nothing came within the time allowed; call again
  dropped,    // something came that is not a valid sample
  lost,       // the link is lost and stays lost
};

// Why a sample was dropped or doubted, or why a link is lost.
enum class Fault : std::uint8_t {
  none,
  garbage,          // bytes that are no reply
  truncated,        // a reply that did not end in time, or lacks its force line
  error_reply,      // the device answered with an error, such as `*10`
  unit_changed,     // the unit differs from that at the start; the force is converted
  overload,         // beyond what the gauge can measure
  not_finite,       // NaN, infinite, or beyond any device's reach
  missing_field,    // a reply without a position
  wrong_device,     // the reply is about a device with another id than at the start
  jump,             // a position farther away than the device can have moved
  brake,            // the device's own safety has acted
  stalled,          // an arm's service reports that a motor stalls
  unstable,         // an arm's service reports that its stability ceiling is reached
  not_verified,     // a setting read back with a value other than the one that was sent
  refused,          // a command that this link or its state does not allow
  hung_up,          // unplugged, closed or reset
  silent,           // no reply within the time allowed
  recording_ended,  // the end of a replayed file
  guarded,          // the stand was stopped by its guard process, or before a signal
  unguarded,        // the guard process of a stand has ended
  flooded,          // more came in one frame than can be read in it
  unknown_unit,     // a reading in a unit that is not known
  restarted,        // a gauge's own time went back
  clock_jumped,     // a gauge's own time went ahead of the link's
  reframed,         // an arm's service began to turn or scale its coordinates
};
inline constexpr std::size_t fault_kinds = as_index(Fault::reframed) + 1;
[[nodiscard]] const char* fault_text(Fault fault);  // a clause: "the device hung up"

// Position and velocity of a stand or a gauge are along z, upwards; those of an arm are in its
// coordinates.
struct Sample {
  Arrival arrival = Arrival::none;
  Fault fault = Fault::none;     // beside `fresh`: unit_changed, brake, stalled or unstable
  Vec3 position = Vec3::Zero();  // m
  Vec3 velocity = Vec3::Zero();  // m/s; of the stand, from its last two positions and times
  double force = nan;            // N, positive in compression; NaN if the link measures no force
  double received = 0.0;         // s, by the link's Clock
  double taken = nan;            // s, by the link's Clock: when the device measured; NaN if unknown
  double device_time = nan;      // s, by the device's clock; NaN if the device reports no time
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
};

struct Identity {
  Kind kind = Kind::stand;
  std::string id;                  // serial number or device id; empty if none is reported
  std::string model;               // as the device reports it
  std::string firmware;            // of the gauge, or of the service
  std::string dialect;             // variant of the protocol: "gauge in N", "vector", "values"
  std::vector<std::string> notes;  // sentences for people: what was found, set or assumed
};

// A limit that the device does not report is infinite.
struct Limits {
  static constexpr double none = std::numeric_limits<double>::infinity();
  bool measures_force = false;
  bool measures_travel = true;  // only a gauge may lack it: its position is then 0
  double force = none;          // N
  double speed = none;          // m/s
  double slowest = 0.0;         // m/s
  double low = -none;           // m, of travel, along z
  double high = none;           // m
  double period = 0.0;          // s, planned time between samples
  double stale_after = 0.0;     // s without a new sample
  double lost_after = 0.0;      // s without a new sample
  // N, of a gauge without travel: the force that tells that the loading history has begun.
  std::optional<double> start_force = {};
};

// Messages that an arm's service sends unasked.
enum class Event : std::uint8_t {
  other,          // neither about safety nor about the connection
  garbage,        // not a JSON object
  other_device,   // one of the kinds below, but about another device
  brake,          // the emergency brake has closed
  released,       // the emergency brake was released
  stage_raised,   // the safety stage changed towards higher risk
  stage_lowered,  // the safety stage changed towards lower risk
  stall,          // a motor stalls
  ceiling,        // the stability ceiling is reached
  safety,         // an unknown safety event with the level of a warning or higher
  notice,         // an unknown safety event with the level `info` or `notice`
  disconnected,   // the arm was disconnected
  busy,           // another session uses the arm
};
inline constexpr std::size_t event_kinds = as_index(Event::busy) + 1;
// The event's name in device_health.json: the service's own spelling if it has one.
[[nodiscard]] const char* event_text(Event event);
// The fault that the next sample reports after `event`. After hung_up the arm stays lost; brake,
// stalled and unstable trip the link; none means that the event is only counted.
[[nodiscard]] Fault fault_of(Event event);

struct Events {
  enum class Port : std::uint8_t {
    none,     // links of this kind have no events port
    unheard,  // no service answers on it, or the link's address has `none` for it
    heard,
    lost,  // it was open and has closed
  };
  Port port = Port::none;
  std::array<std::uint64_t, event_kinds> counts{};  // by Event
};

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

// Counts of the traffic on a link.
struct Traffic {
  std::uint64_t sent = 0;        // requests and commands that are answered by a reply
  std::uint64_t received = 0;    // replies
  std::uint64_t duplicates = 0;  // replies beyond one per request
  std::uint64_t late = 0;        // replies that came after a later request
  std::uint64_t unanswered = 0;  // requests whose reply is given up
  std::uint64_t discarded = 0;   // bytes that were not requested or found no room
  LatencyHistogram reply = {};   // s, from each request to its own reply, by the link's Clock
  Events events = {};
};

// What every link keeps.
class LinkParts {
 public:
  explicit LinkParts(Clock& clock) : clock_(clock) {}
  [[nodiscard]] const Identity& identity() const { return identity_; }
  [[nodiscard]] const Limits& limits() const { return limits_; }

 protected:
  [[nodiscard]] Sample finished(Arrival arrival, Fault fault) const {
    return {.arrival = arrival, .fault = fault, .received = clock_.now()};
  }

  Clock& clock_;
  Identity identity_;
  Limits limits_;
  Traffic traffic_;
  std::optional<Sample> last_;  // the last fresh sample
};

// A command to the stand's crosshead.
struct Motion {
  enum class Act { stop, up, down };
  Act act = Act::stop;
  double speed = 0.0;  // m/s, above 0 except for a stop
};

}  // namespace palpate::device
