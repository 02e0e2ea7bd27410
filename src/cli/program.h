// The program: arguments in, an exit code out.
#pragma once

#include <string>
#include <vector>

namespace palpate::cli {

// Exit codes of all verbs.
enum Exit {
  exit_good = 0,
  exit_internal = 1,
  exit_input = 2,
  exit_different = 3,
  exit_diverged = 4,
  exit_mesh = 5,
  exit_device = 6,      // a link, or a stop for safety
  exit_partial = 7,     // a sweep with missing, diverged or failed cases; inseparable unknowns
  exit_held = 8,        // another process runs the part of a sweep
  exit_resumable = 75,  // interrupted; the same call continues
  exit_interrupted = 130,
};

// Version, build type, compiler and flags. A plan's runs and a chart's calls must share these.
[[nodiscard]] std::string program_identity();

// Runs the verb in `arguments` (without the program's name) and returns its exit code. Does not
// throw: prints errors on stderr.
[[nodiscard]] int program(const std::vector<std::string>& arguments);

}  // namespace palpate::cli
