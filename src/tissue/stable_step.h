// The highest frequency of a network, which limits the explicit time step.
#pragma once

#include <span>

#include "tissue/springs.h"

namespace palpate::tissue {

// An upper bound of omega_max^2, 1/s^2: max over nodes of sum_j |K_ij| / m_i, with K_ij the 3 x 3
// blocks of each spring, tetrahedron and volume taken separately; 2 sum_j k_ij / m_i for
// independent springs. Needs no assembled matrix. docs/theory.md [limit]
[[nodiscard]] double safe_frequency_squared(const Network& network);

// The largest eigenvalue omega_max^2 (1/s^2) of M^-1 K without the held degrees of freedom, by
// largest_eigenpair(). The residual, at most 1e-6 of it (1e-4 on large bodies), is added, so that
// the result is at least the eigenvalue found; it never exceeds safe_frequency_squared(). Throws
// MeshError like that.                                                  docs/theory.md [limit]
[[nodiscard]] double largest_frequency_squared(const Network& network, std::span<const char> held);

// Pseudo-random numbers in [-1/2, 1/2), the same on every machine.
[[nodiscard]] Vector scattered(Eigen::Index size);

}  // namespace palpate::tissue
