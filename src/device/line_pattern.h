// The pattern of a gauge's lines, such as `{time}, {force} {force_unit}`, and what a line says.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/index.h"

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

}  // namespace palpate::device
