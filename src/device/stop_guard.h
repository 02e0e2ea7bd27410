// The last thing a stand hears from us, whatever ends the program: stop.
#pragma once

#include <array>
#include <csignal>
#include <cstddef>
#include <string_view>

namespace palpate::device {

// While it lives, `bytes` are written to `file` when it is destroyed (also by an exception), when
// the program exits, and on SIGINT, SIGTERM, SIGHUP, SIGQUIT, and as far as that can work on
// SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGABRT, also when the stack of the thread that made the
// guard is used up; the signal then takes the way it had before.
// Signals that the program ignores stay ignored. Make it after other handlers were installed, and
// one at a time: a second one asserts. SIGKILL and a dead machine pass it by, which is why the
// travel limits go into the stand first.
class StopGuard {
 public:
  StopGuard(int file, std::string_view bytes);
  ~StopGuard();
  StopGuard(const StopGuard&) = delete;
  StopGuard& operator=(const StopGuard&) = delete;

  // Bytes that go in front of the stop while a channel to another device is open; at most 4.
  static void open_channel(std::string_view closing);
  static void close_channel();

 private:
  static constexpr std::array signals{SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGSEGV,
                                      SIGBUS, SIGFPE,  SIGILL, SIGABRT};
  bool own_stack_ = false;  // whether handlers run on the stack that it brought
};

}  // namespace palpate::device
