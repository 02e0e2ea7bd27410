// A motorised stand with a force gauge on a serial line: position and force in, motion out.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "device/clock.h"
#include "device/mark10_protocol.h"
#include "device/sample.h"
#include "device/serial_port.h"
#include "device/stop_guard.h"

namespace palpate::device {

class Tap;

class Mark10 {
 public:
  // Opens the port, quiets the gauge, and asks who is there; for commands it also stops the stand
  // and sets N and mm. Takes about 0.3 s. Throws LinkError with a plain diagnosis.
  // `clock` outlives the link.
  Mark10(const std::string& port, Purpose purpose, Clock& clock, Tap* tap = nullptr);
  ~Mark10();
  Mark10(const Mark10&) = delete;
  Mark10& operator=(const Mark10&) = delete;

  [[nodiscard]] const Identity& identity() const { return identity_; }
  [[nodiscard]] const Limits& limits() const { return limits_; }

  // Asks for force and travel where that is not yet asked, and waits at most `wait` s.
  [[nodiscard]] Sample sample(double wait);

  // Puts travel limits (m, low < high) into the stand and reads them back, in limit mode. The
  // stand moves only after this has succeeded. not_verified, refused, silent or hung_up otherwise.
  [[nodiscard]] Fault set_travel_limits(double low, double high);

  // Starts a motion at a verified speed, or stops. Refused without travel limits, outside of the
  // stand's speeds, and in a link that is opened to look; not_verified where the stand has lost
  // its limits since, as by a reset. Takes a few ms.
  [[nodiscard]] Fault move(const Motion& motion);

  // Sends the stop at once, then asks whether it stands; true where that is confirmed.
  bool stop();

  [[nodiscard]] Traffic traffic() const;

 private:
  void greet();
  void quiet_gauge();
  void ask_gauge_who_it_is();
  void ask_stand_limits();
  [[noreturn]] void refuse_silence() const;

  void pass_time();
  [[nodiscard]] double patience(double time) const;
  bool send(std::string_view bytes);
  void receive(double until);
  void drain();
  std::optional<std::string> gauge(std::string_view command, double wait);
  // Sends a question once no other answer can be mistaken for its own.
  bool ask(std::string_view command);
  // The next line that comes till `until` (s, wire_time).
  std::optional<std::string_view> line_until(double until);
  std::optional<mark10::Status> ask_status();
  std::optional<mark10::Quantity> ask_number(std::string_view command);
  std::optional<mark10::Settings> ask_settings();
  bool stands_still();
  Fault compare_limits(double low, double high);
  Sample accept(const mark10::Pair& pair);
  [[nodiscard]] Sample finished(Arrival arrival, Fault fault) const;

  Clock& clock_;
  std::string path_;
  Purpose purpose_;
  SerialPort port_;
  std::unique_ptr<StopGuard> guard_;  // after the port: it writes before the port closes
  mark10::LineBuffer lines_;
  mark10::PairReader pairs_;
  Identity identity_;
  Limits limits_;
  double sign_ = 1.0;  // of a force that presses, as the gauge sends it
  std::array<char, 8> unit_{};
  bool limits_verified_ = false;
  bool asked_ = false;
  bool heard_ = false;          // anything since it was asked
  double asked_at_ = 0.0;       // s, wire time
  std::optional<Sample> last_;  // that was fresh
  Traffic traffic_;
  std::string first_bytes_;  // of the greeting, for a diagnosis
  bool greeting_ = true;
};

}  // namespace palpate::device
