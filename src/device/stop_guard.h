// Sends a stop to the stand when the program ends, for whatever reason: signal handlers, and a
// second process for what they cannot see.
#pragma once

#include <sys/types.h>

#include <string_view>

#include "base/files.h"

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

// Holds the serial line `file` open and writes the stop on it when this process has ended without
// ending the guard, or when it has not called beat() for `silence` s while it watches a motion. The
// guard has a session of its own and blocks all signals, so that only SIGKILL and SIGSTOP reach it;
// whoever moves the stand asks alive() before and during the motion. A virtual clock passes with
// the traffic only, so that silence then means nothing.
class GuardProcess {
 public:
  static constexpr double silence = 0.1;  // s
  enum class Heed { silence, end_only };

  // Throws LinkError if the process cannot be started.
  GuardProcess(int file, Heed heed);
  ~GuardProcess();  // ends the guard, which then sends nothing
  GuardProcess(const GuardProcess&) = delete;
  GuardProcess& operator=(const GuardProcess&) = delete;

  void beat();
  void watch(bool motion);
  // False if the guard has ended, or has not looked at this process for 0.25 s.
  [[nodiscard]] bool alive();
  // Whether the guard has sent a stop since the last call.
  [[nodiscard]] bool has_acted();
  [[nodiscard]] pid_t id() const { return child_; }

 private:
  struct Shared;
  Shared* shared_ = nullptr;  // in memory that both processes have
  Heed heed_;
  Descriptor socket_;
  pid_t child_ = -1;
  bool ended_ = false;
  unsigned seen_ = 0;  // stops of the guard at the last call of has_acted()
};

}  // namespace palpate::device
