// The factor and dimension of a unit in a column header: `uN`, `N s/m`, `kg/m^3`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/units.h"

namespace palpate {

// Like Unit, without a name: `value / per * times` is the SI value.
struct UnitFactor {
  double times = 1.0;
  double per = 1.0;
  Dimension dimension = {};

  [[nodiscard]] double to_si(double value) const { return value / per * times; }
  [[nodiscard]] double from_si(double value) const { return value / times * per; }
};

// Parses a unit expression in the syntax of parse_quantity(); empty if it is not one.
[[nodiscard]] std::optional<UnitFactor> unit_factor(std::string_view text);

// A unit by a word that parse_quantity() does not take: `inch`, `psi`, `seconds`.
struct UnitWord {
  std::string_view word;  // in small letters
  const char* symbol;     // as palpate writes it: `in`
  UnitFactor factor;
};

// The unit of a word in letters of any size; null if it is none.
[[nodiscard]] const UnitWord* unit_word(std::string_view text);

// The length (m) of the unit of a file's coordinates, also in inches. Throws std::invalid_argument
// if it is no length.
[[nodiscard]] double metres_per(const std::string& unit);

// A regular expression (ECMA) of the units of a dimension: every single symbol that has it, with
// any prefix, and every product, quotient or power, whatever its dimension.
[[nodiscard]] std::string unit_pattern(const Dimension& dimension);

// The SI unit of a dimension: `m`, `N`, `Pa`, `m^-3*kg`; empty for a pure number.
[[nodiscard]] std::string si_unit(const Dimension& dimension);

}  // namespace palpate
