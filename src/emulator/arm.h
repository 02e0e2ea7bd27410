// The emulated haptic arm with its service and a hand; messages are texts, without a socket.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/arm_messages.h"
#include "emulator/faults.h"
#include "emulator/hand.h"
#include "emulator/log.h"
#include "emulator/serial_device.h"
#include "emulator/tissue.h"

namespace emulator {

struct ArmSettings {
  Service service = Service::v3_5;
  Clock clock = Clock::real;
  Nanoseconds period = 1'000'000;  // virtual clock: the time that one client message takes
  double idle_after = 0.1;         // s, real clock: time without messages until the force ends
  double force_limit = 10.0;       // N, of the vector's length
  std::string device_id = "049D";
  ArmForm form = {};
  HandSettings hand = {};
  std::optional<TissueSettings> tissue = {};  // pushes the hand up, independently of the client
  std::vector<Fault> faults = {};
};

// The tables [hand], [[waypoint]] and [device].
void fields(palpate::FieldVisitor& visitor, ArmSettings& settings);
// Reads these tables; keys that the file does not name keep their values. Throws InputError.
void read_hand(const std::string& path, ArmSettings& settings);

enum class Act { none, reset_connection, close_normal, close_error, restart };

struct Outgoing {
  std::string text;
  bool binary = false;
  Nanoseconds delay = 0;  // real time
};

struct Answer {
  std::vector<Outgoing> messages = {};
  Act act = Act::none;
};

inline constexpr std::int64_t hand_rate = 8000;  // time steps per second

class Arm {
 public:
  Arm(const ArmSettings& settings, Log& log);

  // Returns the first message to a new client, a full snapshot.
  [[nodiscard]] Outgoing greet();
  // Answers one client message. A virtual clock advances by a period, in which the new force acts.
  [[nodiscard]] Answer answer(const std::string& text);
  // Real clock: advances to `now` without a message. Returns an action if a fault requires one.
  [[nodiscard]] Act pass(Nanoseconds now);
  // The last client has disconnected: ends the force.
  void leave();

  [[nodiscard]] bool silent() const;  // fault half_open: neither reads nor sends
  [[nodiscard]] std::string devices() const;
  [[nodiscard]] std::vector<std::string> take_events();
  [[nodiscard]] bool take_events_end();  // true once if the events' connections must be reset
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
  double greatest_force_ = 0;  // N, applied to the hand
  Vec3 force_{};               // N, applied to the hand
  std::string mode_ = "idle";
  int session_ = 1;
  bool in_use_ = false;
  bool braked_ = false;
  Act wanted_ = Act::none;
  std::optional<ArmState> frozen_ = {};
  std::optional<Outgoing> held_ = {};  // the reply that the fault `reorder` holds back
  std::vector<std::string> events_ = {};
  bool events_end_ = false;
};

}  // namespace emulator
