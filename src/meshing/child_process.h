// Runs work in a forked child process, so that crashes do not end this process.
#pragma once

#include <functional>
#include <string>
#include <variant>

namespace palpate::meshing {

struct ChildAnswer {
  std::string bytes;
};
struct ChildExit {
  int code;  // other than 0
};
struct ChildSignal {
  int number;
};
struct ChildTimeout {};

using ChildResult = std::variant<ChildAnswer, ChildExit, ChildSignal, ChildTimeout>;

struct ChildLimits {
  double time;    // s, wall clock, above 0; CPU time is limited as well (SIGXCPU)
  double memory;  // bytes in addition to what this process uses
};

// Runs `work` in a forked child and returns its result. The child has stdin, stdout and stderr on
// /dev/null, no other open files and no core dump, and never continues the caller's code. An
// exception from `work` becomes exit code 1. Several threads may call this at once; the child is
// reaped in every case. Throws SystemError if pipe() or fork() fails.
[[nodiscard]] ChildResult run_in_child(const std::function<std::string()>& work,
                                       const ChildLimits& limits);

}  // namespace palpate::meshing
