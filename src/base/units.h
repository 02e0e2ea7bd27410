// Quantities as text: `"72.4 kPa"` to 72400 and back. The program itself uses only SI units.
#pragma once

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

// The unit in which a key is written. `value / per * times` is the SI value: decimal texts in
// milli-units are divided by a thousand, so that they are rounded only once.
struct Unit {
  const char* symbol;    // "mm"
  const char* quantity;  // "length", for messages
  double times;
  double per;
  Dimension dimension;

  [[nodiscard]] double to_si(double value) const { return value / per * times; }
  [[nodiscard]] double from_si(double value) const { return value / times * per; }
};

namespace unit {
inline constexpr Unit mm{"mm", "length", 1, 1e3, {1, 0, 0}};
inline constexpr Unit kPa{"kPa", "pressure", 1e3, 1, {-1, 1, -2}};
inline constexpr Unit density{"kg/m^3", "density", 1, 1, {-3, 1, 0}};
inline constexpr Unit s{"s", "time", 1, 1, {0, 0, 1}};
inline constexpr Unit ms{"ms", "time", 1, 1e3, {0, 0, 1}};
inline constexpr Unit per_second{"1/s", "rate", 1, 1, {0, 0, -1}};
inline constexpr Unit per_metre{"1/m", "curvature", 1, 1, {-1, 0, 0}};
inline constexpr Unit mm_per_s{"mm/s", "speed", 1, 1e3, {1, 0, -1}};
inline constexpr Unit mm_per_min{"mm/min", "speed", 1, 6e4, {1, 0, -1}};
inline constexpr Unit mm_per_s2{"mm/s^2", "acceleration", 1, 1e3, {1, 0, -2}};
inline constexpr Unit g{"g", "mass", 1, 1e3, {0, 1, 0}};
inline constexpr Unit N_per_m{"N/m", "stiffness", 1, 1, {0, 1, -2}};
inline constexpr Unit N_s_per_m{"N s/m", "damping", 1, 1, {0, 1, -1}};
inline constexpr Unit N{"N", "force", 1, 1, {1, 1, -2}};
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

// The name of the dimension ("a pressure") if it has one, otherwise "a quantity in" its SI unit.
[[nodiscard]] std::string dimension_name(const Dimension& dimension);

}  // namespace palpate
