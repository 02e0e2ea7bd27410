// Sample points; the only file that includes Boost's Sobol sequence.
#include "scenario/sample_points.h"

#include <boost/random/sobol.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace palpate::scenario {
namespace {

// The `bits` highest bits of a number in [0, 2^64), as a fraction of 1.
double part_of_one(std::uint64_t number, int bits) {
  return std::ldexp(static_cast<double>(number >> (64 - bits)), -bits);
}

// Uniformly in [0, count); numbers above the last whole multiple of `count` are drawn again.
std::uint64_t below(std::uint64_t count, std::mt19937_64& generator) {
  constexpr std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t beyond = (last % count + 1) % count;
  std::uint64_t number = generator();
  while (number > last - beyond) number = generator();
  return number % count;
}

}  // namespace

std::vector<double> sobol_points(std::size_t samples, std::size_t dimensions) {
  boost::random::sobol sequence(dimensions);
  std::vector<double> points(samples * dimensions);
  for (double& coordinate : points) coordinate = part_of_one(sequence(), 53);
  return points;
}

std::vector<double> latin_hypercube(std::size_t samples, std::size_t dimensions,
                                    std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<double> points(samples * dimensions);
  std::vector<std::size_t> strata(samples);
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::iota(strata.begin(), strata.end(), std::size_t{0});
    for (std::size_t i = samples; i-- > 1;) std::swap(strata[i], strata[below(i + 1, generator)]);
    // 29 bits inside a stratum and 24 for its number: the sum is exact and below `samples`.
    for (std::size_t i = 0; i < samples; ++i)
      points[i * dimensions + d] = (static_cast<double>(strata[i]) + part_of_one(generator(), 29)) /
                                   static_cast<double>(samples);
  }
  return points;
}

}  // namespace palpate::scenario
