// The programme that a stand really carried out, read from the travel that it reported.
#pragma once

#include <optional>
#include <vector>

#include "record/record.h"
#include "scenario/scenario.h"

namespace palpate::live {

// The steps of a programme of presses, holds and withdrawals with the rates, turning points and
// times of the record. It begins with a hold, up to the moment at which the stand set off. Each
// rate and the two ends of its motion are those of a straight line through the readings in the
// middle of the way, which averages their resolution. Nothing for a recording without a motion of
// at least five readings, and for one that diverged or was stopped.
[[nodiscard]] std::optional<std::vector<scenario::Step>> as_moved(
    const record::CaseRecord& record, const std::vector<scenario::Step>& planned);

}  // namespace palpate::live
