// A range in words.
#pragma once

#include <string>

#include "base/fields.h"

namespace palpate {

// "above 0 kPa and below 3 kPa", in the words of the key's unit; a pure number's has none.
[[nodiscard]] std::string range_text(const Range& range, const Unit* unit);

}  // namespace palpate
