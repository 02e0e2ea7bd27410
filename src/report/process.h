// A program of the system, run to its end or to a time limit.
#pragma once

#include <string>
#include <vector>

namespace palpate::report {

struct ProcessResult {
  enum class End { exited, killed, timed_out, not_found };

  End end = End::exited;
  int code = 0;             // the exit status, or the signal's number where killed
  std::string output = {};  // stdout and stderr, as they came
};

struct Command {
  std::vector<std::string> argv = {};  // the program is looked up in PATH
  std::string folder = {};             // where it runs; empty: here
  double limit = 30.0;                 // s; then the program and its children are killed
};

// Runs the command with nothing to read. Throws SystemError where no process can be made.
[[nodiscard]] ProcessResult run_process(const Command& command);

}  // namespace palpate::report
