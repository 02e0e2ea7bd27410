// Formats the bounds of a range.
#include "base/range_text.h"

#include <cmath>

#include "base/text.h"

namespace palpate {

std::string range_text(const Range& range, const Unit* unit, const RangeWords& words) {
  const auto bound = [&](double value) {
    return unit != nullptr ? quantity_text(value, *unit) : number_text(value);
  };
  std::string text;
  if (range.low == range.high) return words.equal + bound(range.low);
  if (std::isfinite(range.low))
    text += (range.low_allowed ? words.at_least : words.above) + bound(range.low);
  if (std::isfinite(range.high)) {
    if (!text.empty()) text += " and ";
    text += (range.high_allowed ? words.at_most : words.below) + bound(range.high);
  }
  return text;
}

}  // namespace palpate
