// Points that fill a unit cube evenly: Latin hypercubes and the Sobol sequence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpate::scenario {

// `samples` points of the Sobol sequence in [0, 1)^dimensions, one row per point, with the
// direction numbers of Joe and Kuo (SIAM J. Sci. Comput. 30, 2635, 2008), in the order of Gray
// codes, not scrambled. The first point, the origin, is left out: the sequence begins with (1/2,
// 1/2, ...). 1 <= dimensions <= most_sobol_dimensions.
[[nodiscard]] std::vector<double> sobol_points(std::size_t samples, std::size_t dimensions);
inline constexpr std::size_t most_sobol_dimensions = 3667;

// A Latin hypercube in [0, 1)^dimensions (McKay, Beckman and Conover, Technometrics 21, 239, 1979),
// one row per point: in every dimension each of the `samples` strata [k, k + 1) / samples contains
// one point, uniformly distributed in it. The numbers are those of std::mt19937_64, which the C++
// standard fixes; distributions of the library, which differ, are not used. For one dimension after
// the other, the strata are permuted (Fisher and Yates, from the last to the second), then a place
// in each is drawn. samples <= 2^24.
[[nodiscard]] std::vector<double> latin_hypercube(std::size_t samples, std::size_t dimensions,
                                                  std::uint64_t seed);

}  // namespace palpate::scenario
