// The verbs below `palpate sweep`.
#pragma once

#include <string>

#include "cli/arguments.h"
#include "cli/talk.h"
#include "study/sweep_journal.h"
#include "study/sweep_plan.h"

namespace palpate::cli {

[[nodiscard]] int sweep_plan(const Sweep& command, const Talk& talk);
[[nodiscard]] int sweep_run(const Sweep& command, const Talk& talk);  // `retry`, too
[[nodiscard]] int sweep_status(const Sweep& command, const Talk& talk);
[[nodiscard]] int sweep_merge(const Sweep& command, const Talk& talk);
[[nodiscard]] int sweep_slurm(const Sweep& command, const Talk& talk);

// What a plan and its runs must share: version, build, compiler and its flags.
[[nodiscard]] std::string program_identity();

// So many workers as `--jobs` asks for; 0: as there are cores.
[[nodiscard]] int worker_count(int jobs);

// `1 case`, `2 cases`.
[[nodiscard]] std::string cases_text(std::size_t count);

}  // namespace palpate::cli
