// What a LINK on the command line names.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace palpate::device {

struct StandAddress {
  std::string port;  // of a serial line: /dev/ttyUSB0
};
struct ArmAddress {
  std::string host;
  int port = 0;
  std::optional<int> events = 10020;  // the port of the service's events; none: not to be heard
};
struct RecordingAddress {
  std::string file;
};
using Address = std::variant<StandAddress, ArmAddress, RecordingAddress>;

// `mark10:PORT`, `inverse3:HOST:PORT[:EVENTS]` (a host of IPv6 in brackets; EVENTS a port or
// `none`) or `replay:FILE.csv`.
// Throws InputError with a sentence that shows these forms.
[[nodiscard]] Address parse_link(std::string_view text);

}  // namespace palpate::device
