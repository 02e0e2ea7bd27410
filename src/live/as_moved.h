// The loading history that a stand really carried out, read from the travel that it reported.
#pragma once

#include <optional>
#include <vector>

#include "record/record.h"
#include "scenario/scenario.h"

namespace palpate::live {

// The presses and holds of a loading history up to its first withdrawal, with the rates, travels
// and times of the record. The first step is a hold until the stand sets off. The rate and the ends
// of a motion are those of a line fitted to the readings in its middle, which averages their
// resolution. Nothing without five readings in every motion, and for a run that diverged or was
// stopped.
[[nodiscard]] std::optional<std::vector<scenario::Step>> as_moved(
    const record::CaseRecord& record, const std::vector<scenario::Step>& planned);

}  // namespace palpate::live
