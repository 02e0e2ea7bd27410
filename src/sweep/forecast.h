// What a sweep will take, from running a few of its cases.
#pragma once

#include <string>

#include "scenario/family.h"

namespace palpate::sweep {

// The time on one worker and the size of the results, as text. Runs some neighbouring cases for up
// to about two seconds: once with all that cases share, and once without. Empty if a case is
// invalid or fails.
[[nodiscard]] std::string forecast(const scenario::Family& family, bool keeps_curves);

}  // namespace palpate::sweep
