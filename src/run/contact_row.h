// Converts a touch to a row of results.
#pragma once

#include "mechanics/contacts.h"
#include "record/record.h"

namespace palpate::run {

// The row, without step and time. Allocates nothing.
[[nodiscard]] record::ContactRow contact_row(const scene::Scene& scene,
                                             const mechanics::Touch& touch);

}  // namespace palpate::run
