// Other programs, and work that may crash: child processes with a limit of time.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace palpate {

struct ChildResult {
  enum class End { exited, killed, timed_out, not_found, stopped };

  End end = End::exited;
  int code = 0;             // exit status, or the number of the signal if killed
  std::string output = {};  // stdout and stderr in one, the first MiB; or what the work returned

  [[nodiscard]] bool good() const { return end == End::exited && code == 0; }
};

struct Command {
  std::vector<std::string> argv = {};  // the program is looked up in PATH
  std::string folder = {};             // working directory; empty: the current one
  double limit = 30.0;                 // s, after which the program and its children are killed
};

// Runs the command with an empty standard input. Where the thread's StopScope is stopped meanwhile,
// the program is killed. Throws SystemError if no process can be started.
[[nodiscard]] ChildResult run_process(const Command& command);

struct ChildLimits {
  double time;    // s, wall clock, above 0; CPU time is limited as well (SIGXCPU)
  double memory;  // bytes in addition to what this process uses
};

// Runs `work` in a forked child and returns its result. The child has stdin, stdout and stderr on
// /dev/null, no other open files and no core dump, and never continues the caller's code. An
// exception from `work` becomes exit code 1. Several threads may call this at once; the child is
// reaped in every case, and ends with the thread that called. Throws SystemError if pipe() or
// fork() fails, and Stopped where the thread's StopScope is stopped meanwhile.
[[nodiscard]] ChildResult run_in_child(const std::function<std::string()>& work,
                                       const ChildLimits& limits);

}  // namespace palpate
