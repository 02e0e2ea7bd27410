// All rows of a sweep as one table, in the order of the plan.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "study/sweep_journal.h"
#include "study/sweep_plan.h"

namespace palpate::study {

struct SweepTotals {
  std::size_t cases = 0;
  std::size_t completed = 0;
  std::size_t diverged = 0;
  std::size_t failed = 0;  // could not be built
  std::size_t missing = 0;
  std::map<std::string, std::size_t> reasons = {};  // of those that diverged or failed: how many
  std::string missing_numbers = {};  // as `3, 7-9`; the first ones, where they are many

  [[nodiscard]] bool good() const { return completed == cases; }
};
[[nodiscard]] SweepTotals count_results(const SweepPlan& plan, const SweepResults& results);

// Writes PLAN/merged: results.csv, with `--curves` force_indentation.csv or strain_time.csv, and
// merged.json. A case without a row is a row with the outcome `missing`. The bytes are the same
// however the rows came about. Throws InputError where a complete one stands there already and is
// not to be replaced, SystemError where it cannot be written. Returns its folder.
enum class Replace { incomplete, any };
std::string merge_sweep(const SweepPlan& plan, const SweepResults& results,
                        const SweepTotals& totals, Replace replace);

}  // namespace palpate::study
