// The unit that a column's name carries: `Load (uN)`, `force_N`, `Weg in mm`, `Kraft / N`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/unit_factor.h"

namespace palpate::record {

struct WrittenUnit {
  std::string text;  // as units are written here: `um` for `µm` and `micron`; empty for a number
  UnitFactor factor;
};

// A unit as instruments write it: what unit_factor reads, and words of the trade such as `sec`,
// `Newton`, `micron`, `%`, `gF`, `lbF`, `in`, with or without brackets. Nothing where it is none.
[[nodiscard]] std::optional<WrittenUnit> written_unit(std::string_view text);

struct NamedColumn {
  std::string bare;                 // the name without its unit: `Load`, `force`
  std::optional<WrittenUnit> unit;  // where the name ends in one
};
[[nodiscard]] NamedColumn named_column(std::string_view name);

}  // namespace palpate::record
