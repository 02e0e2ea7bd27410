// The highest frequency of a network, which bounds the explicit step.
#pragma once

#include <span>

#include "tissue/springs.h"

namespace palpate::tissue {

// omega^2 <= max over nodes of sum_j |K_ij| / m_i, in 1/s^2, K_ij the 3 x 3 blocks of each spring,
// tetrahedron and volume by itself; of independent springs 2 sum_j k_ij / m_i. No matrix, never too
// low.
[[nodiscard]] double safe_frequency_squared(const Network& network);

// omega_max^2 in 1/s^2 of M^-1 K with the held degrees of freedom taken out, by Lanczos with full
// reorthogonalisation; the residual is added, so that the answer is an upper bound of the
// eigenvalue found, and never above the safe one.                         docs/theory.md (42)
[[nodiscard]] double largest_frequency_squared(const Network& network, std::span<const char> held);

}  // namespace palpate::tissue
