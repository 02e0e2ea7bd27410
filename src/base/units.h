// Quantities as text: `"72.4 kPa"` to 72400 and back. Units live only here, at the edge.
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

// A unit that a key is written in: `value / per * times` is the SI value, so that a decimal text
// in milli-anything is divided by a thousand and rounded once.
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
inline constexpr Unit N_s_per_m{"N s/m", "damping", 1, 1, {0, 1, -1}};
inline constexpr Unit N{"N", "force", 1, 1, {1, 1, -2}};
}  // namespace unit

// `"11 mm"` as an SI value of `wanted`'s dimension.
// Throws std::invalid_argument with a sentence that starts "wants ...": no number, a number out of
// range, no unit, an unknown unit (and the nearest known one), or a unit of another dimension.
[[nodiscard]] double parse_quantity(std::string_view text, const Unit& wanted);

// The SI value in `shown`'s unit, in digits that parse_quantity reads back as the very same
// double; falls back to the unprefixed SI unit where no such digits exist.
[[nodiscard]] std::string quantity_text(double si, const Unit& shown);

// The dimension's name ("a pressure") where it has one, else its SI unit.
[[nodiscard]] std::string dimension_name(const Dimension& dimension);

}  // namespace palpate
