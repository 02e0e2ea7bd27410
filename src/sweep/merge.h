// All rows of a sweep as one table, in the order of the plan.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "base/whole_folder.h"
#include "sweep/answer.h"
#include "sweep/journal.h"
#include "sweep/plan.h"

namespace palpate::sweep {

struct SweepTotals {
  std::size_t cases = 0;
  std::size_t completed = 0;
  std::size_t diverged = 0;
  std::size_t failed = 0;  // could not be built
  std::size_t missing = 0;
  std::map<std::string, std::size_t> reasons = {};  // number of diverged or failed cases by reason
  std::string missing_numbers = {};                 // as `3,7-9`, at most 12 ranges
};
[[nodiscard]] SweepTotals count_results(const SweepPlan& plan, const SweepResults& results);

// Writes results.csv, the curves of a plan with `--curves` (force_indentation.csv or
// strain_time.csv) and merged.json into `folder`, which must be open. A case without a row gets a
// row with the outcome `missing`. The bytes do not depend on parts, workers or the order in which
// cases ran. Returns what the completed cases say together. Throws SystemError if a file cannot be
// written.
SweepAnswer merge_sweep(const SweepPlan& plan, const SweepResults& results,
                        const SweepTotals& totals, WholeFolder& folder);

}  // namespace palpate::sweep
