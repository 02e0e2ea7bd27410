// The service's JSON: what a client says, what it is told.
#pragma once

#include <optional>
#include <string>

#include "emulator/hand.h"

namespace emulator {

enum class Service { v3_1, v3_5 };  // spells a force as `values`, as `vector`

// What one client message asks of the device.
struct Request {
  bool json = false;            // whether it was a JSON object at all
  std::optional<Vec3> force{};  // N, as commanded
  bool full_state = false;      // session.force_render_full_state
  std::string profile = {};     // session.configure.profile.name
  std::string remark = {};      // why a command was not taken, for the log
};

[[nodiscard]] Request parse_request(const std::string& text, Service service,
                                    const std::string& device_id);

struct ArmState {
  std::string device_id = {};
  Vec3 position{};
  Vec3 velocity{};
  Vec3 force{};
  std::string mode = "idle";
  bool ready = true;
  bool in_use = false;
};

enum class Extent { full, update };  // with config and session, or state and status only

// Oddities that faults ask for.
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

// GET /version and GET /devices.
[[nodiscard]] std::string version_body(Service service);

// An event of the events channel.
struct Event {
  std::string name = "device-safety-triggered";
  std::string level = {};
  std::string safety_type = {};  // may be empty
  std::string message = {};
};
[[nodiscard]] std::string event_message(const Event& event, const std::string& device_id);

}  // namespace emulator
