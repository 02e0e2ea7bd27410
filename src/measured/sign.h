// Signs of load cells and crossheads whose values are negative in compression.
#pragma once

#include "measured/measured.h"

namespace palpate::measured {

// Changes the sign of loads that are negative in compression, according to DataLayout::compression
// or, for `auto`, to the curve; then also that of a length that decreases while the load grows.
// Adds a note for each change. Throws InputError if `auto` is ambiguous or the word is unknown.
void orient(MeasuredCurve& curve, const DataLayout& layout);

}  // namespace palpate::measured
