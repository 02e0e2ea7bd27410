// Samples, averages and the display of the gauge.
#include "emulator/gauge.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace emulator {
namespace {

constexpr double counts_per_step = 64.0;

double count_size(const Gauge& gauge) { return gauge.settings.resolution / counts_per_step; }

// Counts: the mean of the last 2^exponent samples before `late` others, or of all if there are
// fewer.
double mean(const Gauge& gauge, int exponent, std::size_t late = 0) {
  const std::size_t wanted = std::size_t{1} << static_cast<unsigned>(exponent);
  const std::size_t room = std::min(gauge.taken, longest_average);
  const std::size_t have = std::min(wanted, room);
  late = std::min(late, room - have);
  if (have == 0) return 0.0;
  std::int64_t sum = 0;
  for (std::size_t back = 1; back <= have; ++back)
    sum += gauge.samples[(gauge.taken - late - back) % longest_average];
  return static_cast<double>(sum) / static_cast<double>(have);
}

}  // namespace

void fields(palpate::FieldVisitor& visitor, GaugeSettings& settings) {
  using palpate::above;
  visitor.quantity({"capacity", "greatest rated force"}, settings.capacity, palpate::unit::N,
                   above(0.0));
  visitor.quantity({"resolution", "of the displayed force"}, settings.resolution, palpate::unit::N,
                   above(0.0));
  visitor.quantity({"noise", "standard deviation of a sample"}, settings.noise, palpate::unit::N,
                   palpate::at_least(0.0));
}

Gauge make_gauge(const GaugeSettings& settings, std::uint64_t seed) {
  Gauge gauge;
  gauge.settings = settings;
  gauge.random = {seed};
  gauge.unit = settings.unit;
  gauge.filter = settings.filter;
  gauge.peak_filter = settings.peak_filter;
  return gauge;
}

void sample(Gauge& gauge, double force) {
  const double noisy = force + gauge.settings.noise * next_normal(gauge.random);
  const double most = 1.2 * gauge.settings.capacity;  // where the converter saturates
  const double heard = std::clamp(noisy, -most, most);
  gauge.samples[gauge.taken % longest_average] =
      static_cast<std::int64_t>(std::floor(heard / count_size(gauge) + 0.5));
  ++gauge.taken;
  const auto peak = static_cast<std::int64_t>(std::floor(mean(gauge, gauge.peak_filter) + 0.5));
  gauge.most = std::max(gauge.most, peak - gauge.zero);
  gauge.least = std::min(gauge.least, peak - gauge.zero);
}

void spoil(Gauge& gauge, const Faults& faults, std::int64_t now, double depth) {
  if (depth != gauge.depth) gauge.way = depth > gauge.depth ? 1 : -1;
  gauge.depth = depth;
  gauge.flipped = faults.lasts("sign_flip", now);
  gauge.forced_overload = faults.lasts("overload", now);
  gauge.lost = faults.lasts("lost_force", now);
  gauge.late = 0;
  if (faults.lasts("lag", now))
    gauge.late = static_cast<std::size_t>(std::max(0.0, faults.value("lag")) * sample_rate);
  gauge.added = faults.lasts("spike", now) ? faults.value("spike") : 0.0;
  gauge.added += faults.age("drift", now) * faults.value("drift");
  if (faults.lasts("friction", now)) gauge.added += gauge.way * faults.value("friction");
}

double value_of(const Gauge& gauge, Reading reading) {
  if (gauge.lost) return gauge.added;
  double counts = mean(gauge, gauge.filter, gauge.late) - static_cast<double>(gauge.zero);
  if (reading == Reading::peak_compression) counts = static_cast<double>(gauge.most);
  if (reading == Reading::peak_tension) counts = static_cast<double>(gauge.least);
  return counts * count_size(gauge) + gauge.added;
}

bool overloaded(const Gauge& gauge) {
  // The overload concerns the force on the load cell, without the zero.
  return gauge.forced_overload || std::abs(mean(gauge, gauge.peak_filter)) * count_size(gauge) >
                                      1.1 * gauge.settings.capacity;
}

void clear_peaks(Gauge& gauge) { gauge.most = gauge.least = 0; }

void set_zero(Gauge& gauge) {
  gauge.zero = static_cast<std::int64_t>(std::floor(mean(gauge, gauge.filter) + 0.5));
  clear_peaks(gauge);
}

double display_step(const Gauge& gauge, std::size_t unit) {
  const double wanted = gauge.settings.resolution / force_units[unit].newtons;
  const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
  double best = decade;
  for (const double digit : {2.0, 5.0, 10.0})
    if (std::abs(std::log(digit * decade / wanted)) < std::abs(std::log(best / wanted)))
      best = digit * decade;
  return best;
}

bool offers(const Gauge& gauge, std::size_t unit) {
  if (force_units[unit].symbol == "kN") return gauge.settings.capacity >= 1e3;
  if (force_units[unit].symbol == "mN") return gauge.settings.capacity <= 20.0;
  return true;
}

std::string in_steps(double value, double step) {
  const int places = step >= 1.0 ? 0 : static_cast<int>(std::ceil(-std::log10(step) - 1e-9));
  const double steps = std::floor(value / step + 0.5);
  char text[64];
  const double rounded = steps == 0.0 ? 0.0 : steps * step;
  const auto end =
      std::to_chars(text, text + sizeof text, rounded, std::chars_format::fixed, places).ptr;
  return {text, end};
}

std::string shown(const Gauge& gauge, Reading reading) {
  const ForceUnit& unit = force_units[gauge.unit];
  const std::string symbol = gauge.numbers_only ? "" : " " + std::string(unit.symbol);
  if (gauge.forced_number) return *gauge.forced_number + symbol;
  double value = value_of(gauge, reading) / unit.newtons;
  if ((gauge.polarity == Polarity::compression_negative) != gauge.flipped) value = -value;
  if (gauge.hide_sign) value = std::abs(value);
  return in_steps(value, display_step(gauge, gauge.unit)) + symbol;
}

// GCL2 commands of the Series 5 guide: readings, units, modes, filters, output, identity.

namespace {

constexpr std::string_view illegal = "*10\r\n";
constexpr std::string_view not_applicable = "*11\r\n";
constexpr std::string_view bad_specifier = "*12\r\n";
constexpr std::string_view too_large = "*22\r\n";

struct GaugeMode {
  std::string_view word;
  Reading reading;
};
constexpr std::array modes{GaugeMode{"CUR", Reading::current},
                           GaugeMode{"PT", Reading::peak_tension},
                           GaugeMode{"PC", Reading::peak_compression}};

constexpr std::array output_rates{0, 1, 2, 5, 10, 25, 50, 125, 250};  // per second

// Sets `target` to the number at the end of a command. Returns an error reply, or an empty text.
template <typename Allowed>
std::string set_number(std::string_view digits, int most, int& target, Allowed allowed) {
  int value = 0;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) return std::string(too_large);
  if (error != std::errc() || rest != digits.data() + digits.size() || value < 0)
    return std::string(bad_specifier);
  if (value > most) return std::string(too_large);
  if (!allowed(value)) return std::string(bad_specifier);
  target = value;
  return {};
}

constexpr auto any = [](int) { return true; };

std::string list(const Gcl2& language, const Gauge& gauge) {
  std::string text = "V1.00;" + std::string(force_units[gauge.unit].listed) + ";";
  for (const GaugeMode& mode : modes)
    if (mode.reading == gauge.mode) text += std::string(mode.word) + ";";
  text += "FLTC" + std::to_string(gauge.filter) + ";FLTP" + std::to_string(gauge.peak_filter);
  const std::string rate = std::to_string(language.auto_output);
  const bool two_digits = language.list == ListStyle::pol && rate.size() < 2;
  text += ";AOUT" + std::string(two_digits ? "0" : "") + rate;
  text += ";AOFF" + std::to_string(language.auto_off);
  text += gauge.numbers_only ? ";NUM" : ";FULL";
  const bool inverted = gauge.polarity == Polarity::compression_negative;
  if (language.list == ListStyle::ipol)
    text += std::string(inverted ? ";IPOL1" : ";IPOL0") + (gauge.hide_sign ? ";OPOL1" : ";OPOL0");
  else
    text += std::string(";MIT") + (inverted ? ";IPOL" : "") + (gauge.hide_sign ? "" : ";POL");
  return text + ";B0\r\n";
}

std::string set_polarity(Gauge& gauge, std::string_view digits) {
  int on = 0;
  std::string error = set_number(digits, 1, on, any);
  if (error.empty())
    gauge.polarity = on == 1 ? Polarity::compression_negative : Polarity::compression_positive;
  return error;
}

std::string set_hidden_sign(Gauge& gauge, std::string_view digits) {
  int on = 0;
  std::string error = set_number(digits, 1, on, any);
  if (error.empty()) gauge.hide_sign = on == 1;
  return error;
}

// Carries out a setter without a number; false if `command` is not such a setter.
bool set_word(Gauge& gauge, std::string_view command) {
  for (const GaugeMode& mode : modes)
    if (command == mode.word) return gauge.mode = mode.reading, true;
  if (command == "CLR") return clear_peaks(gauge), true;
  if (command == "Z") return set_zero(gauge), true;
  if (command == "FULL") return gauge.numbers_only = false, true;
  if (command == "NUM") return gauge.numbers_only = true, true;
  return command == "SAVE";  // accepted without effect: settings do not survive a restart
}

}  // namespace

std::string reading_line(const Gcl2& language, const Gauge& gauge, Reading reading) {
  if (overloaded(gauge) && language.overload == OverloadReply::text) return "OVERLOAD\r\n";
  return shown(gauge, reading) + "\r\n";
}

std::string obey(Gcl2& language, Gauge& gauge, std::string_view command) {
  if (command.empty()) return {};
  if (command == "?") return reading_line(language, gauge, gauge.mode);
  if (command == "?C") return reading_line(language, gauge, Reading::current);
  if (command == "?PT") return reading_line(language, gauge, Reading::peak_tension);
  if (command == "?PC") return reading_line(language, gauge, Reading::peak_compression);
  if (command == "?ET" || command == "?A") return std::string(not_applicable);
  if (command == "LIST") return list(language, gauge);
  if (command == "RN") return "Series 5\r\n";
  if (command == "RM") return "M5-2\r\n";
  if (command == "RV") return "V1.00\r\n";
  if (command == "RS") return "EMULATOR\r\n";
  for (std::size_t unit = 0; unit < force_units.size(); ++unit) {
    if (command != force_units[unit].command) continue;
    if (!offers(gauge, unit)) return std::string(not_applicable);
    gauge.unit = unit;
    return {};
  }
  if (set_word(gauge, command)) return {};
  const std::string_view number = command.size() > 4 ? command.substr(4) : std::string_view();
  if (command.starts_with("FLTC")) return set_number(number, 10, gauge.filter, any);
  if (command.starts_with("FLTP")) return set_number(number, 10, gauge.peak_filter, any);
  if (command.starts_with("AOFF")) return set_number(number, 30, language.auto_off, any);
  if (command.starts_with("IPOL")) return set_polarity(gauge, number);
  if (command.starts_with("OPOL")) return set_hidden_sign(gauge, number);
  if (command.starts_with("AOUT"))
    return set_number(number, 250, language.auto_output, [](int rate) {
      for (const int known : output_rates)
        if (known == rate) return true;
      return false;
    });
  return std::string(illegal);
}

}  // namespace emulator
