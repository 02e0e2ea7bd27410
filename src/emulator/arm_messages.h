// The service's JSON: requests of a client, and the messages that it receives.
#pragma once

#include <optional>
#include <string>

#include "emulator/hand.h"

namespace emulator {

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

}  // namespace emulator
