// Runs another program to its end or to a time limit.
#pragma once

#include <string>
#include <vector>

namespace palpate::plot {

struct ProcessResult {
  enum class End { exited, killed, timed_out, not_found };

  End end = End::exited;
  int code = 0;             // exit status, or the number of the signal if killed
  std::string output = {};  // stdout and stderr in one, the first MiB
};

struct Command {
  std::vector<std::string> argv = {};  // the program is looked up in PATH
  std::string folder = {};             // working directory; empty: the current one
  double limit = 30.0;                 // s, after which the program and its children are killed
};

// Runs the command with an empty standard input. Throws SystemError if no process can be started.
[[nodiscard]] ProcessResult run_process(const Command& command);

}  // namespace palpate::plot
