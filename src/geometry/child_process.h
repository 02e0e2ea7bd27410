// Work in a forked child: bytes come back, crashes do not.
#pragma once

#include <functional>
#include <string>
#include <variant>

namespace palpate::geometry {

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
  double time;    // s, of the wall clock; more than 0
  double memory;  // bytes beyond what this process already has
};

// Runs `work` in a forked child and returns what it returned. The child has stdin, stdout and
// stderr on /dev/null, no other open files, no core dump, and never returns into the caller's
// code; `std::bad_alloc` and other exceptions from `work` become exit code 1.
// Safe in several threads at once; the child is reaped in every case.
// Throws SystemError where pipe() or fork() fails.
[[nodiscard]] ChildResult run_in_child(const std::function<std::string()>& work,
                                       const ChildLimits& limits);

}  // namespace palpate::geometry
