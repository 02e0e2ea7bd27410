// What each verb does. Each returns an exit code and throws what its input deserves.
#pragma once

#include "cli/arguments.h"
#include "cli/talk.h"

namespace palpate::cli {

[[nodiscard]] int run(const Run& command, const Arguments& arguments, const Talk& talk);
// With `command.device`.
[[nodiscard]] int run_live(const Run& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int explain(const Explain& command);
[[nodiscard]] int fit_columns(const Fit& command);
[[nodiscard]] int compare(const Compare& command);
[[nodiscard]] int bless(const Bless& command, const Talk& talk);
[[nodiscard]] int mesh(const Mesh& command, const Talk& talk);
[[nodiscard]] int refer(const Reference& command, const Talk& talk);
[[nodiscard]] int bench(const Bench& command, const Talk& talk);
[[nodiscard]] int chart(const Chart& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int stability(const Stability& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int sweep(const Sweep& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int identify(const Identify& command, const Arguments& arguments, const Talk& talk);
[[nodiscard]] int device(const Device& command, const Talk& talk);
[[nodiscard]] int export_results(const Export& command, const Talk& talk);

}  // namespace palpate::cli
