// What any written unit is worth, for columns of files: `uN`, `N s/m`, `kg/m^3`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/units.h"

namespace palpate {

// As Unit, without a name: `value / per * times` is the SI value.
struct UnitFactor {
  double times = 1.0;
  double per = 1.0;
  Dimension dimension = {};

  [[nodiscard]] double to_si(double value) const { return value / per * times; }
  [[nodiscard]] double from_si(double value) const { return value / times * per; }
};

// A unit expression as parse_quantity reads it, or nothing where it is none.
[[nodiscard]] std::optional<UnitFactor> unit_factor(std::string_view text);

// The unit of SI for a dimension: `m`, `N`, `Pa`, `m^-3*kg`; empty for a number.
[[nodiscard]] std::string si_unit(const Dimension& dimension);

}  // namespace palpate
