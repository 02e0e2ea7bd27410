// A second process that stops the stand when this one has died or does not move on.
#pragma once

#include <sys/types.h>

#include <memory>

namespace palpate::device {

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
  int socket_ = -1;
  pid_t child_ = -1;
  bool ended_ = false;
  unsigned seen_ = 0;  // stops of the guard at the last call of has_acted()
};

}  // namespace palpate::device
