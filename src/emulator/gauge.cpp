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

}  // namespace emulator
