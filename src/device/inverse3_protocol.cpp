// Reads replies and events with JsonScanner; the snapshot and version, which come once, with
// nlohmann json.
#include "device/inverse3_protocol.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "device/serial_port.h"

namespace palpate::device::inverse3 {

void JsonScanner::space() {
  while (at_ < text_.size() &&
         (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
    ++at_;
}

bool JsonScanner::take(char c) {
  space();
  if (failed_ || peek() != c || at_ == text_.size()) return false;
  ++at_;
  return true;
}

bool JsonScanner::take_word(std::string_view word) {
  if (!text_.substr(at_).starts_with(word)) return false;
  at_ += word.size();
  return true;
}

bool JsonScanner::enter(char bracket) {
  if (!take(bracket)) return false;
  if (++depth_ > deepest) fail();
  first_ = true;
  return !failed_;
}

// Reads the comma before a member or element, unless it is the first; false at the closing `end`.
bool JsonScanner::separator(char end) {
  if (failed_) return false;
  if (take(end)) {
    --depth_;
    first_ = false;
    return false;
  }
  if (!first_ && !take(',')) {
    fail();
    return false;
  }
  first_ = false;
  return true;
}

std::optional<std::string_view> JsonScanner::next_key() {
  if (!separator('}')) return std::nullopt;
  space();
  const auto key = raw_string();
  if (!key || !take(':')) {
    fail();
    return std::nullopt;
  }
  return key;
}

bool JsonScanner::next_element() { return separator(']'); }

std::optional<std::string_view> JsonScanner::raw_string() {
  if (peek() != '"' || at_ == text_.size()) return std::nullopt;
  const std::size_t start = ++at_;
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '"') return text_.substr(start, at_++ - start);
    if (static_cast<unsigned char>(c) < 0x20) break;
    if (c == '\\') ++at_;
  }
  fail();
  return std::nullopt;
}

std::optional<double> JsonScanner::raw_number() {
  const std::size_t start = at_;
  const auto digits = [this] {
    const std::size_t from = at_;
    while (is_digit(peek())) ++at_;
    return at_ > from;
  };
  if (peek() == '-') ++at_;
  const bool zero = peek() == '0';
  bool good = digits() && !(zero && at_ - start > (text_[start] == '-' ? 2u : 1u));
  if (good && peek() == '.') {
    ++at_;
    good = digits();
  }
  if (good && (peek() == 'e' || peek() == 'E')) {
    ++at_;
    if (peek() == '+' || peek() == '-') ++at_;
    good = digits();
  }
  double value = 0.0;
  if (good) {
    const auto read = std::from_chars(text_.data() + start, text_.data() + at_, value);
    // 1e400 is valid JSON but not a double.
    if (read.ec == std::errc::result_out_of_range) return std::nullopt;
    good = read.ec == std::errc() && read.ptr == text_.data() + at_;
  }
  if (!good) {
    fail();
    return std::nullopt;
  }
  return value;
}

std::optional<double> JsonScanner::number() {
  space();
  if (failed_) return std::nullopt;
  if (peek() == '-' || is_digit(peek())) return raw_number();
  skip();
  return std::nullopt;
}

std::optional<std::string_view> JsonScanner::string() {
  space();
  if (failed_) return std::nullopt;
  if (peek() == '"') return raw_string();
  skip();
  return std::nullopt;
}

std::optional<std::string_view> JsonScanner::word() {
  space();
  const std::size_t start = at_;
  if (peek() == '"') return string();
  if (!number()) return std::nullopt;
  return text_.substr(start, at_ - start);
}

std::optional<bool> JsonScanner::boolean() {
  space();
  if (failed_) return std::nullopt;
  if (take_word("true")) return true;
  if (take_word("false")) return false;
  skip();
  return std::nullopt;
}

void JsonScanner::skip() {
  space();
  if (failed_) return;
  if (enter('{')) {
    while (next_key()) skip();
  } else if (enter('[')) {
    while (next_element()) skip();
  } else if (peek() == '"') {
    raw_string();
  } else if (peek() == '-' || is_digit(peek())) {
    raw_number();
  } else if (!take_word("true") && !take_word("false") && !take_word("null")) {
    fail();
  }
}

bool JsonScanner::at_end() {
  space();
  return !failed_ && depth_ == 0 && at_ == text_.size();
}

namespace {

using Json = nlohmann::json;

constexpr double farthest = 10.0;  // m, beyond the reach of any arm
constexpr double fastest = 100.0;  // m/s

// {"x": , "y": , "z": }; nothing if a component is missing or is not a number.
std::optional<Vec3> read_vector(JsonScanner& scanner) {
  Vec3 vector = Vec3::Zero();
  unsigned seen = 0;
  scanner.object([&](std::string_view key) {
    const int axis = key == "x" ? 0 : key == "y" ? 1 : key == "z" ? 2 : -1;
    if (axis < 0) return false;
    if (const auto value = scanner.number()) {
      vector[axis] = *value;
      seen |= 1u << axis;
    }
    return true;
  });
  return seen == 7u ? std::optional(vector) : std::nullopt;
}

constexpr double same = 1e-6;  // of a rotation or a scale: no difference

// Whether {"position": , "rotation": {"w": , "x": ...}, "scale": {"x": ...}} turns or scales.
bool read_framed(JsonScanner& scanner) {
  bool framed = false;
  scanner.object([&](std::string_view key) {
    const bool turn = key == "rotation";
    if (!turn && key != "scale") return false;
    if (const auto vector = read_vector(scanner))
      framed = framed || (vector->array() - (turn ? 0.0 : 1.0)).abs().maxCoeff() > same;
    return true;
  });
  return framed;
}

void read_state(JsonScanner& scanner, Reply& reply) {
  bool newer = false;
  scanner.object([&](std::string_view key) {
    if (key == "cursor_position") {
      reply.position = read_vector(scanner);
    } else if (key == "cursor_velocity") {
      reply.velocity = read_vector(scanner);
    } else if (key == "control_mode" || key == "mode") {  // from 3.5 on, and before
      // Services in between have both words, and the older one may be left behind.
      const bool counts = key == "control_mode" || !newer;
      newer = newer || key == "control_mode";
      const auto mode = scanner.string();
      if (mode && counts) reply.mode = *mode == "idle" ? Mode::idle : Mode::other;
    } else if (key == "transform") {
      reply.framed = read_framed(scanner);
    } else {
      return false;
    }
    return true;
  });
}

// Sets Fault::brake if the status says that a brake acts, or that the arm is not ready or has no
// power.
void read_status(JsonScanner& scanner, Reply& reply) {
  scanner.object([&](std::string_view key) {
    const bool good = key == "ready" || key == "calibrated" || key == "power_supply";
    const bool bad = key == "ebrake" || key == "ebrake_triggered" || key == "brake";
    if (!good && !bad) return false;
    if (const auto value = scanner.boolean(); value && *value == bad) reply.fault = Fault::brake;
    return true;
  });
}

// Reads one element of `inverse3`; true if it is the arm `id`. The id may come after the state, so
// that the whole element is read before `reply` is set.
bool read_arm(JsonScanner& scanner, std::string_view id, Reply& reply, bool& others) {
  Reply one;
  bool ours = false;
  scanner.object([&](std::string_view key) {
    if (key == "device_id") {
      const auto name = scanner.word();
      ours = name == id;
      others = others || !ours;
    } else if (key == "state") {
      read_state(scanner, one);
    } else if (key == "status") {
      read_status(scanner, one);
    } else {
      return false;
    }
    return true;
  });
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

// What of a pose (position, rotation, scale) is not the identity: added to the arm's frame.
void add_frame(const Json* pose, const std::string& name, Arm& arm) {
  if (pose == nullptr) return;
  const auto farthest_from = [&](const char* part, double plain) {
    double most = 0.0;
    const Json* vector = member(*pose, part);
    if (vector == nullptr) return most;
    for (const char* axis : {"x", "y", "z"})
      if (const Json* value = member(*vector, axis); value != nullptr && value->is_number())
        most = std::max(most, std::abs(value->get<double>() - plain));
    return most;
  };
  const auto add = [&](const std::string& what) {
    arm.frame += (arm.frame.empty() ? "" : ", ") + what;
  };
  if (farthest_from("rotation", 0.0) > same) add("a " + name + " that turns");
  if (farthest_from("scale", 1.0) > same) add("a " + name + " that scales");
  arm.shifted = arm.shifted || farthest_from("position", 0.0) > 0.0;
}

bool is_false(const Json* object, const char* name) {
  const Json* value = object != nullptr ? member(*object, name) : nullptr;
  return value != nullptr && value->is_boolean() && !value->get<bool>();
}

struct Version {
  int major = 0;
  int minor = 0;
};
// Nothing if the text does not begin with two numbers and a point between them.
std::optional<Version> version_of(std::string_view text) {
  Version version;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, version.major);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '.') return std::nullopt;
  if (std::from_chars(first.ptr + 1, end, version.minor).ec != std::errc()) return std::nullopt;
  return version;
}

bool is_new(const Version& version) {
  return version.major > 3 || (version.major == 3 && version.minor >= 5);
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
  const auto known = version_of(version);
  return !known || is_new(*known) ? Spelling::vector : Spelling::values;
}

bool has_probe(std::string_view version) {
  const auto known = version_of(version);
  return known && is_new(*known);
}

bool usable_id(std::string_view id) {
  return !id.empty() && id.size() < 32 && std::ranges::all_of(id, [](char c) {
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
    if (const Json* id = member(one, "device_id"); id->is_number()) arm.form = IdForm::number;
    const Json* config = member(one, "config");
    const Json* info = config != nullptr ? member(*config, "device_info") : nullptr;
    arm.model = text_of(config, "type");
    const std::string major = text_of(info, "major_version");
    const std::string minor = text_of(info, "minor_version");
    if (!major.empty() && !minor.empty()) arm.firmware = major + "." + minor;
    const Json* basis = config != nullptr ? member(*config, "basis") : nullptr;
    const std::string permutation = text_of(basis, "permutation");
    if (!permutation.empty() && permutation != "XYZ")
      arm.frame = "the basis `" + printable(permutation) + "`";
    const Json* state = member(one, "state");
    add_frame(config != nullptr ? member(*config, "mount") : nullptr, "mount", arm);
    add_frame(state != nullptr ? member(*state, "transform") : nullptr, "transform", arm);
    const Json* status = member(one, "status");
    arm.calibrated = !is_false(status, "calibrated");
    arm.powered = !is_false(status, "power_supply");
    snapshot.arms.push_back(arm);
  }
  return snapshot;
}

Reply parse_reply(std::string_view message, std::string_view id) {
  Reply reply;
  JsonScanner scanner(message);
  bool found = false;
  bool others = false;
  const bool is_object = scanner.object([&](std::string_view key) {
    if (key != "inverse3" || !scanner.enter('[')) return false;
    while (scanner.next_element()) found = read_arm(scanner, id, reply, others) || found;
    return true;
  });
  if (!is_object || !scanner.at_end()) return {.fault = Fault::garbage};
  if (!found) return {.fault = others ? Fault::wrong_device : Fault::missing_field};
  if (!within(reply.position, farthest) || !within(reply.velocity, fastest))
    return {.fault = Fault::not_finite};
  if (!reply.position && reply.fault == Fault::none) reply.fault = Fault::missing_field;
  return reply;
}

namespace {

void add(Message& message, std::string_view text) {
  const std::size_t size = std::min(text.size(), message.bytes.size() - message.size);
  std::copy_n(text.data(), size, message.bytes.data() + message.size);
  message.size += size;
}

void add_number(Message& message, double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  add(message, {digits.data(), as_index(end.ptr - digits.data())});
}

Message begun_message(std::string_view id, IdForm form) {
  const std::string_view quote = form == IdForm::text ? "\"" : "";
  Message message;
  for (const std::string_view part : {std::string_view(R"({"inverse3":[{"device_id":)"), quote, id,
                                      quote, std::string_view(R"(,"commands":{)")})
    add(message, part);
  return message;
}

}  // namespace

Message force_message(std::string_view id, Spelling spelling, const Vec3& force, IdForm form) {
  Message message = begun_message(id, form);
  const Vec3 sent = force.allFinite() ? force : Vec3::Zero();
  add(message, R"("set_cursor_force":{")");
  add(message, spelling_text(spelling));
  for (int axis = 0; axis < 3; ++axis) {
    add(message, std::array{R"(":{"x":)", R"(,"y":)", R"(,"z":)"}[as_index(axis)]);
    add_number(message, sent[axis]);
  }
  add(message, "}}}}]}");
  return message;
}

Message probe_message(std::string_view id, IdForm form) {
  Message message = begun_message(id, form);
  add(message, R"("probe_position":{}}}]})");
  return message;
}

namespace {

struct Words {
  std::string_view name;
  std::string_view level;
  std::string_view device;  // empty if the message names none
  std::string_view safety;
};

void read_data(JsonScanner& scanner, Words& words) {
  scanner.object([&](std::string_view key) {
    if (key != "device_id" && key != "safety_type") return false;
    (key == "device_id" ? words.device : words.safety) = scanner.string().value_or("");
    return true;
  });
}

Event safety_event(const Words& words) {
  if (words.safety == "ebrake_triggered") return Event::brake;
  if (words.safety == "ebrake_released") return Event::released;
  if (words.safety == "stall_detected") return Event::stall;
  if (words.safety == "stability_ceiling") return Event::ceiling;
  // A change of the stage is a warning if the risk has grown, and `info` if it has fallen.
  const bool harmless = words.level == "info" || words.level == "notice";
  if (words.safety == "fod_stage_changed")
    return harmless ? Event::stage_lowered : Event::stage_raised;
  return harmless ? Event::notice : Event::safety;
}

}  // namespace

Event parse_event(std::string_view message, std::string_view id) {
  JsonScanner scanner(message);
  Words words;
  const bool is_object = scanner.object([&](std::string_view key) {
    if (key == "data") {
      read_data(scanner, words);
      return true;
    }
    if (key != "name" && key != "level") return false;
    (key == "name" ? words.name : words.level) = scanner.string().value_or("");
    return true;
  });
  if (!is_object || !scanner.at_end()) return Event::garbage;
  const bool safety = words.name == "device-safety-triggered";
  const bool gone = words.name == "device-disconnected";
  if (!safety && !gone && words.name != "device-busy") return Event::other;
  if (!words.device.empty() && words.device != id) return Event::other_device;
  if (safety) return safety_event(words);
  return gone ? Event::disconnected : Event::busy;
}

}  // namespace palpate::device::inverse3
