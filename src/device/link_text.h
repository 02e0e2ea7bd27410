// LINK texts of the command line, and the addresses that they name.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace palpate::device {

struct StandAddress {
  std::string port;  // path of a serial line: /dev/ttyUSB0
};
struct ArmAddress {
  std::string host;
  int port = 0;
  std::optional<int> events = 10020;  // port of the service's events; none: events are ignored
};
struct RecordingAddress {
  std::string file;
};
using Address = std::variant<StandAddress, ArmAddress, RecordingAddress>;

// Reads `mark10:PORT`, `inverse3:HOST:PORT[:EVENTS]` (an IPv6 host is written in brackets; EVENTS
// is a port or `none`) or `replay:FILE.csv`. Throws InputError with examples of these forms.
[[nodiscard]] Address parse_link(std::string_view text);

// The forms of all links, for help texts: "mark10:PORT, ... or replay:FILE.csv".
[[nodiscard]] std::string link_forms();

}  // namespace palpate::device
