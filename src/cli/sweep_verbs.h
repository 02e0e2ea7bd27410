// The verbs of `palpate sweep`; each returns its exit code.
#pragma once

#include <string>

#include "cli/arguments.h"
#include "cli/talk.h"
#include "sweep/journal.h"
#include "sweep/plan.h"

namespace palpate::cli {

[[nodiscard]] int sweep_plan(const Sweep& command, const Talk& talk);
[[nodiscard]] int sweep_run(const Sweep& command, const Talk& talk);  // also `retry`
[[nodiscard]] int sweep_status(const Sweep& command, const Talk& talk);
[[nodiscard]] int sweep_merge(const Sweep& command, const Talk& talk);
[[nodiscard]] int sweep_parts(const Sweep& command, const Talk& talk);
[[nodiscard]] int sweep_slurm(const Sweep& command, const Talk& talk);

// `1 case`, `2 cases`.
[[nodiscard]] std::string cases_text(std::size_t count);

}  // namespace palpate::cli
