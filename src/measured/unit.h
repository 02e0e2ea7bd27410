// The unit in the name of a column: `Load (uN)`, `force_N`, `Weg in mm`, `Kraft / N`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/units.h"

namespace palpate::measured {

inline constexpr Dimension length{1, 0, 0};
inline constexpr Dimension force{1, 1, -2};
inline constexpr Dimension time{0, 0, 1};
inline constexpr Dimension stress{-1, 1, -2};

struct WrittenUnit {
  std::string text;  // palpate's spelling: `um` for `µm` and `micron`; empty if dimensionless
  UnitFactor factor;
};

// A unit as instruments write it: the units of unit_factor and words such as `sec`, `Newton`,
// `micron`, `%`, `gF`, `lbF`, `in`, `psi`, `mmHg`, `Angstrom`, with or without brackets of any
// kind. Nothing if the text is not a unit.
[[nodiscard]] std::optional<WrittenUnit> written_unit(std::string_view text);

// The unit of a column of that name: grams below a force are gram-force, and seconds below a rate
// 1/s.
[[nodiscard]] WrittenUnit unit_under(const std::string& name, const WrittenUnit& unit);
[[nodiscard]] bool is_mass(const WrittenUnit& unit);

// Whether a name stands for a stretch, length over initial length: `stretch`, `lambda`.
[[nodiscard]] bool is_stretch(std::string_view name);

// Whether a cell of a row of units names a unit, of any quantity: also `degC`, `V`, `rad`.
[[nodiscard]] bool is_unit_word(std::string_view text);

struct NamedColumn {
  std::string bare;                 // the name without its unit: `Load`, `force`
  std::optional<WrittenUnit> unit;  // if the name ends with one
};
[[nodiscard]] NamedColumn named_column(std::string_view name);

}  // namespace palpate::measured
