// The force gauge: noisy samples, averages, zero, peaks, the display with its units, and GCL2, its
// command language.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/fields.h"
#include "emulator/faults.h"

namespace emulator {

// Seeded noise with the same bits on every machine, without distributions of the library.
struct Random {
  std::uint64_t state;
};

// splitmix64 (Steele, Lea, Flood 2014).
inline std::uint64_t next_bits(Random& random) {
  random.state += 0x9E3779B97F4A7C15U;
  std::uint64_t z = random.state;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

// Sum of twelve uniform numbers minus six: mean 0, variance 1, magnitude below 6.
inline double next_normal(Random& random) {
  std::int64_t sum = 0;
  for (int word = 0; word < 3; ++word) {
    const std::uint64_t bits = next_bits(random);
    for (int part = 0; part < 4; ++part)
      sum += static_cast<std::int64_t>((bits >> (16U * static_cast<unsigned>(part))) & 0xFFFFU);
  }
  return (static_cast<double>(sum) + 6.0) / 65536.0 - 6.0;  // each number is the middle of a step
}

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

// Its keys that every gauge has.
void fields(palpate::FieldVisitor& visitor, GaugeSettings& settings);

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

enum class ListStyle {
  ipol,  // V1.00;N;CUR;FLTC3;FLTP1;AOUT0;AOFF5;FULL;IPOL0;OPOL0;B0
  pol,   // V1.00;LBF;CUR;FLTC8;FLTP1;AOUT00;AOFF5;FULL;MIT;POL;B0, the Series 5 guide's example
};
enum class OverloadReply { text, saturated };

struct Gcl2 {
  ListStyle list = ListStyle::ipol;
  OverloadReply overload = OverloadReply::text;
  int auto_output = 0;  // readings per second
  int auto_off = 5;     // minutes; stored and listed, without effect
};

// Carries out one command (without its line end). Returns the reply with CR LF; it is empty for a
// setter without error. Errors: *10 illegal, *11 not applicable, *12 bad specifier, *22 too large.
[[nodiscard]] std::string obey(Gcl2& language, Gauge& gauge, std::string_view command);

// The reply to `?` with CR LF: a reading, or the sign of an overload.
[[nodiscard]] std::string reading_line(const Gcl2& language, const Gauge& gauge, Reading reading);

}  // namespace emulator
