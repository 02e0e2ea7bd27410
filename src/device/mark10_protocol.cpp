// Parses lines of the stand and the gauge strictly: a doubtful line is not accepted as a reading.
#include "device/mark10_protocol.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/text.h"
#include "device/serial_port.h"

namespace palpate::device::mark10 {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

struct UnitFactor {
  std::string_view unit;
  double factor;
};

// Exact by definition: 1 lbf = 0.45359237 kg * 9.80665 m/s^2, 1 ozf = 1/16 lbf. NIST SP 811 B.8
constexpr double pound_force = 0.45359237 * 9.80665;  // N
constexpr std::array force_units{UnitFactor{"N", 1.0},
                                 UnitFactor{"mN", 1e-3},
                                 UnitFactor{"kN", 1e3},
                                 UnitFactor{"lbF", pound_force},
                                 UnitFactor{"kgF", 9.80665},
                                 UnitFactor{"gF", 9.80665e-3},
                                 UnitFactor{"ozF", pound_force / 16.0}};
constexpr std::array travel_units{UnitFactor{"mm", 1e-3}, UnitFactor{"in", 25.4e-3}};
constexpr std::array speed_units{UnitFactor{"mm/min", 1e-3 / 60.0},
                                 UnitFactor{"in/min", 25.4e-3 / 60.0}, UnitFactor{"", 1e-3 / 60.0}};

template <std::size_t n>
std::optional<double> converted(const Quantity& quantity, const std::array<UnitFactor, n>& units) {
  for (const UnitFactor& one : units)
    if (same_word(one.unit, quantity.unit)) return quantity.value * one.factor;
  return std::nullopt;
}

// `letter`, a `-` if needed, `whole` digits with leading zeros, a point and `decimals` digits.
// Nothing if the value is not finite or does not fit.
std::optional<Command> number_command(char letter, double value, int whole, int decimals) {
  if (!std::isfinite(value)) return std::nullopt;
  long scale = 1;
  for (int i = 0; i < decimals; ++i) scale *= 10;
  long most = scale;
  for (int i = 0; i < whole; ++i) most *= 10;
  const double steps = std::round(std::abs(value) * static_cast<double>(scale));
  if (steps >= static_cast<double>(most)) return std::nullopt;
  long digits = static_cast<long>(steps);
  Command command;
  command.bytes[command.size++] = letter;
  if (value < 0.0 && digits > 0) command.bytes[command.size++] = '-';
  for (long place = most / 10; place > 0; place /= 10) {
    command.bytes[command.size++] = static_cast<char>('0' + (digits / place) % 10);
    if (place == scale) command.bytes[command.size++] = '.';
  }
  return command;
}

}  // namespace

std::optional<Quantity> parse_quantity(std::string_view line) {
  line = without_outer_spaces(line);
  std::string_view text = line;
  bool negative = false;
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) {
    negative = text.front() == '-';
    text.remove_prefix(1);
  }
  std::size_t size = 0;
  int digits = 0;
  int points = 0;
  while (size < text.size() && (is_digit(text[size]) || text[size] == '.')) {
    text[size] == '.' ? ++points : ++digits;
    ++size;
  }
  if (digits == 0 || digits > 15 || points > 1) return std::nullopt;
  Quantity quantity;
  const auto read = std::from_chars(text.data(), text.data() + size, quantity.value);
  if (read.ec != std::errc()) return std::nullopt;
  if (negative) quantity.value = -quantity.value;
  quantity.unit = without_outer_spaces(text.substr(size));
  if (quantity.unit.size() > 7) return std::nullopt;
  for (const char c : quantity.unit)
    if (!is_letter(c) && c != '/') return std::nullopt;
  return quantity;
}

std::optional<double> newtons(const Quantity& quantity) { return converted(quantity, force_units); }
std::optional<double> metres(const Quantity& quantity) { return converted(quantity, travel_units); }
std::optional<double> metres_per_second(const Quantity& quantity) {
  return converted(quantity, speed_units);
}

std::optional<int> parse_error(std::string_view line) {
  line = without_outer_spaces(line);
  if (line.size() != 3 || line[0] != '*' || !is_digit(line[1]) || !is_digit(line[2]))
    return std::nullopt;
  return 10 * (line[1] - '0') + (line[2] - '0');
}

std::string_view error_text(int number) {
  switch (number) {
    case 10: return "an illegal command";
    case 11: return "a command that does not apply now";
    case 12: return "an invalid specifier";
    case 22: return "a value that is too large";
    default: return "an error that its guide does not list";
  }
}

std::optional<Settings> parse_settings(std::string_view line) {
  if (std::ranges::count(line, ';') < 4) return std::nullopt;
  Settings settings;
  for (const std::string& one : split(line, ';')) {
    std::string token = trimmed(one);
    for (char& c : token) c = upper(c);
    const auto number = [&](std::size_t from) {
      int value = -1;
      std::from_chars(token.data() + from, token.data() + token.size(), value);
      return value;
    };
    if (token.starts_with("V")) settings.version = token;
    if (newtons({0.0, token})) settings.unit = token;
    if (token == "CUR" || token == "PT" || token == "PC" || token == "AM") settings.mode = token;
    if (token.starts_with("AOUT")) settings.auto_output = number(4);
    if (token == "NUM") settings.numbers_only = true;
    // Newer lists give `IPOL0` or `IPOL1`, older ones a bare `IPOL` where it is on, beside `POL`.
    if (token == "POL") settings.sign_listed = true;
    if (token.starts_with("IPOL")) {
      settings.sign_listed = true;
      if (token == "IPOL" || number(4) == 1) settings.sign = Settings::Sign::tension_positive;
    }
    if (token.starts_with("OPOL") && number(4) == 1) settings.sign = Settings::Sign::omitted;
  }
  if (settings.unit.empty() && settings.auto_output < 0) return std::nullopt;
  return settings;
}

std::optional<Status> parse_status(std::string_view line) {
  Status status;
  bool any = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == ' ' || c == ',' || c == ';' || c == '\t') continue;
    const std::string_view rest = line.substr(i);
    // `UL` and `DL` are limits only at the end of a word.
    const bool ends = rest.size() == 2 || (rest.size() > 2 && !is_letter(rest[2]));
    if (ends && (rest.starts_with("UL") || rest.starts_with("DL"))) {
      ++i;
    } else if (c == 'U') {
      status.moving = Status::Moving::up;
    } else if (c == 'D') {
      status.moving = Status::Moving::down;
    } else if (c == 'S') {
      status.moving = Status::Moving::stopped;
    } else if (c == 'C' || c == 'L' || c == 'M') {
      status.mode = c;
    } else {
      return std::nullopt;
    }
    any = true;
  }
  return any ? std::optional(status) : std::nullopt;
}

PairReader::Step PairReader::take(std::string_view line) {
  Step step;
  const std::optional<Pair> before = force_;
  const std::optional<double> travel_before = travel_;
  clear();
  if (const auto error = parse_error(line)) {
    step.fault = Fault::error_reply;
    step.error = *error;
    return step;
  }
  // The guide does not give the gauge's word for an overload; these were seen by other programs.
  if (same_word(line, "OVER") || same_word(line, "OL") || same_word(line, "OVERLOAD")) {
    step.fault = Fault::overload;
    return step;
  }
  const auto quantity = parse_quantity(line);
  if (!quantity) {
    step.fault = Fault::garbage;
    return step;
  }
  if (const auto force = newtons(*quantity)) {
    Pair pair;
    pair.force = *force;
    std::ranges::copy(quantity->unit, pair.force_unit.begin());
    if (travel_before) {
      order_ = Order::travel_first;
      step.pair = pair;
      step.pair->travel = *travel_before;
    } else {
      force_ = pair;
    }
    return step;
  }
  const auto travel = metres(*quantity);
  if (!travel) {
    step.fault = Fault::garbage;
  } else if (before && order_ != Order::travel_first) {
    order_ = Order::force_first;
    step.pair = before;
    step.pair->travel = *travel;
  } else if (order_ != Order::force_first) {
    travel_ = *travel;
  } else {
    step.fault = Fault::truncated;  // its force is missing
  }
  return step;
}

std::optional<Command> speed_command(double speed) {
  const double value = speed * 60e3;  // mm/min
  if (!(value >= 0.1 - 1e-9)) return std::nullopt;
  return number_command('e', value, 4, 1);
}

std::optional<Command> lower_limit_command(double travel) {
  return number_command('g', travel * 1e3, 3, 2);
}

std::optional<Command> upper_limit_command(double travel) {
  return number_command('h', travel * 1e3, 3, 2);
}

}  // namespace palpate::device::mark10
