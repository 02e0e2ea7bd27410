// Signs of load cells and crossheads whose values are negative in compression.
#pragma once

#include <span>

#include "measured/measured.h"

namespace palpate::measured {

// Whether a load over a length is that of a retract alone, whose rest is its last row: the length
// goes one way only, the load is larger at its beginning than at its end, and half-way to its
// largest change more than half of that change is over.
[[nodiscard]] bool only_retracts(std::span<const double> x, std::span<const double> load);

// Changes the sign of loads that are negative in compression, according to DataLayout::compression
// or, for `auto`, to the curve; then also that of a length that decreases while the load grows.
// Adds a note for each change. Throws InputError if `auto` is ambiguous or the word is unknown.
void orient(MeasuredCurve& curve, const DataLayout& layout);

}  // namespace palpate::measured
