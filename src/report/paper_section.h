// A run beside what the paper states about it.
#pragma once

#include <vector>

#include "fit/fit_table.h"
#include "page/html.h"
#include "record/record.h"
#include "scenario/family.h"

namespace palpate::report {

// One row per statement of the paper's text about its Figure 6 or 7 (`output.paper` says which):
// the statement, the value of this run, whether they agree, and why they cannot where they do not.
// The paper's figures have no numbers that could be read. Empty without `output.paper`.
[[nodiscard]] page::Markup paper_section(const scenario::Family& family,
                                         const std::vector<record::CaseRecord>& records,
                                         const std::vector<fit::NamedFit>& fits);

}  // namespace palpate::report
