// The words of an ESM303 stand with a Series 5 gauge: pure functions over bytes.
//
// The stand takes lower-case commands without an end, the gauge upper-case ones that end with CR,
// between `/` and `\`. Replies are lines that end with CR LF.
// ESM303 user's guide, PC control; Series 5 user's guide, GCL2 commands; docs/devices.md.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "device/sample.h"

namespace palpate::device::mark10 {

inline constexpr int baud = 115200;  // 8N1, no flow control

// Bytes in, lines out; holds the last kilobyte at most and never allocates.
class LineBuffer {
 public:
  // Takes all bytes; where too many wait, the oldest are dropped and counted.
  void feed(std::string_view bytes);
  // The next whole line without its end and outer spaces; empty lines are passed over. The view
  // holds till the next call. A line that is longer than any reply is given as it is, cut.
  [[nodiscard]] std::optional<std::string_view> next();
  // What has come of a line that has not ended.
  [[nodiscard]] std::string_view rest() const;
  void clear();
  [[nodiscard]] std::size_t dropped() const { return dropped_; }  // bytes, since the start

 private:
  std::array<char, 1024> bytes_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t dropped_ = 0;
};

// A number and the word after it: `-18.78 lbF`, `2.00 mm`, `200.3`.
struct Quantity {
  double value = 0.0;
  std::string_view unit;  // empty where none is given
};
// Strict: an optional sign, digits with at most one point, spaces, letters or `/`; nothing else.
[[nodiscard]] std::optional<Quantity> parse_quantity(std::string_view line);

// The value in N of a gauge's unit, whatever its case: N mN kN lbF ozF kgF gF; nothing otherwise.
[[nodiscard]] std::optional<double> newtons(const Quantity& quantity);
// The value in m of `mm`, `in`; nothing otherwise.
[[nodiscard]] std::optional<double> metres(const Quantity& quantity);
// The value in m/s of `mm/min`, `in/min`, or of no unit, which is mm/min.
[[nodiscard]] std::optional<double> metres_per_second(const Quantity& quantity);

// The number of `*10`, `*11`, `*12`, `*22`; nothing where the line is no error.
[[nodiscard]] std::optional<int> parse_error(std::string_view line);
[[nodiscard]] std::string_view error_text(int number);

// What a gauge says of itself: `V1.00;N;CUR;FLTC8;FLTP1;AOUT00;AOFF5;FULL;IPOL0;OPOL0;B0`.
struct Settings {
  std::string version;
  std::string unit;      // as listed: N, LBF, ...
  std::string mode;      // CUR, or a peak's
  int auto_output = -1;  // readings a second sent unasked; -1 where it is not listed
  enum class Sign { compression_positive, tension_positive, omitted };
  Sign sign = Sign::compression_positive;  // the series' default where no IPOL is listed
  bool sign_listed = false;
  bool numbers_only = false;  // NUM: readings without a unit
};
[[nodiscard]] std::optional<Settings> parse_settings(std::string_view line);

// The answer to `p`. The guide lists the words, not how they are strung together: any order and
// separators are read. A `UL` or `DL` without an `S` may be a limit, or motion in limit mode: then
// `moving` stays unknown and neither limit is set.
struct Status {
  enum class Moving { unknown, up, down, stopped };
  Moving moving = Moving::unknown;
  char mode = '?';  // C cycle, L limit, M manual
  bool at_upper_limit = false;
  bool at_lower_limit = false;
};
[[nodiscard]] std::optional<Status> parse_status(std::string_view line);

// The two lines of an answer to `n`, in the gauge's own sign.
struct Pair {
  double force = 0.0;                // N
  double travel = 0.0;               // m
  std::array<char, 8> force_unit{};  // as it was written, ended by 0
};
// Lines in, pairs out: a force line directly followed by a travel line. Lines before it that hold
// a force only (the gauge's automatic output) are passed over.
class PairReader {
 public:
  struct Step {
    std::optional<Pair> pair;
    Fault fault = Fault::none;  // of this line
    int error = 0;              // its number, where it is an error's
  };
  [[nodiscard]] Step take(std::string_view line);
  void clear() { force_.reset(); }

 private:
  std::optional<Pair> force_;
};

// A command of at most 15 bytes.
struct Command {
  std::array<char, 16> bytes{};
  std::size_t size = 0;
  [[nodiscard]] std::string_view text() const { return {bytes.data(), size}; }
};
// `e0200.3`: a speed in m/s, sent in mm/min. Nothing where it is not from 0.1 to 9999.9 mm/min.
[[nodiscard]] std::optional<Command> speed_command(double speed);
// `g-007.52` lower and `h007.52` upper travel limit, from m. Nothing outside +-999.99 mm.
[[nodiscard]] std::optional<Command> lower_limit_command(double travel);
[[nodiscard]] std::optional<Command> upper_limit_command(double travel);

inline constexpr double speed_step = 1e-4 / 60.0;  // m/s, 0.1 mm/min
inline constexpr double travel_step = 2e-5;        // m, 0.02 mm, what the stand resolves
inline constexpr double limit_step = 1e-5;         // m, 0.01 mm, of a limit's text

// The share of bytes that no reply holds: at a wrong baud rate most are.
[[nodiscard]] double garbage_share(std::string_view bytes);

}  // namespace palpate::device::mark10
