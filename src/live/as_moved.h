// The programme that a stand really carried out, read from the travel that it reported.
#pragma once

#include <optional>
#include <vector>

#include "record/record.h"
#include "scenario/scenario.h"

namespace palpate::live {

// The presses and holds of a programme up to its first withdrawal, with the rates, travels and
// times of the record. They begin with a hold, up to the moment at which the stand set off. The
// rate and the two ends of every motion are those of a straight line through the readings in the
// middle of its way, which averages their resolution. Nothing without five readings in every
// motion, and for a run that diverged or was stopped.
[[nodiscard]] std::optional<std::vector<scenario::Step>> as_moved(
    const record::CaseRecord& record, const std::vector<scenario::Step>& planned);

}  // namespace palpate::live
