// Writes a struct's fields as TOML that reads back to the same values.
#pragma once

#include <string>

#include "base/document.h"
#include "base/fields.h"

namespace palpate {

// What stands before the bounds of a range; `equal` where the range has a single value.
struct RangeWords {
  const char* at_least = "at least ";
  const char* above = "above ";
  const char* at_most = "at most ";
  const char* below = "below ";
  const char* equal = "";
};

// Such as "above 0 kPa and below 3 kPa". `unit` is the unit of the key, or null for a pure number.
[[nodiscard]] std::string range_text(const Range& range, const Unit* unit,
                                     const RangeWords& words = {});

// Keys that have no effect for the present values are written only with `Written::all`.
enum class Written { used, all };
[[nodiscard]] Node fields_as_node(const Fields& fields, Written written = Written::used);
[[nodiscard]] std::string fields_as_toml(const Fields& fields, Written written = Written::used);

}  // namespace palpate
