// The stand's single-letter commands (ESM303 and ESM301 guides, section 6.2) and its time.
#include "emulator/stand.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

#include "emulator/files.h"

namespace emulator {
namespace {

constexpr double inch = 25.4e-3;  // m

// The commands with a reply. `?`, `X` and `S` are answered by the gauge, without slashes.
constexpr std::string_view requests = "napqrvwx?XS";

std::string travel_text(const Stand& stand, double value) {
  const double step = stand.settings.travel_resolution;
  const double seen = std::floor(value / step + 0.5) * step;  // rounded as by the encoder
  return stand.inches ? in_steps(seen / inch, 0.001) + " in" : in_steps(seen * 1e3, 0.01) + " mm";
}

std::string speed_text(const Stand& stand) {
  const double per_minute = stand.crosshead.speed * 60.0;
  return stand.inches ? in_steps(per_minute / inch, 0.01) + " in/min"
                      : in_steps(per_minute * 1e3, 0.1) + " mm/min";
}

std::string status(const Stand& stand) {
  const Crosshead& head = stand.crosshead;
  const char* gap = stand.settings.status == StatusLayout::spaced ? " " : "";
  const bool up = head.direction != 0 ? head.direction > 0 : head.velocity > 0.0;
  std::string text = !moves(head) ? "S" : up ? "U" : "D";
  text += gap;
  text += head.mode == Mode::cycle ? "C" : head.mode == Mode::limit ? "L" : "M";
  if (head.at_end != 0) text += std::string(gap) + (head.at_end > 0 ? "UL" : "DL");
  return text;
}

// Digits before and after the point in a setter's number, by the ESM303 guide: `e0200.3`, in inches
// `e07.87`; `f0010`; `g-007.52`, in inches `g-00.296`; `h` as `g`.
struct Form {
  int whole;
  int places;
};

Form form_of(const Stand& stand) {
  switch (stand.setter) {
    case 'e': return stand.inches ? Form{2, 2} : Form{4, 1};
    case 'f': return {4, 0};
    default: return stand.inches ? Form{2, 3} : Form{3, 2};
  }
}

bool may_follow(const Stand& stand, char byte) {
  const bool limit = stand.setter == 'g' || stand.setter == 'h';
  if (limit && stand.digits.empty() && byte == '-') return true;
  const std::size_t sign = stand.digits.starts_with('-') ? 1 : 0;
  const bool point = stand.digits.size() - sign == palpate::as_index(form_of(stand).whole);
  return point ? byte == '.' : byte >= '0' && byte <= '9';
}

bool complete(const Stand& stand) {
  const Form form = form_of(stand);
  const std::size_t sign = stand.digits.starts_with('-') ? 1 : 0;
  const int point = form.places > 0 ? 1 : 0;
  return stand.digits.size() == sign + palpate::as_index(form.whole + point + form.places);
}

void set_number(Stand& stand) {
  double value = 0.0;
  std::from_chars(stand.digits.data(), stand.digits.data() + stand.digits.size(), value);
  const double length = stand.inches ? inch : 1e-3;
  Crosshead& head = stand.crosshead;
  if (stand.setter == 'e') {
    const CrossheadSettings& s = head.settings;
    head.speed = stand.programmed_speed = std::clamp(value * length / 60.0, s.slowest, s.fastest);
  } else if (stand.setter == 'f') {
    head.cycles_set = static_cast<std::int64_t>(value);
  } else if (stand.setter == 'g') {
    head.lower_limit = value * length + stand.zero;
  } else {
    head.upper_limit = value * length + stand.zero;
  }
}

void zero_travel(Stand& stand) {
  // The limits keep their numbers and therefore move with the zero.
  const double moved = stand.crosshead.position - stand.zero;
  stand.crosshead.lower_limit += moved;
  stand.crosshead.upper_limit += moved;
  stand.zero = stand.crosshead.position;
}

std::string answer(Stand& stand, char byte) {
  const Crosshead& head = stand.crosshead;
  switch (byte) {
    case 'n': {
      std::string force = reading_line(stand.language, stand.gauge, stand.gauge.mode);
      if (!stand.settings.travel_display) return force;
      const std::string way = travel_text(stand, travel(stand)) + "\r\n";
      return stand.settings.order == PairOrder::travel_first ? way + force : force + way;
    }
    case 'x':
      return stand.settings.travel_display ? travel_text(stand, travel(stand)) + "\r\n" : "";
    case 'a': return speed_text(stand) + "\r\n";
    case 'p': return stand.settings.status == StatusLayout::none ? "" : status(stand) + "\r\n";
    case 'q': return std::to_string(head.half_cycles / 2) + "\r\n";
    case 'r': return std::to_string(head.cycles_set) + "\r\n";
    case 'v': return travel_text(stand, head.upper_limit - stand.zero) + "\r\n";
    case 'w': return travel_text(stand, head.lower_limit - stand.zero) + "\r\n";
    case 'S':
      return std::string(stand.gauge.mode == Reading::current        ? "CUR"
                         : stand.gauge.mode == Reading::peak_tension ? "PT"
                                                                     : "PC") +
             "\r\n";
    default:  // `?` and `X`
      return reading_line(stand.language, stand.gauge, stand.gauge.mode);
  }
}

// Motion and its modes require pc_control; units, zero and readings do not.
void command_motion(Stand& stand, char byte) {
  if (!stand.settings.pc_control) return;
  Crosshead& head = stand.crosshead;
  if (byte == 'u') send_off(head, 1);
  if (byte == 'd') send_off(head, -1);
  if (byte == 's') halt(head);
  if (byte == 'l') head.mode = Mode::limit;
  if (byte == 'm') head.mode = Mode::manual;
  if (byte == 'c') head.mode = Mode::cycle;
  if (byte == 'j') head.speed = head.settings.fastest;
  if (byte == 'k') head.speed = head.settings.slowest;
  if (byte == 'o') head.speed = stand.programmed_speed;
  if (byte == 't') head.half_cycles = 0;
}

void command(Stand& stand, char byte) {
  if (byte == '/') stand.to_gauge = true;
  if (byte == 'i') stand.inches = false;
  if (byte == 'b') stand.inches = true;
  if (byte == 'z') zero_travel(stand);
  if (byte == 'R') set_zero(stand.gauge);
  const bool sets = byte == 'e' || byte == 'f' || byte == 'g' || byte == 'h';
  if (sets && stand.settings.pc_control) stand.setter = byte;
  stand.digits.clear();
  command_motion(stand, byte);
}

void put_out(Stand& stand, Nanoseconds now) {
  if (stand.language.auto_output == 0) {
    stand.next_output = now;
    return;
  }
  if (now < stand.next_output) return;
  stand.unsolicited += reading_line(stand.language, stand.gauge, stand.gauge.mode);
  stand.next_output += 1'000'000'000 / stand.language.auto_output;
}

}  // namespace

Stand make_stand(const StandSettings& settings) {
  Stand stand{.settings = settings,
              .crosshead = {},
              .gauge = make_gauge(settings.gauge, settings.seed),
              .language = {},
              .tissue = make_tissue(settings.tissue, 1.0 / static_cast<double>(rate))};
  stand.crosshead.settings = settings.crosshead;
  switch_on_again(stand);
  sample(stand.gauge, force_of(stand.tissue));
  return stand;
}

void switch_on_again(Stand& stand) {
  const Random random = stand.gauge.random;
  const double position = stand.crosshead.position;
  stand.gauge = make_gauge(stand.settings.gauge, random.state);
  stand.crosshead = {};
  stand.crosshead.settings = stand.settings.crosshead;
  stand.crosshead.position = position;
  stand.crosshead.speed = stand.programmed_speed = stand.settings.speed;
  stand.crosshead.lower_limit = stand.settings.crosshead.lower_end;
  stand.crosshead.upper_limit = stand.settings.crosshead.upper_end;
  stand.language = {.list = stand.settings.list, .overload = stand.settings.overload};
  stand.zero = 0.0;
  stand.inches = stand.to_gauge = false;
  stand.setter = 0;
  stand.line.clear();
}

void advance(Stand& stand, Nanoseconds time) {
  const double dt = 1.0 / static_cast<double>(rate);
  const std::int64_t wanted =
      time / 1'000'000 * rate / 1000 + time % 1'000'000 * rate / 1'000'000'000;
  for (; stand.steps < wanted; ++stand.steps) {
    step(stand.crosshead, dt);
    const double force = press(stand.tissue, depth(stand));
    sample(stand.gauge, force);
    stand.deepest = std::max(stand.deepest, depth(stand));
    stand.greatest_force = std::max(stand.greatest_force, force);
    // An overload stops only motion that would load the gauge further; moving back is possible.
    const int loading = force < 0.0 ? 1 : -1;
    if (overloaded(stand.gauge) && stand.crosshead.direction == loading) halt(stand.crosshead);
    put_out(stand, (stand.steps + 1) * 1'000'000'000 / rate);
  }
}

bool ends_request(const Stand& stand, char byte) {
  if (stand.to_gauge) return byte == '\r' && !stand.line.empty();
  if (stand.setter != 0 && may_follow(stand, byte)) return false;
  return requests.find(byte) != std::string_view::npos;
}

bool between_commands(const Stand& stand) { return stand.setter == 0 && stand.line.empty(); }

std::string receive(Stand& stand, char byte) {
  if (stand.to_gauge) {
    if (byte == '\\') {
      stand.to_gauge = false;
      stand.line.clear();
    } else if (byte == '\r') {
      const std::string line = std::move(stand.line);
      stand.line.clear();
      return obey(stand.language, stand.gauge, line);
    } else if (byte != '\n' && stand.line.size() < 64) {
      stand.line += byte;
    }
    return {};
  }
  if (stand.setter != 0) {
    if (may_follow(stand, byte)) {
      stand.digits += byte;
      if (complete(stand)) {
        set_number(stand);
        stand.setter = 0;
      }
      return {};
    }
    stand.setter = 0;  // an incomplete number is dropped; this byte is a command, such as `s`
  }
  if (requests.find(byte) != std::string_view::npos) return answer(stand, byte);
  command(stand, byte);
  return {};
}

double travel(const Stand& stand) { return stand.crosshead.position - stand.zero; }

double depth(const Stand& stand) {
  return stand.settings.tissue.surface - stand.crosshead.position;
}

// Reads the tables [stand] and [gauge].

namespace {

using palpate::above;
using palpate::between;
using palpate::Word;
using palpate::words_of;

constexpr auto status_words =
    words_of<StatusLayout>({{"compact", "`SLDL`"}, {"spaced", "`S L DL`"}, {"none", "no reply"}});
constexpr auto order_words =
    words_of<PairOrder>({{"force_first", "as LabKit reads it"}, {"travel_first", "the other way"}});
constexpr auto list_words =
    words_of<ListStyle>({{"ipol", "with `IPOL0;OPOL0`"}, {"pol", "with `MIT;POL`"}});
constexpr auto overload_words = words_of<OverloadReply>(
    {{"text", "`OVERLOAD`"}, {"saturated", "the largest number that it can show"}});

std::vector<Word> unit_words() {
  std::vector<Word> words;
  for (const ForceUnit& unit : force_units) words.push_back({unit.symbol.data(), ""});
  return words;
}

void stand_fields(FieldVisitor& visitor, StandSettings& settings) {
  CrossheadSettings& head = settings.crosshead;
  visitor.quantity({"acceleration", "of every change of speed"}, head.acceleration, unit::mm_per_s2,
                   above(0.0));
  visitor.quantity({"slowest", "lowest speed"}, head.slowest, unit::mm_per_min, above(0.0));
  visitor.quantity({"fastest", "greatest speed"}, head.fastest, unit::mm_per_min, above(0.0));
  visitor.quantity({"speed", "after switching on"}, settings.speed, unit::mm_per_min, {});
  visitor.quantity({"lower_end", "lower limit switch, from the start"}, head.lower_end, unit::mm,
                   {.high = 0.0, .high_allowed = false});
  visitor.quantity({"upper_end", "upper limit switch, from the start"}, head.upper_end, unit::mm,
                   above(0.0));
  visitor.quantity({"travel_resolution", "resolution of the displayed travel"},
                   settings.travel_resolution, unit::mm, above(0.0));
  visitor.flag({"pc_control", "whether the line may move the stand"}, settings.pc_control);
  visitor.flag({"travel_display", "whether it has one"}, settings.travel_display);
  visitor.choice({"order", "of the two lines of `n`"}, settings.order, order_words);
  visitor.choice({"status", "how `p` writes its codes"}, settings.status, status_words);
}

void gauge_fields(FieldVisitor& visitor, StandSettings& settings) {
  GaugeSettings& gauge = settings.gauge;
  fields(visitor, gauge);
  int unit = static_cast<int>(gauge.unit);
  visitor.choice_of({"unit", "of the displayed force"}, unit, unit_words());
  gauge.unit = palpate::as_index(unit);
  visitor.count({"filter", "the display averages 2^filter samples"}, gauge.filter, between(0, 10));
  visitor.count({"peak_filter", "peaks average 2^peak_filter samples"}, gauge.peak_filter,
                between(0, 10));
  visitor.choice({"list", "the form of the reply to LIST"}, settings.list, list_words);
  visitor.choice({"overload", "the reply above 110 % of the capacity"}, settings.overload,
                 overload_words);
}

}  // namespace

void fields(FieldVisitor& visitor, StandSettings& settings) {
  visitor.table({"stand", "the crosshead"},
                [&](FieldVisitor& inside) { stand_fields(inside, settings); });
  visitor.table({"gauge", "the force gauge"},
                [&](FieldVisitor& inside) { gauge_fields(inside, settings); });
}

void read_stand(const std::string& path, StandSettings& settings) {
  const palpate::Node file =
      read_settings(path, [&](FieldVisitor& visitor) { fields(visitor, settings); });
  if (settings.crosshead.fastest < settings.crosshead.slowest)
    refuse(file, "stand.fastest", "`fastest` is below `slowest`; give a greater speed");
}

// Time steps of the crosshead: it accelerates, cruises, and brakes before the end of its range.

namespace {

// m, the position at which a motion ends: the limit switch, or a travel limit before it.
double end_of_way(const Crosshead& crosshead, int direction) {
  const CrossheadSettings& s = crosshead.settings;
  if (crosshead.mode == Mode::manual) return direction > 0 ? s.upper_end : s.lower_end;
  return direction > 0 ? std::min(s.upper_end, crosshead.upper_limit)
                       : std::max(s.lower_end, crosshead.lower_limit);
}

void arrive(Crosshead& crosshead, double end) {
  crosshead.position = end;
  crosshead.velocity = 0.0;
  crosshead.at_end = crosshead.direction;
  ++crosshead.half_cycles;
  const bool again =
      crosshead.mode == Mode::cycle && crosshead.half_cycles < 2 * crosshead.cycles_set;
  crosshead.direction = again ? -crosshead.direction : 0;
}

}  // namespace

void send_off(Crosshead& crosshead, int direction) {
  const double left = (end_of_way(crosshead, direction) - crosshead.position) * direction;
  crosshead.half_cycles = 0;
  if (direction != crosshead.pressed) crosshead.pressed = 0;
  if (left <= 0.0 || crosshead.pressed != 0) {
    crosshead.at_end = direction;
    halt(crosshead);
    return;
  }
  crosshead.direction = direction;
}

void halt(Crosshead& crosshead) { crosshead.direction = 0; }

bool moves(const Crosshead& crosshead) {
  return crosshead.direction != 0 || crosshead.velocity != 0.0;
}

// |v| changes by at most a dt, and the distance left after the step must suffice for braking:
//   v1^2 / (2 a) <= d - (v + v1) dt / 2   =>   v1 = -a dt/2 + sqrt((a dt/2)^2 + 2 a d - a dt v)
// The position moves with the mean of both velocities, which is exact for constant acceleration.
void step(Crosshead& crosshead, double dt) {
  if (!moves(crosshead)) return;
  const double most = crosshead.settings.acceleration * dt;
  const int way = crosshead.direction;
  double wanted = 0.0;
  if (way != 0) {
    const double left = (end_of_way(crosshead, way) - crosshead.position) * way;
    const double half = 0.5 * most;  // a dt / 2
    const double square = half * half + 2.0 * crosshead.settings.acceleration * left -
                          most * crosshead.velocity * way;
    const double braking = square > 0.0 ? std::max(0.0, std::sqrt(square) - half) : 0.0;
    wanted = way * std::min(crosshead.speed, braking);
  }
  const double before = crosshead.velocity;
  const double after = before + std::clamp(wanted - before, -most, most);
  crosshead.position += 0.5 * (before + after) * dt;
  crosshead.velocity = after;
  if (after != 0.0) crosshead.at_end = 0;
  // A rest of less than a few a dt^2, left by rounding or by a partial step, counts as arrival.
  const double near = 8.0 * most * dt;
  if (way != 0) {
    const double stop = end_of_way(crosshead, way);
    const double left = (stop - crosshead.position) * way;
    if (after * way >= 0.0 && left <= 0.5 * most * dt) {
      if (left >= -near)
        arrive(crosshead, stop);
      else
        halt(crosshead);  // a limit was set that it has already passed
    }
  }
  for (const int side : {-1, 1}) {  // a limit switch stops every motion at once
    const double end = side > 0 ? crosshead.settings.upper_end : crosshead.settings.lower_end;
    if ((end - crosshead.position) * side >= 0.0) continue;
    crosshead.position = end;
    crosshead.velocity = 0.0;
    crosshead.direction = 0;
    crosshead.at_end = side;
  }
}

// Processes bytes: clock, faults and stand.

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
