// Cases of a plan that have no row yet, run and written down one by one.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

#include "run/family.h"
#include "study/sweep_plan.h"
#include "study/sweep_shard.h"

namespace palpate::study {

struct SweepTask {
  Shard shard = {};
  int workers = 1;
  run::Lanes lanes = run::Lanes::where_they_pay;
  enum class Which { missing, failed } which = Which::missing;
  enum class Order { of_the_plan, backwards } order = Order::of_the_plan;
};

// How far it is, for people who wait.
struct SweepProgress {
  std::size_t all = 0;   // cases that this run has taken on
  std::size_t done = 0;  // of them
  std::size_t failed = 0;
  double seconds = 0.0;  // since it began
};

struct SweepEnd {
  std::size_t all = 0;        // cases of the shard
  std::size_t completed = 0;  // of them, earlier runs' too
  std::size_t failed = 0;     // diverged, or not to be built
  std::size_t missing = 0;
  bool interrupted = false;
  std::vector<std::string> warnings = {};  // about rows that were there
};

// Runs a shard's cases: the missing ones, or anew those whose row says that they failed. A case
// that cannot be built or diverges is a row as any other. Rows do not depend on workers, lanes,
// order or shards. `tick` is called about five times a second, on a thread of its own. With
// `no_more` set no case is begun; those that run are finished and kept. Throws InputError where
// another process runs that part, SystemError on a full disk: all rows until then are kept.
[[nodiscard]] SweepEnd run_sweep(const SweepPlan& plan, const SweepTask& task,
                                 const std::atomic<bool>& no_more,
                                 const std::function<void(const SweepProgress&)>& tick);

}  // namespace palpate::study
