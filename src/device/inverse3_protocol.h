// The words of an arm's service: JSON in, JSON out, pure functions over bytes.
//
// Every frame is read by a scanner of its own, for a parser that builds a tree allocates.
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

// How the force is spelled: `vector` by services from 3.5 on, `values` by those of 3.1.
enum class Spelling { vector, values };
[[nodiscard]] std::string_view spelling_text(Spelling spelling);

// The service's version as it answers `GET /version`, in its envelope or without; empty where the
// text says none.
[[nodiscard]] std::string parse_version(std::string_view body);
// From its version; `vector`, the present one, where that is not known.
[[nodiscard]] Spelling spelling_of(std::string_view version);

// What the first message, a full snapshot, says of the arms that are there.
struct Arm {
  std::string id;
  std::string model;  // device_info, as it stands there
  std::string firmware;
};
struct Snapshot {
  std::vector<Arm> arms;
  std::optional<double> session;
};
// Nothing where the text is no JSON object. May allocate. Arms without a usable id are left out.
[[nodiscard]] std::optional<Snapshot> parse_snapshot(std::string_view message);

// Ids that we are ready to send back: 1 to 31 letters, digits, `-` or `_`.
[[nodiscard]] bool usable_id(std::string_view id);

enum class Mode { unknown, idle, other };

// One reply about one arm.
struct Reply {
  Fault fault = Fault::none;          // garbage, missing_field, wrong_device, not_finite, brake
  std::optional<Vec3> position = {};  // m
  std::optional<Vec3> velocity = {};  // m/s
  std::optional<Vec3> force = {};     // N, that the service says it renders
  Mode mode = Mode::unknown;
};
// Reads a reply for the arm `id`. Never allocates, never throws, whatever the bytes. A reply that
// is valid JSON but says nothing of this arm is missing_field, or wrong_device where it speaks of
// others. Numbers beyond any arm (10 m, 100 m/s) are not_finite. A position must have x, y and z.
[[nodiscard]] Reply parse_reply(std::string_view message, std::string_view id);

// {"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":{...}}}}]}
struct Message {
  std::array<char, 256> bytes{};
  std::size_t size = 0;
  [[nodiscard]] std::string_view text() const { return {bytes.data(), size}; }
};
// `force` in N; what is not finite becomes zero, for all three components.
[[nodiscard]] Message force_message(std::string_view id, Spelling spelling, const Vec3& force);

}  // namespace palpate::device::inverse3
