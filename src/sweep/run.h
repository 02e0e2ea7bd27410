// Runs the cases of a plan that have no row yet and appends a row for each.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

#include "run/family.h"
#include "sweep/plan.h"

namespace palpate::sweep {

struct SweepTask {
  Shard shard = {};
  int workers = 1;
  enum class Which { missing, failed } which = Which::missing;
};

struct SweepProgress {
  std::size_t all = 0;     // cases of this run
  std::size_t done = 0;    // with a row, failed ones too
  std::size_t failed = 0;  // diverged, or could not be built
};

struct SweepEnd {
  std::size_t all = 0;        // cases of the shard
  std::size_t completed = 0;  // in this run or an earlier one
  std::size_t failed = 0;     // diverged, or could not be built
  std::size_t missing = 0;
  bool interrupted = false;
  std::vector<std::string> warnings = {};  // about rows of earlier runs
};

// Runs the cases of a shard that have no row or, with Which::failed, those whose row says that they
// failed. A case that cannot be built or diverges also gets a row. Rows do not depend on workers,
// order or shards. `told` is called after every row, by one thread at a time. After `no_more`
// is set no case begins; running cases are finished and kept. Throws InputError if another process
// runs this part, and SystemError if a row cannot be written (disk full); earlier rows are kept.
[[nodiscard]] SweepEnd run_sweep(const SweepPlan& plan, const SweepTask& task,
                                 const std::atomic<bool>& no_more,
                                 const std::function<void(const SweepProgress&)>& told);

}  // namespace palpate::sweep
