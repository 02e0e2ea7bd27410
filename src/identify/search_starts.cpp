// Starting points by radical inverses to the first primes (Halton 1960, Numer. Math. 2).
#include "identify/search_starts.h"

#include <algorithm>
#include <array>

namespace palpate::identify {
namespace {

constexpr std::array<int, 10> primes{2, 3, 5, 7, 11, 13, 17, 19, 23, 29};

double radical_inverse(int number, int base) {
  double inverse = 0.0;
  double digit = 1.0 / base;
  for (; number > 0; number /= base, digit /= base) inverse += (number % base) * digit;
  return inverse;
}

}  // namespace

std::vector<std::vector<double>> search_starts(std::size_t unknowns) {
  std::vector<std::vector<double>> starts{std::vector<double>(unknowns, 0.5)};
  for (std::size_t k = 1; k <= 4 * unknowns; ++k) {
    starts.emplace_back();
    for (std::size_t i = 0; i < unknowns; ++i)
      starts.back().push_back(
          radical_inverse(static_cast<int>(k + i / primes.size()), primes[i % primes.size()]));
  }
  return starts;
}

SearchResult search_from_several(const BoxProblem& problem, int searches) {
  struct Start {
    std::vector<double> u;
    double squares;
  };
  SearchResult result;
  std::vector<Start> starts;
  for (const std::vector<double>& u : search_starts(problem.unknowns)) {
    const BoxMinimum at = evaluate_in_box(problem, u, Want::squares);
    result.evaluations += at.evaluations;
    if (at.found) starts.push_back({u, at.squares});
  }
  std::stable_sort(starts.begin(), starts.end(), [](const Start& one, const Start& other) {
    return one.squares < other.squares;
  });
  for (std::size_t k = 0; k < std::min(as_index(searches), starts.size()); ++k) {
    BoxMinimum minimum = minimise_in_box(problem, starts[k].u, {});
    result.evaluations += minimum.evaluations;
    // Of minima that are equal up to rounding, the first is kept.
    if (minimum.found &&
        (!result.best.found || minimum.squares < result.best.squares * (1.0 - 1e-9)))
      result.best = std::move(minimum);
  }
  return result;
}

}  // namespace palpate::identify
