// A job file for Slurm: an array whose tasks run a part of a sweep each.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "study/sweep_journal.h"

namespace palpate::study {

struct SlurmJob {
  std::string name;
  std::string program;    // its path
  std::string folder;     // the plan's, absolute
  std::size_t tasks = 1;  // of the array, and parts of the sweep
  std::string time;       // limit of a task; empty: the cluster's
};

// Some sites take no longer arrays.
inline constexpr std::size_t usual_array = 1000;

// The job file. A task takes its part by its own number: an array that is sent again with some of
// the numbers does the same work as before.
[[nodiscard]] std::string slurm_text(const SlurmJob& job);

// The numbers of the tasks whose part lacks rows, as an array has them: `1-3,7`; empty: none.
[[nodiscard]] std::string unfinished_tasks(const SweepPlan& plan, const SweepResults& results,
                                           std::size_t tasks);

// A word for a shell, whatever is in it.
[[nodiscard]] std::string shell_word(const std::string& text);

// Numbers in ascending order as `1-3,7`, no more than `most` ranges, then `...`; 0: all.
[[nodiscard]] std::string number_ranges(const std::vector<std::size_t>& numbers, std::size_t most);

}  // namespace palpate::study
