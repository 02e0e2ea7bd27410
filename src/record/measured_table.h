// The table of a device that measures a force and no travel.
#pragma once

#include <vector>

#include "record/record.h"

namespace palpate::record {

// The columns `case,step,time_s,force_N`: the measured force of every row; null if it has none.
[[nodiscard]] Table measured_force_table(const std::vector<CaseRecord>& records);

}  // namespace palpate::record
