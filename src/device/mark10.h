// The link to a motorised stand with a force gauge on a serial line.
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

class Mark10 : public LinkParts {
 public:
  // Opens the port, ends the gauge's automatic output, and reads identity and settings. With
  // Purpose::command it also stops the stand, sets N and mm, and starts a guard process. Takes
  // about 0.3 s. With Purpose::stop it only sends a stop, also on a port that another palpate
  // holds. Throws LinkError with a diagnosis. `clock` and `tap` must outlive the link.
  Mark10(const std::string& port, Purpose purpose, Clock& clock, Tap* tap = nullptr);
  ~Mark10();
  Mark10(const Mark10&) = delete;
  Mark10& operator=(const Mark10&) = delete;

  // Requests force and travel unless a request is pending, and waits at most `wait` s for them. The
  // fault `guarded` says that the stand was stopped since the last sample by the guard process or
  // before a signal; `unguarded`, with which the link is lost, that the guard process has died.
  [[nodiscard]] Sample sample(double wait);

  // Switches to limit mode, writes travel limits (m, low < high) into the stand, reads them back.
  // The stand moves only after the result none; others are not_verified, refused, silent, hung_up.
  [[nodiscard]] Fault set_travel_limits(double low, double high);

  // Starts a motion after its speed was read back, or stops. Returns refused without travel limits,
  // outside the stand's speeds and with Purpose::look; not_verified if the stand has lost its
  // limits, for example by a reset; silent or hung_up. Takes a few ms.
  [[nodiscard]] Fault move(const Motion& motion);

  // Sends a stop at once and then asks for the status; true if the stand has confirmed the stop.
  // With Purpose::look it sends nothing and returns true.
  bool stop();

  [[nodiscard]] Traffic traffic() const;

 private:
  static constexpr double answer_time = 0.25;  // s, to wait for a reply other than a reading

  void greet();
  void quiet_gauge();
  void ask_gauge_who_it_is();
  void ask_stand_limits();
  void refuse_without_pc_control();
  [[noreturn]] void refuse_silence() const;
  [[nodiscard]] std::string moving_note(const char* way) const;

  Sample read_sample(double wait);
  bool was_stopped();
  void pass_time();
  [[nodiscard]] double patience(double time) const;
  bool send(std::string_view bytes);
  void receive(double until);
  void drain();
  std::optional<std::string> gauge(std::string_view command, double wait);
  // Sends a request, after a reading that is still pending, so that replies cannot be confused.
  bool ask(std::string_view command);
  // The next line that arrives until `until` (s, wire_time()).
  std::optional<std::string_view> line_until(double until);
  std::optional<mark10::Status> ask_status();
  std::optional<mark10::Quantity> ask_number(std::string_view command);
  std::optional<mark10::Settings> ask_settings();
  bool confirm_stop();
  // Whether two readings of the travel, `time` s apart, are equal.
  static void pause(double time);  // s, of the machine's clock
  bool stands_still(double time);
  Fault compare_limits(double low, double high);
  Sample accept(const mark10::Pair& pair);
  bool is_late();
  void give_up();

  std::string path_;
  Purpose purpose_;
  SerialLines serial_;
  // Both are declared after the port, because they write before the port closes.
  std::unique_ptr<GuardProcess> process_;
  std::unique_ptr<StopGuard> guard_;
  unsigned signals_ = 0;  // StopGuard::signals_passed() at the last sample
  mark10::PairReader pairs_;
  double sign_ = 1.0;  // of a compressive force, as the gauge sends it
  std::array<char, 8> unit_{};
  bool limits_verified_ = false;
  bool asked_ = false;          // a reading was requested and has not arrived
  bool heard_ = false;          // bytes have arrived since that request
  bool heard_late_ = false;     // a reply since that request was taken for an earlier one's
  double asked_at_ = 0.0;       // s, wire_time() of that request
  bool has_status_ = true;      // the stand replies to `p`
  double asked_time_ = 0.0;     // s, likewise by clock_
  std::size_t reply_size_ = 0;  // bytes of the lines since that request
  // Times (s, by clock_) of requests that were given up, whose replies may still come; the oldest
  // first.
  std::array<double, 8> owed_{};
  std::size_t owed_count_ = 0;
};

}  // namespace palpate::device
