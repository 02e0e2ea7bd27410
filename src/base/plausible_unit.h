// The unit that a number without one was probably meant in.
#pragma once

#include <cmath>
#include <string_view>

namespace palpate {

// `unit`, in which quantities of this kind are written, unless the number is plausible in SI units
// alone: a pressure of at least 1000 is in Pa, since tissue has no MPa, and a length below 0.1 in
// m.
[[nodiscard]] inline std::string_view plausible_unit(double number, std::string_view unit) {
  if (unit == "kPa" && std::abs(number) >= 1000.0) return "Pa";
  if (unit == "mm" && number != 0.0 && std::abs(number) < 0.1) return "m";
  return unit;
}

}  // namespace palpate
