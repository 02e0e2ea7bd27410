// A touch as a row of results.
#pragma once

#include "record/record.h"
#include "run/contacts.h"

namespace palpate::run {

// All of the row but its step and time. Allocates nothing.
[[nodiscard]] record::ContactRow contact_row(const scene::Scene& scene, const Touch& touch);

}  // namespace palpate::run
