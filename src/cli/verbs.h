// One function per verb of the command line.
#pragma once

#include "cli/arguments.h"
#include "cli/talk.h"

namespace palpate::cli {

// Carries out a verb and returns its exit code. Throws InputError, MeshError, LinkError and
// SystemError, which program() turns into exit codes.
[[nodiscard]] int perform(const Run& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Explain& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Fit& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Data& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Compare& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Golden& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Reference& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Chart& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Stability& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Sweep& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Identify& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Device& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const New& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Open& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Schema& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Completion& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Manual& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int perform(const Convert& command, const Arguments& arguments, const Talk& talk);

// `chart --frames`.
[[nodiscard]] int time_frames(const Chart& command, const Talk& talk);

// `run --device`.
[[nodiscard]] int run_live(const Run& command, const Arguments& arguments, const Talk& talk);

}  // namespace palpate::cli
