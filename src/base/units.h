// Quantities as text: `"72.4 kPa"` to 72400 and back. The program itself uses only SI units.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palpate {

// Exponents of metre, kilogram and second.
struct Dimension {
  int m = 0;
  int kg = 0;
  int s = 0;
  bool operator==(const Dimension&) const = default;
};

// A unit without a name. `value / per * times` is the SI value: decimal texts in milli-units are
// divided by a thousand, so that they are rounded only once.
struct UnitFactor {
  double times = 1.0;
  double per = 1.0;
  Dimension dimension = {};

  [[nodiscard]] double to_si(double value) const { return value / per * times; }
  [[nodiscard]] double from_si(double value) const { return value / times * per; }
};

// The unit in which a key is written.
struct Unit : UnitFactor {
  const char* symbol;    // "mm"
  const char* quantity;  // "length", for messages

  constexpr Unit(const char* symbol, const char* quantity, const UnitFactor& factor)
      : UnitFactor(factor), symbol(symbol), quantity(quantity) {}
};

namespace unit {
inline constexpr Unit mm{"mm", "length", {1, 1e3, {1, 0, 0}}};
inline constexpr Unit kPa{"kPa", "pressure", {1e3, 1, {-1, 1, -2}}};
inline constexpr Unit density{"kg/m^3", "density", {1, 1, {-3, 1, 0}}};
inline constexpr Unit s{"s", "time", {1, 1, {0, 0, 1}}};
inline constexpr Unit ms{"ms", "time", {1, 1e3, {0, 0, 1}}};
inline constexpr Unit per_second{"1/s", "rate", {1, 1, {0, 0, -1}}};
inline constexpr Unit per_metre{"1/m", "curvature", {1, 1, {-1, 0, 0}}};
inline constexpr Unit mm_per_s{"mm/s", "speed", {1, 1e3, {1, 0, -1}}};
inline constexpr Unit mm_per_min{"mm/min", "speed", {1, 6e4, {1, 0, -1}}};
inline constexpr Unit mm_per_s2{"mm/s^2", "acceleration", {1, 1e3, {1, 0, -2}}};
inline constexpr Unit g{"g", "mass", {1, 1e3, {0, 1, 0}}};
inline constexpr Unit N_per_m{"N/m", "stiffness", {1, 1, {0, 1, -2}}};
inline constexpr Unit N_s_per_m{"N s/m", "damping", {1, 1, {0, 1, -1}}};
inline constexpr Unit N{"N", "force", {1, 1, {1, 1, -2}}};
}  // namespace unit

// Parses a text such as `"11 mm"` to an SI value with the dimension of `wanted`. Throws
// std::invalid_argument with a sentence that starts with "wants ..." if there is no number, if it
// is out of range, or if the unit is missing, unknown (then with the nearest known one) or of
// another dimension.
[[nodiscard]] double parse_quantity(std::string_view text, const Unit& wanted);

// Whether a text is a number with a unit of this dimension, also one that parse_quantity() refuses
// with the quantity in a unit that it takes, such as `3 lbf`.
[[nodiscard]] bool is_quantity(std::string_view text, const Dimension& dimension);

// The value in the unit `shown`, with digits that parse_quantity() reads back to the same double,
// or in the SI unit without prefix if no such digits exist.
[[nodiscard]] std::string quantity_text(double si, const Unit& shown);

// A pressure of four digits with the prefix that leaves one to three of them before the point:
// `100 Pa`, `12.5 kPa`, `17 GPa`.
[[nodiscard]] std::string pressure_text(double pascal);

// Parses a unit expression in the syntax of parse_quantity(): `uN`, `N s/m`; empty if it is not
// one.
[[nodiscard]] std::optional<UnitFactor> unit_factor(std::string_view text);

// A unit by a word that parse_quantity() does not take: `inch`, `psi`, `seconds`.
struct UnitWord {
  std::string_view word;  // in small letters
  const char* symbol;     // as palpate writes it: `in`
  UnitFactor factor;
};

// The unit of a word in letters of any size; null if it is none.
[[nodiscard]] const UnitWord* unit_word(std::string_view text);

// `unit`, in which quantities of this kind are written, unless the number is plausible in SI units
// alone: a pressure of at least 1000 is in Pa, since tissue has no MPa, and a length below 0.1 in
// m.
[[nodiscard]] std::string_view plausible_unit(double number, std::string_view unit);

// The length (m) of the unit of a file's coordinates, also in inches. Throws std::invalid_argument
// if it is no length.
[[nodiscard]] double metres_per(const std::string& unit);

// A regular expression (ECMA) of the units of a dimension: every single symbol that has it, with
// any prefix, and every product, quotient or power, whatever its dimension.
[[nodiscard]] std::string unit_pattern(const Dimension& dimension);

// The SI unit of a dimension: `m`, `N`, `Pa`, `m^-3*kg`; empty for a pure number.
[[nodiscard]] std::string si_unit(const Dimension& dimension);

// The name of the dimension ("a pressure") if it has one, otherwise "a quantity in" its SI unit.
[[nodiscard]] std::string dimension_name(const Dimension& dimension);

}  // namespace palpate
