// Starting points for searches in a box, and the best of several searches.
#pragma once

#include <vector>

#include "identify/box_search.h"

namespace palpate::identify {

// The middle of the box, then four points of Halton's sequence per unknown; always the same points.
[[nodiscard]] std::vector<std::vector<double>> search_starts(std::size_t unknowns);

struct SearchResult {
  BoxMinimum best;
  int evaluations = 0;
};

// Searches from the `searches` starts with the least squares; the first of equal minima is best.
[[nodiscard]] SearchResult search_from_several(const BoxProblem& problem, int searches);

}  // namespace palpate::identify
