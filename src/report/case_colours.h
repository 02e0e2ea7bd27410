// Colours of many cases by a number that is swept.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "plot/figure.h"
#include "scenario/family.h"

namespace palpate::report {

struct CaseColours {
  plot::ColourBar bar = {};
  // By the case's name: the number, and a label made of the other swept values.
  std::map<std::string, std::pair<double, std::string>> cases = {};
};

// Nothing for up to eight cases, which a legend can name, and if no swept key is a number with one
// unit and at least three values. Of several such keys the one with the most values is taken. If
// the others have more than a dozen combinations, their labels are equal and the bar's label says
// so.
[[nodiscard]] std::optional<CaseColours> case_colours(const scenario::Family& family);

}  // namespace palpate::report
