// Load cells and crossheads that read compression negative.
#pragma once

#include "record/measured.h"

namespace palpate::record {

// Turns what reads compression negative, as the layout says or, with `auto`, as the curve shows,
// and notes what it turned. Throws InputError where `auto` cannot tell, and on an unknown word.
void orient(MeasuredCurve& curve, const DataLayout& layout);

}  // namespace palpate::record
