// Processes bytes: clock, faults and stand.
#include "emulator/mark10.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace emulator {
namespace {

// The byte that arrives at a wrong baud rate: never a printable one, so never a command.
char at_wrong_baud(char byte) {
  return static_cast<char>((static_cast<unsigned char>(byte) * 37U + 11U) | 0x80U);
}

std::string without_line_ends(const std::string& text) {
  std::string bare;
  for (const char byte : text)
    if (byte != '\r' && byte != '\n') bare += byte;
  return bare;
}

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
    : settings_(settings),
      stand_(make_stand(settings.stand)),
      delays_{settings.stand.seed ^ 0x9E3779B97F4A7C15U},  // other numbers than the gauge's noise
      faults_(settings.faults),
      log_(&log) {}

Nanoseconds Mark10::byte_time() const {
  const Nanoseconds usual = (10'000'000'000 + settings_.baud / 2) / settings_.baud;
  return faults_.lasts("slow", now_) ? 10 * usual : usual;
}

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

void Mark10::log_state() { log_row("state", ""); }

void Mark10::go_to(Nanoseconds time) { go_to(time, requests_); }

// Advances to `time`. Faults with `at` begin exactly at their time, however long the advance is.
void Mark10::go_to(Nanoseconds time, std::int64_t requests) {
  for (auto next = faults_.next_time(); next && *next <= time; next = faults_.next_time()) {
    now_ = std::max(now_, *next);
    advance(stand_, now_);
    begin_faults(requests);
  }
  now_ = std::max(now_, time);
  advance(stand_, now_);
  begin_faults(requests);
  spoil(stand_.gauge, faults_, now_, depth(stand_));
  if (!stand_.unsolicited.empty()) send(std::exchange(stand_.unsolicited, {}));
}

void Mark10::begin_faults(std::int64_t requests) {
  for (const Fault& fault : faults_.begin(now_, requests)) {
    log_row("fault", fault.kind);
    apply(fault);
  }
}

void Mark10::apply(const Fault& fault) {
  if (fault.kind == "unplug") {
    unplugged_ = true;
    out_.clear();
    if (fault.duration) again_ = now_ + *fault.duration;
  }
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

void Mark10::plug_in() {
  unplugged_ = false;
  again_.reset();
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
  return spoilt(reply);
}

std::string Mark10::spoilt(std::string reply) {
  const auto [first, second] = split(reply);
  if (faults_.spoils("error_reply")) reply = "*10\r\n";
  if (faults_.spoils("no_travel")) reply = first;
  if (faults_.spoils("swap")) reply = second + first;
  if (faults_.spoils("glue")) reply = without_line_ends(reply);
  if (faults_.spoils("truncate")) reply.resize(reply.size() / 2);
  if (faults_.spoils("duplicate")) reply += reply;
  if (faults_.spoils("unsolicited"))
    reply = reading_line(stand_.language, stand_.gauge, stand_.gauge.mode) + reply;
  if (faults_.spoils("nul")) {
    std::string wide;
    for (const char byte : reply) (wide += byte) += '\0';
    reply = wide;
  }
  if (faults_.spoils("garbage"))
    std::transform(reply.begin(), reply.end(), reply.begin(), at_wrong_baud);
  if (faults_.spoils("drop")) reply.clear();
  return reply;
}

void Mark10::send(const std::string& bytes) {
  if (bytes.empty()) return;
  log_row("out", bytes);
  if (!faults_.lasts("wrong_baud", now_)) {
    out_ += bytes;
    return;
  }
  for (const char byte : bytes) out_ += at_wrong_baud(byte);
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
  go_to(lockstep ? now_ + byte_time() : now_);
  if (unplugged_) return;
  const bool garbled = rate_of_other_side == Rate::other || faults_.lasts("wrong_baud", now_);
  const char heard = garbled ? at_wrong_baud(byte) : byte;
  if (faults_.lasts("deaf", now_)) {
    log_row("in", "(unheard) " + std::string(1, heard));
    return;
  }
  if (faults_.lasts("echo", now_)) send(std::string(1, byte));
  const bool request = ends_request(stand_, heard);
  const Nanoseconds due = (now_ / settings_.tick + 1) * settings_.tick;
  if (request && lockstep) go_to(std::max(now_, due - age_of_reading()));
  if (unplugged_) return;
  command_ += heard;
  const std::string reply = reply_to(heard);
  if (request && lockstep) go_to(due);
  if (between_commands(stand_)) log_row("in", std::exchange(command_, {}));
  if (rate_of_other_side == Rate::other) {
    for (const char sent : reply) send(std::string(1, at_wrong_baud(sent)));
  } else {
    send(reply);
  }
  if (lockstep) go_to(now_ + byte_time() * static_cast<Nanoseconds>(reply.size()));
  if (request) ++requests_;  // faults with `after_messages` begin with the next byte
}

std::string Mark10::give() {
  if (faults_.lasts("stall", now_)) return {};
  return std::exchange(out_, {});
}

}  // namespace emulator
