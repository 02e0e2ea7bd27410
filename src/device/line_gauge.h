// The link to any gauge that sends lines, or answers with lines, on a serial line, and the pattern
// of these lines, such as `{time}, {force} {force_unit}`. It only reads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/index.h"
#include "device/clock.h"
#include "device/link.h"
#include "device/sample.h"
#include "device/serial_port.h"

namespace palpate::device {

enum class Measure : std::uint8_t { force, travel, time };
inline constexpr std::size_t measures = as_index(Measure::time) + 1;

// What one line says: numbers as they are written, and units as words (empty if there is none).
struct LineWords {
  std::array<std::optional<double>, measures> number{};
  std::array<std::string_view, measures> unit{};
  bool negative = false;  // of the force, by its own sign

  [[nodiscard]] const std::optional<double>& of(Measure measure) const {
    return number[as_index(measure)];
  }
};

// A pattern is text in which `{force}`, `{travel}` and `{time}` stand for numbers, `{force_unit}`,
// `{travel_unit}` and `{time_unit}` for words of letters, and `{any}` for as little of any text as
// possible. `{force_sign}` is a digit or sign apart from the number: `0`, `+` or a space for
// positive forces, `1` or `-` for negative ones. A space stands for any number of spaces and tabs,
// also none; `{{` and `}}` for braces; everything else for itself. The whole line has to match.
class LinePattern {
 public:
  enum class Decimal { point, comma };

  // Throws std::invalid_argument with a sentence that starts with "wants ..." if there is no
  // `{force}`, if a name is unknown or given twice, or if two parts cannot be told apart.
  explicit LinePattern(std::string_view text, Decimal decimal = Decimal::point);

  // A number has an optional sign (which spaces may follow), up to 15 digits with at most one
  // decimal sign, and an optional exponent. No digit, sign or decimal sign may touch it, so that
  // the rest of a spoilt number is not read as one. Allocates nothing and never throws.
  [[nodiscard]] std::optional<LineWords> match(std::string_view line) const;

  // What a line that does not match lacks, as "`{force}` was expected at `abc`". Allocates.
  [[nodiscard]] std::string why_not(std::string_view line) const;

  [[nodiscard]] bool has_number(Measure measure) const { return has_number_[as_index(measure)]; }
  [[nodiscard]] bool has_unit(Measure measure) const { return has_unit_[as_index(measure)]; }

 private:
  struct Part {
    enum class Kind { text, space, any, sign, number, unit };
    Kind kind = Kind::text;
    Measure measure = Measure::force;
    std::string text = {};  // of the pattern
  };
  struct Furthest {
    std::size_t part = 0;
    std::size_t at = 0;
  };

  void add(const Part& part);
  void add_name(std::string_view name);
  std::optional<LineWords> match(std::string_view line, Furthest& furthest) const;
  [[nodiscard]] std::optional<std::size_t> take(std::size_t part, std::string_view line,
                                                std::size_t at, LineWords& words) const;
  [[nodiscard]] std::optional<std::size_t> take_number(const Part& part, std::string_view line,
                                                       std::size_t at, LineWords& words) const;

  char decimal_;
  std::vector<Part> parts_;
  std::array<bool, measures> has_number_{};
  std::array<bool, measures> has_unit_{};
  bool has_sign_ = false;
};

// N, m or s per unit that a line may name; nothing for other words. A mass means its weight:
// balances and most sketches for load cells show grams.
[[nodiscard]] std::optional<double> unit_of(Measure measure, std::string_view word);

// The known units of a measure, as "`N`, `mN` or `kN`".
[[nodiscard]] std::string known_units(Measure measure);

class Tap;

// The settings of a gauge on a serial line: a TOML file.
struct LineSettings {
  LineFormat line = {.baud = 9600};
  std::string pattern = {};
  LinePattern::Decimal decimal = LinePattern::Decimal::point;
  // Words of LinePattern, for what the pattern takes no unit from.
  std::string force_unit = {};
  std::string travel_unit = {};
  std::string time_unit = {};
  double force_zero = 0.0;   // as written in the lines, subtracted first
  double force_scale = 1.0;  // negative if the lines show compression as negative
  enum class Towards { down, up };
  Towards travel = Towards::down;  // where the travel in the lines increases
  std::string poll = {};           // sent for every reading; empty: the gauge sends by itself
  std::string start = {};          // sent after the port was opened
  std::string stop = {};           // sent before the port is closed
  double rate = 10.0;              // readings per second, that are sent or asked for
  double wait = 3.0;               // s, for the first line
  std::optional<double> start_force = {};  // N, with which a run without travel begins
};

// Reads the file. Throws InputError with the place of what is wrong, also of a pattern or a unit.
[[nodiscard]] LineSettings read_line_settings(const std::string& path);

class LineGauge : public LinkParts {
 public:
  // Reads the settings, opens the port, sends the start text, and waits for the first line that
  // matches the pattern. Throws InputError for wrong settings and LinkError with a diagnosis.
  // `clock` and `tap` must outlive the link.
  LineGauge(const GaugeAddress& address, Clock& clock, Tap* tap = nullptr);
  ~LineGauge();
  LineGauge(const LineGauge&) = delete;
  LineGauge& operator=(const LineGauge&) = delete;

  [[nodiscard]] Traffic traffic() const;

  // The next line, waiting for it at most `wait` s; with a poll text it asks first, unless a reply
  // is pending. A line that does not match is dropped. Position is along z, upwards, from the zero
  // of the travel. After `restarted` or `clock_jumped`, and when the port is gone, the link is
  // lost.
  [[nodiscard]] Sample sample(double wait);
  [[nodiscard]] bool stop() const { return !serial_.port.lost(); }

  // The last lines as sentences: "`F 0.15 N`: force 0.15 N", or why a line does not match.
  [[nodiscard]] std::vector<std::string> heard() const;

 private:
  static constexpr std::size_t kept_lines = 8;
  struct Kept {
    std::array<char, longest_line> bytes{};
    std::size_t size = 0;
  };

  void greet(double until);
  [[noreturn]] void refuse_silence() const;
  void pass_time();
  [[nodiscard]] double reply_time() const;
  bool ask();
  // Waits for the time of the next poll; false if it is after `until` (s, wire_time()).
  bool due(double until);
  void keep(std::string_view line);
  Sample read(std::string_view line);
  // In SI; nothing if the line has the number and its unit is unknown.
  [[nodiscard]] std::optional<double> value_of(const LineWords& words, Measure measure) const;

  std::string path_;
  std::string file_;  // of the settings
  LineSettings settings_;
  double wait_ = 0.0;  // s, for the first line
  LinePattern pattern_;
  std::array<double, measures> given_unit_{};  // SI, of the settings
  SerialLines serial_;
  bool asked_ = false;               // a poll text was sent and no line has come
  bool heard_ = false;               // bytes have come since
  double asked_at_ = 0.0;            // s, wire_time()
  double next_poll_ = 0.0;           // s, wire_time()
  bool cut_ = false;                 // the next line may lack its beginning
  Fault out_of_time_ = Fault::none;  // the gauge's time went back or ahead
  double unit_ = 0.0;                // N, of the first force
  std::array<Kept, kept_lines> kept_{};
  std::size_t kept_count_ = 0;  // lines since the start
};

}  // namespace palpate::device
