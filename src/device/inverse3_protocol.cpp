// Reads replies with JsonScanner; the snapshot and version, which come once, with nlohmann json.
#include "device/inverse3_protocol.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "device/json_scanner.h"

namespace palpate::device::inverse3 {
namespace {

using Json = nlohmann::json;

constexpr double farthest = 10.0;  // m, beyond the reach of any arm
constexpr double fastest = 100.0;  // m/s

// {"x": , "y": , "z": }; nothing if a component is missing or is not a number.
std::optional<Vec3> read_vector(JsonScanner& scanner) {
  if (!scanner.enter('{')) {
    scanner.skip();
    return std::nullopt;
  }
  Vec3 vector = Vec3::Zero();
  unsigned seen = 0;
  while (const auto key = scanner.next_key()) {
    const int axis = *key == "x" ? 0 : *key == "y" ? 1 : *key == "z" ? 2 : -1;
    if (axis < 0) {
      scanner.skip();
    } else if (const auto value = scanner.number()) {
      vector[axis] = *value;
      seen |= 1u << axis;
    }
  }
  return seen == 7u ? std::optional(vector) : std::nullopt;
}

void read_state(JsonScanner& scanner, Reply& reply) {
  if (!scanner.enter('{')) return scanner.skip();
  while (const auto key = scanner.next_key()) {
    if (*key == "cursor_position") {
      reply.position = read_vector(scanner);
    } else if (*key == "cursor_velocity") {
      reply.velocity = read_vector(scanner);
    } else if (*key == "control_mode" || *key == "mode") {  // from 3.5 on, and before
      const auto mode = scanner.string();
      if (mode) reply.mode = *mode == "idle" ? Mode::idle : Mode::other;
    } else {
      scanner.skip();
    }
  }
}

// Sets Fault::brake if the status says that a brake acts or that the arm is not ready.
void read_status(JsonScanner& scanner, Reply& reply) {
  if (!scanner.enter('{')) return scanner.skip();
  while (const auto key = scanner.next_key()) {
    const bool good = *key == "ready" || *key == "calibrated";
    const bool bad = *key == "ebrake" || *key == "ebrake_triggered" || *key == "brake";
    if (!good && !bad) {
      scanner.skip();
    } else if (const auto value = scanner.boolean(); value && *value == bad) {
      reply.fault = Fault::brake;
    }
  }
}

// Reads one element of `inverse3`; true if it is the arm `id`. The id may come after the state, so
// that the whole element is read before `reply` is set.
bool read_arm(JsonScanner& scanner, std::string_view id, Reply& reply, bool& others) {
  if (!scanner.enter('{')) {
    scanner.skip();
    return false;
  }
  Reply one;
  bool ours = false;
  while (const auto key = scanner.next_key()) {
    if (*key == "device_id") {
      const auto name = scanner.string();
      ours = name == id;
      others = others || !ours;
    } else if (*key == "state") {
      read_state(scanner, one);
    } else if (*key == "status") {
      read_status(scanner, one);
    } else {
      scanner.skip();
    }
  }
  if (ours) reply = one;
  return ours;
}

bool within(const std::optional<Vec3>& vector, double most) {
  return !vector || (std::isfinite(vector->squaredNorm()) && vector->norm() <= most);
}

const Json* member(const Json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

// A string or number member of a JSON object, as text; empty if there is none.
std::string text_of(const Json* object, const char* name) {
  const Json* value = object != nullptr ? member(*object, name) : nullptr;
  if (value == nullptr) return {};
  return value->is_string() ? value->get<std::string>()
                            : (value->is_number() ? value->dump() : std::string());
}

}  // namespace

std::string_view spelling_text(Spelling spelling) {
  return spelling == Spelling::vector ? "vector" : "values";
}

std::string parse_version(std::string_view body) {
  const Json all = Json::parse(body, nullptr, false);
  const Json* data = member(all, "data");
  if (data == nullptr) data = &all;
  for (const char* name : {"project_version", "git_tag", "version"}) {
    std::string version = text_of(data, name);
    if (!version.empty() && version.size() < 64) return version;
  }
  return {};
}

Spelling spelling_of(std::string_view version) {
  int major = 0;
  int minor = 0;
  const char* end = version.data() + version.size();
  const auto first = std::from_chars(version.data(), end, major);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '.') return Spelling::vector;
  if (std::from_chars(first.ptr + 1, end, minor).ec != std::errc()) return Spelling::vector;
  return major > 3 || (major == 3 && minor >= 5) ? Spelling::vector : Spelling::values;
}

bool usable_id(std::string_view id) {
  return !id.empty() && id.size() < 32 && std::all_of(id.begin(), id.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '_';
  });
}

std::optional<Snapshot> parse_snapshot(std::string_view message) {
  const Json all = Json::parse(message, nullptr, false);
  if (!all.is_object()) return std::nullopt;
  Snapshot snapshot;
  const Json* arms = member(all, "inverse3");
  if (arms == nullptr || !arms->is_array()) return snapshot;
  for (const Json& one : *arms) {
    Arm arm;
    arm.id = text_of(&one, "device_id");
    if (!usable_id(arm.id)) continue;
    const Json* config = member(one, "config");
    const Json* info = config != nullptr ? member(*config, "device_info") : nullptr;
    arm.model = text_of(config, "type");
    const std::string major = text_of(info, "major_version");
    const std::string minor = text_of(info, "minor_version");
    if (!major.empty() && !minor.empty()) arm.firmware = major + "." + minor;
    snapshot.arms.push_back(arm);
  }
  return snapshot;
}

Reply parse_reply(std::string_view message, std::string_view id) {
  Reply reply;
  JsonScanner scanner(message);
  bool found = false;
  bool others = false;
  if (!scanner.enter('{')) {
    reply.fault = Fault::garbage;
    return reply;
  }
  while (const auto key = scanner.next_key()) {
    if (*key == "inverse3" && scanner.enter('[')) {
      while (scanner.next_element()) found = read_arm(scanner, id, reply, others) || found;
    } else {
      scanner.skip();
    }
  }
  if (!scanner.at_end()) return {.fault = Fault::garbage};
  if (!found) return {.fault = others ? Fault::wrong_device : Fault::missing_field};
  if (!within(reply.position, farthest) || !within(reply.velocity, fastest))
    return {.fault = Fault::not_finite};
  if (!reply.position && reply.fault == Fault::none) reply.fault = Fault::missing_field;
  return reply;
}

Message force_message(std::string_view id, Spelling spelling, const Vec3& force) {
  Message message;
  const auto add = [&](std::string_view text) {
    const std::size_t size = std::min(text.size(), message.bytes.size() - message.size);
    std::copy_n(text.data(), size, message.bytes.data() + message.size);
    message.size += size;
  };
  const auto add_number = [&](double value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    add({digits.data(), as_index(end.ptr - digits.data())});
  };
  const Vec3 sent = force.allFinite() ? force : Vec3::Zero();
  add(R"({"inverse3":[{"device_id":")");
  add(id);
  add(R"(","commands":{"set_cursor_force":{")");
  add(spelling_text(spelling));
  add(R"(":{"x":)");
  add_number(sent.x());
  add(R"(,"y":)");
  add_number(sent.y());
  add(R"(,"z":)");
  add_number(sent.z());
  add("}}}}]}");
  return message;
}

}  // namespace palpate::device::inverse3
