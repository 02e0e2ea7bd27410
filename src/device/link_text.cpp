// LINK texts: a word, a colon, and what the word wants.
#include "device/link_text.h"

#include <array>
#include <charconv>
#include <optional>

#include "base/error.h"
#include "base/text.h"

namespace palpate::device {
namespace {

[[noreturn]] void refuse(std::string_view text, const std::string& why) {
  throw InputError({}, "palpate: the link `" + std::string(text) + "` " + why +
                           "; write it as `mark10:/dev/ttyUSB0`, `inverse3:localhost:10001` or "
                           "`replay:FILE.csv`");
}

std::optional<int> port_number(std::string_view text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (port < 1 || port > 65535) return std::nullopt;
  return port;
}

int wanted_port(std::string_view text, std::string_view word, const char* what) {
  const auto port = port_number(word);
  if (!port) refuse(text, what);
  return *port;
}

// HOST:PORT or HOST:PORT:EVENTS; a host with colons of its own stands in brackets.
ArmAddress arm_address(std::string_view text, std::string_view rest) {
  const bool bracketed = rest.starts_with('[');
  if (bracketed) rest.remove_prefix(1);
  const std::string_view host = rest.substr(0, rest.find(bracketed ? ']' : ':'));
  std::string_view ports = rest.substr(host.size());
  if (bracketed && ports.starts_with(']')) ports.remove_prefix(1);
  if (!ports.starts_with(':')) refuse(text, "lacks a port");
  ports.remove_prefix(1);
  if (host.empty()) refuse(text, "lacks a host");
  ArmAddress address{std::string(host)};
  const auto colon = ports.find(':');
  address.port = wanted_port(text, ports.substr(0, colon), "wants a port from 1 to 65535");
  if (colon == std::string_view::npos) return address;
  const std::string_view events = ports.substr(colon + 1);
  address.events = std::nullopt;
  if (events != "none")
    address.events =
        wanted_port(text, events, "wants a port from 1 to 65535 for the events, too, or `none`");
  return address;
}

}  // namespace

Address parse_link(std::string_view text) {
  static const std::array<std::string, 3> words{"mark10", "inverse3", "replay"};
  const auto colon = text.find(':');
  const std::string word(text.substr(0, colon));
  const std::string_view rest =
      colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1);
  if (text.find('\0') != std::string_view::npos) refuse(word, "holds a zero byte");
  if (word == "mark10") {
    if (rest.empty()) refuse(text, "names no serial port");
    return StandAddress{std::string(rest)};
  }
  if (word == "inverse3") return arm_address(text, rest);
  if (word == "replay") {
    if (rest.empty()) refuse(text, "names no file");
    return RecordingAddress{std::string(rest)};
  }
  const auto near = nearest(word, words);
  refuse(text, "is of no kind we know" + (near ? ", did you mean `" + *near + ":`" : ""));
}

}  // namespace palpate::device
