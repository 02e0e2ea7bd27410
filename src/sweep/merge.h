// All rows of a sweep as one table, in the order of the plan, and what they say of their models,
// errors and neglected effects.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "base/whole_folder.h"
#include "sweep/columns.h"
#include "sweep/journal.h"
#include "sweep/plan.h"
#include "sweep/row.h"

namespace palpate::sweep {

// Collects rows one by one, without keeping them.
class SweepAnswer {
 public:
  std::string tolerance;  // of the errors, `5 %`; empty where cases have their own

  // `number`: of the case, from 1. Rows of cases that did not end as they should count for nothing.
  void see(const SweepRow& row, std::size_t number);

  // `± 3 % (tolerance 5 %)`, `± 3 % to 41 %, not counting viscosity` of the completed cases; a
  // sentence's part where an error is not known.
  [[nodiscard]] std::string error() const;

  // The models, then one line per neglected effect with its largest change. Empty without cases.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  // An effect that cases neglect.
  struct Effect {
    std::string what;
    std::size_t cases = 0;
    double largest = 0.0;
    std::string sentence{};  // of the case with the largest change
    std::size_t number = 0;  // of that case
  };
  std::size_t cases_ = 0;
  std::size_t unknown_ = 0;  // cases without a stated error
  std::size_t uncounted_cases_ = 0;
  std::string uncounted_;  // the longest text on what an error does not contain
  std::map<std::string, std::size_t> models_;
  Ends errors_;  // as parts of 1
  std::vector<Effect> effects_;
};

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
