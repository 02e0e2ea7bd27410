// Where searches of a box begin, and the best of several.
#pragma once

#include <vector>

#include "fit/box_search.h"

namespace palpate::fit {

// The middle of the box, then points of Halton's sequence, four an unknown: the same every time.
[[nodiscard]] std::vector<std::vector<double>> search_starts(std::size_t unknowns);

struct SearchResult {
  BoxMinimum best;
  int evaluations = 0;
};

// Searches from so many starts, those with the least squares; the best minimum, the first of
// equals.
[[nodiscard]] SearchResult search_from_several(const BoxProblem& problem, int searches);

}  // namespace palpate::fit
