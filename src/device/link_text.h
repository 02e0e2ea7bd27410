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
struct GaugeAddress {
  std::string port;      // path of a serial line
  std::string settings;  // path of a TOML file: line_settings.h
};
struct ArmAddress {
  std::string host;
  int port = 0;
  std::optional<int> events = 10020;  // port of the service's events; none: events are ignored
  std::string id = {};                // of the arm, if the service has several; empty: the first
};
struct RecordingAddress {
  std::string file;
};
using Address = std::variant<StandAddress, GaugeAddress, ArmAddress, RecordingAddress>;

// Reads `mark10:PORT`, `serial:PORT,SETTINGS.toml`, `inverse3:HOST:PORT[:EVENTS][/ID]` (an IPv6
// host is written in brackets; EVENTS is a port or `none`) or `replay:FILE.csv`. Throws InputError
// with examples of these forms.
[[nodiscard]] Address parse_link(std::string_view text);

// Whether the device can neither be moved nor be given a force, so that a run need not be armed.
[[nodiscard]] bool only_reads(const Address& address);

// The forms of all links, for help texts: "mark10:PORT, ... or replay:FILE.csv".
[[nodiscard]] std::string link_forms();

}  // namespace palpate::device
