// The emulated haptic arm with its service and a hand; messages are texts, without a socket.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/faults.h"
#include "emulator/files.h"
#include "emulator/serial_device.h"
#include "emulator/tissue.h"

namespace emulator {

using Vec3 = std::array<double, 3>;

struct Waypoint {
  double at;      // s, time of arrival
  Vec3 position;  // m
};

// The emulated hand: a mass on a damped spring whose other end follows an intended path.
struct HandSettings {
  double mass = 0.15;        // kg, of hand and arm at the grip
  double stiffness = 300.0;  // N/m
  double damping = 6.0;      // N s/m
  Vec3 start = {0.0, -0.12, 0.15};
  std::vector<Waypoint> waypoints = {};
};

// The other end of the spring.
struct Intent {
  Vec3 position;      // m
  Vec3 velocity;      // m/s
  Vec3 acceleration;  // m/s^2
};

// The minimum-jerk path, with rest at each waypoint. It begins at `start` at t = 0.
[[nodiscard]] Intent intent_at(const HandSettings& settings, double t);

struct Hand {
  HandSettings settings;
  double step;                       // s
  std::array<double, 4> propagator;  // 2 x 2 by rows: offset and its velocity after one step
  double t = 0;                      // s
  Vec3 position{};                   // m
  Vec3 velocity{};                   // m/s
  double work = 0;                   // J, done on the hand by the device so far
  double most_work = 0;              // J, the largest value of `work` so far
  double most_energy = 0;            // J, the largest value of energy_of() so far
};

[[nodiscard]] Hand make_hand(const HandSettings& settings, double step);

// Advances by one step under constant forces (N) of the device and of other bodies. The work of
// the device is exact: force times displacement.
void move(Hand& hand, const Vec3& device_force, const Vec3& other_force);
void hold(Hand& hand);  // advances by one step in which the arm is locked and does not move
[[nodiscard]] double energy_of(const Hand& hand);  // J, kinetic and spring

enum class Service { v3_1, v3_5 };  // the name of a force is `values` or `vector`

// The content of one client message.
struct Request {
  bool json = false;            // whether the message is a JSON object
  std::optional<Vec3> force{};  // N, as commanded
  bool full_state = false;      // session.force_render_full_state
  std::string warning = {};     // why a command was ignored, for the log
};

// How the service shows the device, as found in the field.
struct ArmForm {
  std::string basis = "XYZ";
  double mount_scale = 1.0;
  double mount_turn = 0.0;       // rad, about x
  double transform_scale = 1.0;  // of the state
  bool both_modes = false;       // `mode` beside `control_mode`, left at `idle`
  bool grips = false;            // two grips come before the arms
  bool numeric_id = false;       // the id is a JSON number
  std::string second_id = {};    // of a second arm, which comes first; empty: none
  bool calibrated = true;
  bool power = true;
};

struct ArmState {
  std::string device_id = {};
  Vec3 position{};
  Vec3 velocity{};
  Vec3 force{};
  std::string mode = "idle";
  bool ready = true;
  bool in_use = false;
  ArmForm form = {};
};

[[nodiscard]] Request parse_request(const std::string& text, Service service,
                                    const std::string& device_id, const ArmForm& form);

enum class Extent { full, update };  // with config and session, or with state and status only

// Defects of a message that faults request.
struct Oddity {
  bool missing_field = false;
  bool wrong_type = false;
  bool no_device = false;
  bool second_device = false;
  bool nan = false;
  bool huge = false;
};

[[nodiscard]] std::string state_message(const ArmState& state, Service service, Extent extent,
                                        int session);
[[nodiscard]] std::string odd_message(const ArmState& state, Service service, const Oddity& oddity);

// The body of the reply to `GET /version`.
[[nodiscard]] std::string version_body(Service service);

struct Event {
  std::string name = "device-safety-triggered";
  std::string level = {};
  std::string safety_type = {};  // may be empty
  std::string message = {};
};
[[nodiscard]] std::string event_message(const Event& event, const std::string& device_id);

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
  [[nodiscard]] ArmState state() const;
  [[nodiscard]] ArmState told();  // as faults show it
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

struct ArmRun {
  ArmSettings settings = {};
  int port = 0;         // 0: any free port
  int events_port = 0;  // of the read-only events channel
  std::string log = {};
  std::optional<double> lifetime = {};  // s, real time; none: until SIGINT or SIGTERM
};

// Runs the arm's service on sockets of 127.0.0.1. Prints one JSON line with the ports, and one with
// a summary at the end. Returns the exit code; throws InputError if a port cannot be opened.
int run_inverse3(const ArmRun& run);

}  // namespace emulator
