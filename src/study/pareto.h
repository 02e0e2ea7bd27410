// What of many measured choices is worth taking: the Pareto front and its knee.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace palpate::study {

// One choice: what it costs and how wrong it is. Both positive and finite to take part.
struct Tradeoff {
  double cost = 0.0;
  double error = 0.0;
};

// The indices of the choices that no other one beats: none is cheaper and as right, or righter and
// as cheap. By rising cost, hence falling error; of equal ones the first. Choices with a cost or an
// error that is not positive and finite are left out.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const Tradeoff> all);

// Of a front as pareto_front() gives it, the place (0 is the cheapest) that lies farthest below the
// chord from its first to its last choice, in the logarithms of cost and error: before it a little
// cost buys much accuracy, after it much cost buys little. Neither units nor the logarithms' base
// matter, for distances from one chord keep their order under any scaling of the axes.
// Nothing where the front has fewer than three choices, or none lies below the chord.
[[nodiscard]] std::optional<std::size_t> knee(std::span<const Tradeoff> front);

}  // namespace palpate::study
