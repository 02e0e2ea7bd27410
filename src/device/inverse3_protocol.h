// The JSON messages of an arm's service: parsers and commands, without a socket.
//
// Replies are read by JsonScanner, because a parser that builds a tree would allocate memory.
// docs.haply.co, Inverse Service: WebSocket protocol, control commands; docs/devices.md.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec3.h"
#include "device/sample.h"

namespace palpate::device::inverse3 {

// Reads JSON text in one pass, without a tree, without allocation and to a limited depth, by
// RFC 8259; \u escapes and UTF-8 are not checked.
class JsonScanner {
 public:
  explicit JsonScanner(std::string_view text) : text_(text) {}

  [[nodiscard]] bool failed() const { return failed_; }

  // Enters an object (`{`) or array (`[`) and returns true, or reads nothing and returns false.
  bool enter(char bracket);

  // Inside an object: returns the key of the next member, with escape sequences left as they are;
  // its value must then be read or skipped. Nothing at the object's end and if the text is invalid.
  std::optional<std::string_view> next_key();

  // Inside an array: true if there is another element, which must then be read or skipped.
  bool next_element();

  // Each reads a value. A value of another type is skipped, and the result is nothing.
  std::optional<double> number();
  std::optional<std::string_view> string();
  std::optional<std::string_view> word();  // a string, or a number as it is written
  std::optional<bool> boolean();
  void skip();
  // Reads an object: `use` gets each key and returns whether it has read the value, which is
  // skipped otherwise. A value of another type is skipped, and the result is false.
  template <class Use>
  bool object(const Use& use) {
    const bool is_object = enter('{');
    if (!is_object) skip();
    while (const auto key = is_object ? next_key() : std::nullopt)
      if (!use(*key)) skip();
    return is_object;
  }

  bool at_end();  // true if the text was valid and only white space is left

 private:
  void space();
  [[nodiscard]] char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void fail() { failed_ = true; }
  bool take(char c);
  bool take_word(std::string_view word);
  std::optional<std::string_view> raw_string();
  std::optional<double> raw_number();
  bool separator(char end);

  static constexpr int deepest = 32;
  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool first_ = false;  // no member of the current object or array has been read
  bool failed_ = false;
};

// The JSON name of the force vector: `vector` in services from 3.5 on, `values` in earlier ones.
enum class Spelling { vector, values };
[[nodiscard]] std::string_view spelling_text(Spelling spelling);

// The version in a reply to `GET /version` (with or without the envelope `data`); empty if none.
[[nodiscard]] std::string parse_version(std::string_view body);
// The spelling of that version; `vector` if the version cannot be read.
[[nodiscard]] Spelling spelling_of(std::string_view version);

// Whether that version has `probe_position`, which reads without a force: from 3.5 on.
[[nodiscard]] bool has_probe(std::string_view version);

enum class IdForm { text, number };  // how a service writes the id of an arm

// An arm in the first message, which is a full snapshot. What the message lacks counts as good.
struct Arm {
  std::string id;
  IdForm form = IdForm::text;
  std::string model;     // config.type
  std::string firmware;  // MAJOR.MINOR of config.device_info; empty if it is not there
  // How the service turns or scales the arm's coordinates: "the basis `XZY`, a mount that turns";
  // empty if it does neither. A mount or transform that only shifts is none.
  std::string frame;
  bool shifted = false;  // by the mount or the transform
  bool calibrated = true;
  bool powered = true;
};
struct Snapshot {
  std::vector<Arm> arms;
};
// Nothing if the text is not a JSON object. Arms without a usable id are excluded. Allocates.
[[nodiscard]] std::optional<Snapshot> parse_snapshot(std::string_view message);

// True for ids that palpate sends back: 1 to 31 letters, digits, `-` or `_`.
[[nodiscard]] bool usable_id(std::string_view id);

enum class Mode { unknown, idle, other };

// The part of a reply that concerns one arm.
struct Reply {
  Fault fault = Fault::none;          // garbage, missing_field, wrong_device, not_finite, brake
  std::optional<Vec3> position = {};  // m
  std::optional<Vec3> velocity = {};  // m/s
  Mode mode = Mode::unknown;          // of `control_mode`, or of the older `mode` without it
  bool framed = false;                // the state's `transform` turns or scales
};
// Reads a reply for the arm `id`. Never allocates and never throws. Valid JSON without this arm is
// missing_field, or wrong_device if it contains other arms. Numbers beyond any arm (10 m, 100 m/s)
// are not_finite. A vector without x, y or z counts as missing.
[[nodiscard]] Reply parse_reply(std::string_view message, std::string_view id);

// {"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":{...}}}}]}
struct Message {
  std::array<char, 256> bytes{};
  std::size_t size = 0;
  [[nodiscard]] std::string_view text() const { return {bytes.data(), size}; }
};
// `force` in N; if a component is not finite, all three are sent as zero.
[[nodiscard]] Message force_message(std::string_view id, Spelling spelling, const Vec3& force,
                                    IdForm form = IdForm::text);
// {"inverse3":[{"device_id":"049D","commands":{"probe_position":{}}}]}
[[nodiscard]] Message probe_message(std::string_view id, IdForm form = IdForm::text);

// Reads {"name","category","level","data":{"device_id","safety_type",..},"message"} for the arm
// `id`. Never allocates and never throws. An event of another device is other_device; an event that
// names no device is taken as ours; a message that is not a complete JSON object is garbage.
// docs.haply.co, Inverse Service 3.5: Events & Monitoring.
[[nodiscard]] Event parse_event(std::string_view message, std::string_view id);

}  // namespace palpate::device::inverse3
