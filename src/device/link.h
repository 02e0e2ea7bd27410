// A link to a device of any kind: stand, gauge, arm or recording; the LINK texts that name them;
// and a recorded run as a link, which returns the same samples at the same times in every run.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "device/clock.h"
#include "device/sample.h"

namespace palpate::device {

// Reads a recording: CSV text with one header row, a column `time_s` that never decreases, the
// position as `position_x_m`, `position_y_m`, `position_z_m` or as `travel_mm` (positive downwards,
// as in force_indentation.csv), and `force_N` if force was measured; other columns are ignored.
// Velocities are differences of the rows. Throws InputError with file and line.
[[nodiscard]] std::vector<Sample> parse_recording(std::string_view text, const std::string& file);

class Recording : public LinkParts {
 public:
  // `clock` must outlive the link; a stepped clock is advanced to the time of each sample.
  Recording(const std::string& file, Clock& clock);

  static bool stop() { return true; }  // nothing moves

  [[nodiscard]] Traffic traffic() const { return traffic_; }

  // Returns each row once, when its time since the first row has passed since the first call; waits
  // for that at most `wait` s. After the last row the link is lost with recording_ended.
  [[nodiscard]] Sample sample(double wait);

 private:
  std::vector<Sample> rows_;
  std::size_t next_ = 0;
  double start_ = 0.0;  // s, when the first row's time was 0
};

class Tap;

class Link {
 public:
  // Opens the device that a LINK text names. Throws InputError if the text or a recording is wrong,
  // and LinkError with a diagnosis if the device does not answer. `clock` and `tap` must outlive
  // the link; `tap` receives a copy of all bytes, from the opening of the link on.
  Link(std::string_view text, Purpose purpose, Clock& clock, Tap* tap = nullptr);
  ~Link();
  Link(Link&&) noexcept;

  [[nodiscard]] const Identity& identity() const;
  [[nodiscard]] const Limits& limits() const;
  [[nodiscard]] Traffic traffic() const;

  // Returns the next sample if one comes within `wait` s of real time; with 0 it does not wait.
  // Allocates nothing. The arm sends one sample per message that it receives: after each sample,
  // send a force (zero if need be) to obtain the next one.
  [[nodiscard]] Sample sample(double wait);

  // Sends the force (N, in the coordinates of `position`) that the arm is to exert on the hand. A
  // force that is not finite is sent as zero. Returns `refused` for a link that takes no force, and
  // for an arm opened with Purpose::look unless the force is zero.
  [[nodiscard]] Fault command_force(const Vec3& force);

  // Limits (m) and motion of the stand's crosshead; see Mark10. Other links return `refused`.
  [[nodiscard]] Fault set_travel_limits(double low, double high);
  [[nodiscard]] Fault command_motion(const Motion& motion);

  // The last lines of a gauge on a serial line, each with what it says; empty for other links.
  [[nodiscard]] std::vector<std::string> heard() const;

  // Stops motion and force. True if the stand confirms it, or if the arm's link is not lost after a
  // zero force was sent. Does nothing and returns true for a stand opened with Purpose::look.
  bool stop();

 private:
  struct Variant;
  std::unique_ptr<Variant> link_;
};

struct StandAddress {
  std::string port;  // path of a serial line: /dev/ttyUSB0
};
struct GaugeAddress {
  std::string port;      // path of a serial line
  std::string settings;  // path of a TOML file: line_gauge.h
};
struct ArmAddress {
  std::string host;
  int port = 0;
  std::optional<int> events = 10020;  // port of the service's events; none: events are ignored
  std::string id = {};                // of the arm, if the service has several; empty: the first
};
struct RecordingAddress {
  std::string file;
};
using Address = std::variant<StandAddress, GaugeAddress, ArmAddress, RecordingAddress>;

// Reads `mark10:PORT`, `serial:PORT,SETTINGS.toml`, `inverse3:HOST:PORT[:EVENTS][/ID]` (an IPv6
// host is written in brackets; EVENTS is a port or `none`) or `replay:FILE.csv`. Throws InputError
// with examples of these forms.
[[nodiscard]] Address parse_link(std::string_view text);

// Whether the device can neither be moved nor be given a force, so that a run need not be armed.
[[nodiscard]] bool only_reads(const Address& address);

// The forms of all links, for help texts: "mark10:PORT, ... or replay:FILE.csv".
[[nodiscard]] std::string link_forms();

}  // namespace palpate::device
