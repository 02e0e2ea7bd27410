// The haptic arm behind its service, without a socket: messages in, messages out, and a hand.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/arm_messages.h"
#include "emulator/faults.h"
#include "emulator/hand.h"
#include "emulator/log.h"
#include "emulator/mark10.h"
#include "emulator/tissue.h"

namespace emulator {

struct ArmSettings {
  Service service = Service::v3_5;
  Clock clock = Clock::real;
  Nanoseconds period = 1'000'000;        // lockstep: what one client message takes
  Nanoseconds idle_after = 100'000'000;  // real: silence after which it lets go
  double force_limit = 10.0;             // N, of the vector's length
  std::string device_id = "049D";
  HandSettings hand = {};
  std::optional<TissueSettings> tissue = {};  // pushes the hand up by itself, below its `surface`
  std::vector<Fault> faults = {};
};

// Tables [hand], [[waypoint]] and [device] of a file. Throws `Refused`.
void read_hand(const std::string& path, ArmSettings& settings);

enum class Act { none, reset_connection, close_normal, close_error, restart };

struct Outgoing {
  std::string text;
  bool binary = false;
  Nanoseconds delay = 0;  // by the machine's clock
};

struct Answer {
  std::vector<Outgoing> messages = {};
  Act act = Act::none;
};

inline constexpr std::int64_t hand_rate = 8000;  // steps a second

class Arm {
 public:
  Arm(const ArmSettings& settings, Log& log);

  // What a new client is sent first: all there is.
  [[nodiscard]] Outgoing greet();
  // One client message: advances a virtual clock by a period with the new force at work.
  [[nodiscard]] Answer answer(const std::string& text);
  // Real clock: what happens up to now without a message. Faults may want something done.
  [[nodiscard]] Act pass(Nanoseconds now);
  // The last client went: no force.
  void leave();

  [[nodiscard]] bool silent() const;  // half open: neither reads nor sends
  [[nodiscard]] std::string devices() const;
  [[nodiscard]] std::vector<std::string> take_events();
  [[nodiscard]] bool take_events_end();  // whether the events' connections are to be reset
  [[nodiscard]] const Hand& hand() const { return hand_; }
  [[nodiscard]] const Vec3& force() const { return force_; }
  [[nodiscard]] std::int64_t messages() const { return messages_; }
  [[nodiscard]] Nanoseconds now() const { return now_; }
  [[nodiscard]] std::string summary() const;
  void log_state() { log_row("state", ""); }

 private:
  void go_to(Nanoseconds time, std::int64_t messages);
  void run_to(Nanoseconds time);
  void begin_faults(std::int64_t messages);
  void begin_event(const std::string& kind);
  void let_go();
  void command(const Request& request);
  [[nodiscard]] ArmState told();
  [[nodiscard]] Outgoing reply(const Request& request);
  [[nodiscard]] std::string spoilt(std::string text);
  void log_row(const char* kind, const std::string& text);

  ArmSettings settings_;
  Hand hand_;
  std::optional<Tissue> tissue_ = {};
  Faults faults_;
  Log* log_;
  Nanoseconds now_ = 0;
  Nanoseconds last_message_ = 0;
  std::int64_t steps_ = 0;
  std::int64_t messages_ = 0;
  std::int64_t clamped_ = 0;
  double greatest_force_ = 0;  // N, applied
  Vec3 force_{};               // N, applied
  std::string mode_ = "idle";
  int session_ = 1;
  bool in_use_ = false;
  bool braked_ = false;
  Act wanted_ = Act::none;
  std::optional<ArmState> frozen_ = {};
  std::optional<Outgoing> held_ = {};  // by a reorder
  std::vector<std::string> events_ = {};
  bool events_end_ = false;
};

}  // namespace emulator
