// GCL2 commands of the Series 5 guide: readings, units, modes, filters, output, identity.
#include "emulator/gcl2.h"

#include <array>
#include <charconv>

namespace emulator {
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
