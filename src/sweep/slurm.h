// A job file for Slurm: an array of tasks, each of which runs one part of a sweep.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sweep/journal.h"

namespace palpate::sweep {

struct SlurmJob {
  std::string name;
  std::string program;    // as a shell takes it
  std::string prologue;   // lines that a task runs first
  std::string folder;     // of the plan, absolute
  std::size_t tasks = 1;  // of the array: the number of parts
  std::string more = {};  // options of a task, after a space
  std::string time;       // limit per task, as Slurm writes it; empty: the cluster's default
};

// Longer arrays are refused at some sites.
inline constexpr std::size_t usual_array = 1000;

// The text of the job file. The number of a task determines its part, even if sent again.
[[nodiscard]] std::string slurm_text(const SlurmJob& job);

// The numbers, from 1, of the parts that lack rows.
[[nodiscard]] std::vector<std::size_t> unfinished_parts(const SweepPlan& plan,
                                                        const SweepResults& results,
                                                        std::size_t parts);

// Ascending numbers as `1-3,7`; after `most` ranges (0: no limit) follows `...`.
[[nodiscard]] std::string number_ranges(const std::vector<std::size_t>& numbers, std::size_t most);

}  // namespace palpate::sweep
