// A range in words.
#pragma once

#include <string>

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

}  // namespace palpate
