// JSON of the Inverse service, from its pages 3.1 and 3.5: websocket-protocol, control-commands,
// http, events. This is the only file of the emulator that uses nlohmann's JSON.
#include "emulator/arm.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace emulator {
namespace {

using Json = nlohmann::ordered_json;

Json vec(const Vec3& v) { return {{"x", v[0]}, {"y", v[1]}, {"z", v[2]}}; }
Json angles() { return {{"a0", 0.0}, {"a1", 0.0}, {"a2", 0.0}}; }
Json unit_quaternion() { return {{"w", 1.0}, {"x", 0.0}, {"y", 0.0}, {"z", 0.0}}; }

const char* spelling(Service service) { return service == Service::v3_1 ? "values" : "vector"; }

Json pose(double turn, double scale) {
  return {{"position", vec({})},
          {"rotation",
           {{"w", std::cos(turn / 2.0)}, {"x", std::sin(turn / 2.0)}, {"y", 0.0}, {"z", 0.0}}},
          {"scale", vec({scale, scale, scale})}};
}

Json id_of(const std::string& id, const ArmForm& form) {
  return form.numeric_id ? Json::parse(id, nullptr, false) : Json(id);
}

Json state_of(const ArmState& state, Service service) {
  if (service == Service::v3_1)  // no forces on the 3.1 page, and the mode is called `mode`
    return {{"angular_position", angles()},           {"angular_velocity", angles()},
            {"body_orientation", unit_quaternion()},  {"cursor_position", vec(state.position)},
            {"cursor_velocity", vec(state.velocity)}, {"mode", state.mode}};
  Json newer{{"cursor_position", vec(state.position)},
             {"cursor_velocity", vec(state.velocity)},
             {"angular_position", angles()},
             {"angular_velocity", angles()},
             {"body_orientation", unit_quaternion()},
             {"current_cursor_force", vec(state.force)},
             {"current_cursor_position", vec({})},
             {"current_angular_torques", angles()},
             {"current_angular_position", angles()},
             {"control_domain", "cartesian"},
             {"control_mode", state.mode},
             {"transform", pose(0.0, state.form.transform_scale)}};
  if (state.form.both_modes) newer["mode"] = "idle";
  return newer;
}

Json config_of(const ArmState& state, Service service) {
  Json info{{"major_version", 7}, {"minor_version", 4}, {"id", state.device_id}};
  info[service == Service::v3_1 ? "model" : "device_type"] = 4;
  info["uuid"] = "2D35F80DD9005F599B68F49944CB" + state.device_id;
  Json config{{"type", "inverse3"},
              {"port", "emulated"},
              {"device_info", info},
              {"extended_device_id", info["uuid"]},
              {"extended_firmware_version", "00000000000000000000000000000000"},
              {"gravity_compensation", {{"enabled", true}, {"scaling_factor", 1.0}}},
              {"handedness", "right"},
              {"torque_scaling", {{"enabled", true}}}};
  if (service == Service::v3_1) return config;
  config["streaming_mode"] = "USB";
  config["home_return"] = {{"enabled", false}};
  config["preset"] = "defaults";
  config["basis"] = {{"permutation", state.form.basis}};
  config["mount"] = pose(state.form.mount_turn, state.form.mount_scale);
  config["filters"] = {{"force_gate", {{"gain", 0.3}}}, {"damping", {{"scalar", 0.0}}}};
  return config;
}

Json status_of(const ArmState& state) {
  return {{"calibrated", state.ready && state.form.calibrated},
          {"in_use", state.in_use},
          {"power_supply", state.form.power},
          {"ready", state.ready},
          {"started", true}};
}

Json device_of(const ArmState& state, Service service, Extent extent) {
  Json device{{"device_id", id_of(state.device_id, state.form)}};
  if (extent == Extent::full) device["config"] = config_of(state, service);
  device["state"] = state_of(state, service);
  device["status"] = status_of(state);
  return device;
}

std::optional<Vec3> vector_in(const Json& from) {
  if (!from.is_object()) return {};
  Vec3 v{};
  constexpr std::array names{"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = from.find(names[i]);
    if (at == from.end() || !at->is_number()) return {};
    v[i] = at->get<double>();
  }
  return v;
}

void read_force(const Json& commands, Service service, Request& request) {
  const auto command = commands.find("set_cursor_force");
  if (command == commands.end() || !command->is_object()) return;
  auto vector = command->find(spelling(service));
  // 3.5 takes the older word as well.
  if (vector == command->end() && service == Service::v3_5) vector = command->find("values");
  if (vector == command->end()) {
    request.warning = std::string("no `") + spelling(service) + "` in set_cursor_force";
    return;
  }
  const auto force = vector_in(*vector);
  if (!force) {
    request.warning = "set_cursor_force wants numbers x, y, z";
    return;
  }
  if (!request.force) request.force.emplace(Vec3{});
  for (std::size_t i = 0; i < 3; ++i) (*request.force)[i] += (*force)[i];  // forces are added
}

}  // namespace

Request parse_request(const std::string& text, Service service, const std::string& device_id,
                      const ArmForm& form) {
  Request request;
  const Json message = Json::parse(text, nullptr, false);
  request.json = message.is_object();
  if (!request.json) {
    request.warning = "no JSON object";
    return request;
  }
  const auto session = message.find("session");
  if (session != message.end() && session->is_object())
    request.full_state = session->contains("force_render_full_state");
  const auto devices = message.find("inverse3");
  if (devices == message.end() || !devices->is_array()) return request;
  for (const Json& device : *devices) {
    if (!device.is_object() || !device.contains("commands")) continue;
    if (device.value("device_id", Json()) != id_of(device_id, form)) {
      request.warning = "no such device";
      continue;
    }
    if (device["commands"].is_object()) read_force(device["commands"], service, request);
  }
  return request;
}

std::string state_message(const ArmState& state, Service service, Extent extent, int session) {
  Json message;
  if (state.form.grips)
    message["verse_grip"] = {{{"device_id", "12"}, {"state", {{"hall", 0}}}},
                             {{"device_id", 7}, {"status", {{"calibrated", false}}}}};
  if (extent == Extent::full && service == Service::v3_5) message["session_id"] = session;
  message["inverse3"] = Json::array();
  if (!state.form.second_id.empty()) {
    ArmState other = state;
    other.device_id = state.form.second_id;
    other.position = other.velocity = other.force = {};
    message["inverse3"].push_back(device_of(other, service, extent));
  }
  message["inverse3"].push_back(device_of(state, service, extent));
  if (extent == Extent::full && !state.form.grips) message["verse_grip"] = Json::array();
  if (extent == Extent::full) message["wireless_verse_grip"] = Json::array();
  return message.dump();
}

std::string odd_message(const ArmState& state, Service service, const Oddity& oddity) {
  Json device = device_of(state, service, Extent::update);
  Json& position = device["state"]["cursor_position"];
  if (oddity.huge) position["z"] = 1e308;
  if (oddity.wrong_type)
    for (const char* axis : {"x", "y", "z"}) position[axis] = position[axis].dump();
  if (oddity.nan) position["z"] = "NaN";
  if (oddity.missing_field) device["state"].erase("cursor_position");
  Json devices = Json::array();
  if (oddity.second_device) {
    ArmState other = state;
    other.device_id = "0BAD";
    other.position = other.velocity = {};
    devices.push_back(device_of(other, service, Extent::update));
  }
  if (!oddity.no_device) devices.push_back(device);
  std::string text = Json{{"inverse3", devices}}.dump();
  const auto quoted = text.find("\"NaN\"");  // not found if the field is missing as well
  if (quoted != std::string::npos) text.replace(quoted, 5, "NaN");
  return text;
}

std::string version_body(Service service) {
  const std::string version = service == Service::v3_1 ? "3.1.0" : "3.5.0";
  return Json{{"build_time", "2024-08-07T16:01:53Z"},
              {"git_branch", "main"},
              {"git_describe", version + "-0-g00000000"},
              {"git_hash", "00000000"},
              {"git_tag", version},
              {"project_name", "haply-inverse-service"},
              {"project_version", version + ".0"}}
      .dump();
}

std::string event_message(const Event& event, const std::string& device_id) {
  Json data{{"device_family", "inverse"}, {"device_id", device_id}};
  if (!event.safety_type.empty()) data["safety_type"] = event.safety_type;
  return Json{{"name", event.name},
              {"category", "device"},
              {"level", event.level},
              {"data", data},
              {"message", event.message}}
      .dump();
}

}  // namespace emulator
