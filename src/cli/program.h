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
  exit_resumable = 75,  // interrupted; the same call goes on where it ended
  exit_interrupted = 130,
};

// Runs the verb that `arguments` (without the program's name) ask for. Never throws.
[[nodiscard]] int program(const std::vector<std::string>& arguments);

}  // namespace palpate::cli
