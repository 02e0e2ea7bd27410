// Sends a stop to the stand when the program ends, for whatever reason.
#pragma once

#include <sys/types.h>

#include <string_view>

namespace palpate::device {

// Writes `bytes` (at most 4, none of them 0) to the descriptor `file` when it is destroyed (also by
// an exception), when the program exits, and on every signal that can be caught and would end or
// stop the process, even if the stack of the thread that made the guard is exhausted. Afterwards
// the signal's previous action follows. Signals that the program ignores stay ignored. Make the
// guard after other handlers were installed. A second guard at the same time asserts. SIGKILL and
// SIGSTOP are left to GuardProcess.
class StopGuard {
 public:
  StopGuard(int file, std::string_view bytes);
  ~StopGuard();
  StopGuard(const StopGuard&) = delete;
  StopGuard& operator=(const StopGuard&) = delete;

  // Sets the bytes (at most 4) that are sent before the stop while the gauge's channel is open,
  // because the stand would not receive the stop.
  static void open_channel(std::string_view closing);
  static void close_channel();
  // Sends the stop also when this child of the program ends or stops.
  static void watch_child(pid_t child);
  // How many signals have come before which a stop was sent.
  [[nodiscard]] static unsigned signals_passed();

 private:
  bool own_stack_ = false;  // whether this guard installed the stack on which handlers run
};

}  // namespace palpate::device
