// The force gauge: noisy samples, averages, zero, peaks, and the display with its units.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "emulator/faults.h"
#include "emulator/random.h"

namespace emulator {

// A unit that the gauge can display.
struct ForceUnit {
  std::string_view command;  // GCL2 command that selects it: "LB"
  std::string_view listed;   // word in the reply to LIST: "LBF"
  std::string_view symbol;   // on the display: "lbF"
  double newtons;            // N per unit, exact by definition
};

// Units of the Series 5 guide, GCL2.
inline constexpr std::array force_units{
    ForceUnit{"N", "N", "N", 1.0},
    ForceUnit{"MN", "MN", "mN", 1e-3},
    ForceUnit{"KN", "KN", "kN", 1e3},
    ForceUnit{"LB", "LBF", "lbF", 4.4482216152605},
    ForceUnit{"OZ", "OZF", "ozF", 0.27801385095378125},
    ForceUnit{"KG", "KGF", "kgF", 9.80665},
    ForceUnit{"G", "GF", "gF", 9.80665e-3},
};

struct GaugeSettings {
  double capacity = 10.0;    // N
  double resolution = 2e-3;  // N, of the display in newtons
  double noise = 1e-3;       // N, standard deviation of a sample
  std::size_t unit = 0;      // index in force_units
  int filter = 3;            // FLTC: the display averages 2^filter samples
  int peak_filter = 1;       // FLTP: peaks average 2^peak_filter samples
};

enum class Polarity { compression_positive, compression_negative };
enum class Reading { current, peak_tension, peak_compression };

inline constexpr std::size_t longest_average = 1024;  // samples, FLTC10
inline constexpr double sample_rate = 7000.0;         // per second

struct Gauge {
  GaugeSettings settings = {};
  Random random{};
  std::size_t unit = 0;
  int filter = 3;
  int peak_filter = 1;
  Reading mode = Reading::current;
  Polarity polarity = Polarity::compression_positive;
  bool hide_sign = false;     // OPOL1
  bool numbers_only = false;  // NUM: without the unit
  // Samples in counts of resolution/64, so that their sums are exact.
  std::array<std::int64_t, longest_average> samples{};
  std::size_t taken = 0;
  std::int64_t zero = 0;   // counts
  std::int64_t most = 0;   // counts, peak compression
  std::int64_t least = 0;  // counts, peak tension
  // Effects of faults.
  double added = 0;      // N
  std::size_t late = 0;  // samples by which the shown force is old
  bool lost = false;     // the force reads 0
  double depth = 0;      // m, of the last motion
  int way = 0;           // 1 down, -1 up
  bool flipped = false;
  bool forced_overload = false;
  std::optional<std::string> forced_number;  // shown instead of the number
};

[[nodiscard]] Gauge make_gauge(const GaugeSettings& settings, std::uint64_t seed);

// Takes one sample of the force on the gauge (N, positive in compression).
void sample(Gauge& gauge, double force);

// What lasting faults do to the shown force from now on (ns), with the finger at a depth (m).
void spoil(Gauge& gauge, const Faults& faults, std::int64_t now, double depth);

// N: the mean of the last 2^filter samples, or a peak, minus the zero.
[[nodiscard]] double value_of(const Gauge& gauge, Reading reading);
[[nodiscard]] bool overloaded(const Gauge& gauge);  // above 110 % of the capacity
void set_zero(Gauge& gauge);                        // also clears the peaks
void clear_peaks(Gauge& gauge);

// The display's step in a unit: 1, 2 or 5 times a power of ten, the nearest to the resolution.
[[nodiscard]] double display_step(const Gauge& gauge, std::size_t unit);
[[nodiscard]] bool offers(const Gauge& gauge, std::size_t unit);

// The displayed reading, "4.285 N" or "-18.78 lbF", without a line end.
[[nodiscard]] std::string shown(const Gauge& gauge, Reading reading);

// `value` rounded to a multiple of `step`, with the decimals of `step`, and never "-0.00".
[[nodiscard]] std::string in_steps(double value, double step);

}  // namespace emulator
