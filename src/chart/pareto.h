// The Pareto front of measured choices, and its knee.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace palpate::chart {

// One choice. It is left out unless both numbers are positive and finite.
struct Tradeoff {
  double cost = 0.0;
  double error = 0.0;
};

// The indices of the choices for which no other choice is both cheaper and at least as accurate, or
// more accurate and at most as expensive; by rising cost, hence falling error. First of equals.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const Tradeoff> all);

// The index (0: the cheapest) of the choice of `front`, by rising cost, that lies farthest below
// the chord between its first and last choice, in logarithms of cost and error. Before the knee a
// little cost buys much accuracy, after it much cost buys little. The result does not depend on
// units, because scaling the axes keeps the order of the distances from a chord. Nothing if the
// front has fewer than three choices or none below the chord. docs/theory.md [knee]
[[nodiscard]] std::optional<std::size_t> knee(std::span<const Tradeoff> front);

}  // namespace palpate::chart
