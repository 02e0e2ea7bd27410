// The protocol of an ESM303 stand with a Series 5 gauge: parsers and commands, without a port.
//
// Commands to the stand are lower-case and have no terminator. Commands to the gauge are
// upper-case, end with CR, and are sent between `/` and `\`. Replies are lines ended by CR LF.
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

// A number and the unit after it: `-18.78 lbF`, `2.00 mm`, `200.3`.
struct Quantity {
  double value = 0.0;
  std::string_view unit;  // empty if there is none
};
// Reads an optional sign, up to 15 digits with at most one point, spaces, and a unit of at most 7
// letters or `/`. Returns nothing for any other text.
[[nodiscard]] std::optional<Quantity> parse_quantity(std::string_view line);

// In N, from N mN kN lbF ozF kgF gF (in upper or lower case); nothing for other units.
[[nodiscard]] std::optional<double> newtons(const Quantity& quantity);
// In m, from mm or in; nothing for other units.
[[nodiscard]] std::optional<double> metres(const Quantity& quantity);
// In m/s, from mm/min, in/min, or a number without unit (mm/min); nothing for other units.
[[nodiscard]] std::optional<double> metres_per_second(const Quantity& quantity);

// The number of an error reply (`*10`, `*11`, `*12`, `*22`); nothing if the line is not an error.
[[nodiscard]] std::optional<int> parse_error(std::string_view line);
[[nodiscard]] std::string_view error_text(int number);

// The gauge's reply to `LIST`: `V1.00;N;CUR;FLTC8;FLTP1;AOUT00;AOFF5;FULL;IPOL0;OPOL0;B0`.
struct Settings {
  std::string version;
  std::string unit;      // as listed: N, LBF, ...
  std::string mode;      // CUR (current reading), or the word of a peak mode
  int auto_output = -1;  // readings per second that are sent unrequested; -1 if not listed
  enum class Sign { compression_positive, tension_positive, omitted };
  Sign sign = Sign::compression_positive;  // the default of the series if no IPOL is listed
  bool sign_listed = false;
  bool numbers_only = false;  // NUM: readings without a unit
};
[[nodiscard]] std::optional<Settings> parse_settings(std::string_view line);

// The reply to `p`. The guide lists its codes but not their layout, so that any order and any
// separators are accepted. Without U, D or S, a `UL` or `DL` may mean a limit, or motion in limit
// mode: `moving` then stays unknown.
struct Status {
  enum class Moving { unknown, up, down, stopped };
  Moving moving = Moving::unknown;
  char mode = '?';  // C cycle, L limit, M manual
};
[[nodiscard]] std::optional<Status> parse_status(std::string_view line);

// The two lines of a reply to `n`.
struct Pair {
  double force = 0.0;                // N, with the gauge's sign
  double travel = 0.0;               // m
  std::array<char, 8> force_unit{};  // as received, ended by 0
};
// Finds pairs: a force line and a travel line, one directly after the other. Stands send them in
// either order, and a stand keeps its own: the first pair, that of the greeting, tells which. The
// gauge's automatic readings before a pair are ignored.
class PairReader {
 public:
  struct Step {
    std::optional<Pair> pair;
    Fault fault = Fault::none;  // of this line
    int error = 0;              // number of an error reply, 0 for other lines
  };
  [[nodiscard]] Step take(std::string_view line);
  // Forgets an incomplete pair, not the order.
  void clear() {
    force_.reset();
    travel_.reset();
  }
  enum class Order { unknown, force_first, travel_first };
  [[nodiscard]] Order order() const { return order_; }

 private:
  Order order_ = Order::unknown;
  std::optional<Pair> force_;     // the line before, if it is a force
  std::optional<double> travel_;  // m, the line before, if it is a travel
};

// A command of at most 15 bytes.
struct Command {
  std::array<char, 16> bytes{};
  std::size_t size = 0;
  [[nodiscard]] std::string_view text() const { return {bytes.data(), size}; }
};
// `e0200.3`: a speed (m/s), sent in mm/min. Nothing outside 0.1 to 9999.9 mm/min.
[[nodiscard]] std::optional<Command> speed_command(double speed);
// `g-007.52`, `h007.52`: lower and upper travel limit (m), sent in mm. Nothing outside +-999.99 mm.
[[nodiscard]] std::optional<Command> lower_limit_command(double travel);
[[nodiscard]] std::optional<Command> upper_limit_command(double travel);

inline constexpr double speed_step = 1e-4 / 60.0;  // m/s, 0.1 mm/min
inline constexpr double travel_step = 2e-5;        // m, 0.02 mm, the stand's resolution

}  // namespace palpate::device::mark10
