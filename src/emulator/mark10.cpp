// Processes bytes: clock, faults and stand.
#include "emulator/mark10.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace emulator {
namespace {

// Divides a reply into its first line (with its end) and the rest.
std::pair<std::string, std::string> split(const std::string& reply) {
  const auto end = reply.find('\n');
  if (end == std::string::npos) return {reply, {}};
  return {reply.substr(0, end + 1), reply.substr(end + 1)};
}

std::size_t unit_of(std::string_view symbol) {
  for (std::size_t unit = 0; unit < force_units.size(); ++unit)
    if (force_units[unit].symbol == symbol) return unit;
  return 0;
}

}  // namespace

Mark10::Mark10(const Mark10Settings& settings, Log& log)
    : SerialDevice(settings.faults, settings.baud, log),
      settings_(settings),
      stand_(make_stand(settings.stand)),
      delays_{settings.stand.seed ^ 0x9E3779B97F4A7C15U} {}  // other numbers than the gauge's noise

void Mark10::log_row(const char* kind, const std::string& text) {
  const std::array values{stand_.crosshead.position, travel(stand_), stand_.crosshead.velocity,
                          depth(stand_), force_of(stand_.tissue)};
  log_->row(now_, kind, text, values);
}

std::string Mark10::summary() const {
  char text[200];
  std::snprintf(text, sizeof text,
                R"({"requests":%lld,"position_m":%.9g,"deepest_m":%.9g,)"
                R"("greatest_force_N":%.9g,"moving":%s})",
                static_cast<long long>(requests_), stand_.crosshead.position, stand_.deepest,
                stand_.greatest_force, moves(stand_.crosshead) ? "true" : "false");
  return text;
}

void Mark10::advance_to(Nanoseconds time) {
  now_ = time;
  advance(stand_, now_);
}

void Mark10::go_to(Nanoseconds time, std::int64_t requests) {
  SerialDevice::go_to(time, requests);
  spoil(stand_.gauge, faults_, now_, depth(stand_));
  if (!stand_.unsolicited.empty()) send(std::exchange(stand_.unsolicited, {}));
}

void Mark10::begin(const Fault& fault) {
  if (fault.kind == "unit_change") stand_.gauge.unit = unit_of("lbF");
  if (fault.kind == "travel_unit_change") stand_.inches = true;
  if (fault.kind == "reset") switch_on_again(stand_);
  if (fault.kind == "overload") halt(stand_.crosshead);
  if (fault.kind == "limit_switch") {
    Crosshead& head = stand_.crosshead;
    head.at_end = head.pressed = head.velocity > 0.0 || head.direction > 0 ? 1 : -1;
    head.direction = 0;
    head.velocity = 0.0;
  }
}

std::string Mark10::reply_to(char byte) {
  if (byte == 's' && !stand_.to_gauge && faults_.lasts("runaway", now_)) return {};
  const bool request = ends_request(stand_, byte);
  if (request && faults_.spoils("nan")) stand_.gauge.forced_number = "nan";
  if (request && faults_.spoils("huge")) stand_.gauge.forced_number = "1e308";
  std::string reply = receive(stand_, byte);
  stand_.gauge.forced_number.reset();
  if (reply.empty()) return reply;
  if (!faults_.lasts("freeze", now_))
    frozen_.clear();
  else if (byte == 'n' && frozen_.empty())
    frozen_ = reply;
  else if (byte == 'n')
    reply = frozen_;
  const auto [first, second] = split(reply);
  if (faults_.spoils("error_reply")) reply = "*10\r\n";
  if (faults_.spoils("no_travel")) reply = first;
  if (faults_.spoils("swap")) reply = second + first;
  return spoilt(reply, reading_line(stand_.language, stand_.gauge, stand_.gauge.mode), 0);
}

Nanoseconds Mark10::age_of_reading() {
  if (settings_.jitter == 0) return settings_.latency;
  const auto parts = static_cast<std::uint64_t>(settings_.jitter);
  return settings_.latency + static_cast<Nanoseconds>(next_bits(delays_) % parts);
}

void Mark10::pass(Nanoseconds now) {
  // -1: faults that count requests begin with a byte only, after the last reply has left.
  if (settings_.clock == Clock::real) go_to(now, -1);
}

void Mark10::take(char byte, Rate rate_of_other_side) {
  const bool lockstep = settings_.clock == Clock::lockstep;
  go_to(lockstep ? now_ + byte_time() : now_, requests_);
  if (unplugged()) return;
  hears_at(rate_of_other_side);
  const bool garbled = other_rate_ || faults_.lasts("wrong_baud", now_);
  const char heard = garbled ? noise(byte) : byte;
  if (faults_.lasts("deaf", now_)) {
    log_row("in", "(unheard) " + std::string(1, heard));
    return;
  }
  if (faults_.lasts("echo", now_)) send(std::string(1, byte));
  const bool request = ends_request(stand_, heard);
  const Nanoseconds due = (now_ / settings_.tick + 1) * settings_.tick;
  if (request && lockstep) go_to(std::max(now_, due - age_of_reading()), requests_);
  if (unplugged()) return;
  command_ += heard;
  const std::string reply = reply_to(heard);
  if (request && lockstep) go_to(due, requests_);
  if (between_commands(stand_)) log_row("in", std::exchange(command_, {}));
  send(reply);
  if (lockstep) go_to(now_ + byte_time() * static_cast<Nanoseconds>(reply.size()), requests_);
  if (request) ++requests_;  // faults with `after_messages` begin with the next byte
}

}  // namespace emulator
