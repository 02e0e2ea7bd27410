// Signal handlers that send the stop. They use only functions that are async-signal-safe.
#include "device/stop_guard.h"

#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>

#include "base/index.h"

namespace palpate::device {
namespace {

static_assert(std::atomic<int>::is_always_lock_free);
static_assert(std::atomic<unsigned>::is_always_lock_free);

// Packs up to four bytes into one number, which a handler reads atomically; the first is lowest.
constexpr unsigned packed(std::string_view bytes) {
  unsigned value = 0;
  for (std::size_t i = 0; i < bytes.size() && i < 4; ++i)
    value |= static_cast<unsigned>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  return value;
}

std::atomic<int> stop_file = -1;
std::atomic<unsigned> stop_bytes = 0;
std::atomic<unsigned> closing_bytes = 0;
std::atomic<int> watched_child = -1;
std::atomic<unsigned> passed_stops = 0;  // that were sent before a signal
// The stack of the handlers, because the thread's stack may be exhausted. Saving the registers
// takes some 2 to 4 kB (getauxval(AT_MINSIGSTKSZ)), and the handlers need less.
alignas(16) std::array<char, 65536> handler_stack;
std::array<struct sigaction, NSIG> before{};  // by signal; written before a handler can read them

void write_packed(int file, unsigned value) {
  char bytes[4];
  std::size_t size = 0;
  for (; size < 4 && (value >> (8 * size) & 0xffu) != 0; ++size)
    bytes[size] = static_cast<char>(value >> (8 * size) & 0xffu);
  // A full queue is emptied and the write repeated, because the stop matters more than its content.
  for (int tries = 0; tries < 3 && size > 0; ++tries) {
    if (::write(file, bytes, size) == static_cast<ssize_t>(size)) return;
    if (errno == EAGAIN) ::tcflush(file, TCOFLUSH);
  }
}

void send_stop() {
  const int file = stop_file.load();
  if (file < 0) return;
  write_packed(file, closing_bytes.load());
  write_packed(file, stop_bytes.load());
}

bool stops_process(int signal) {
  return signal == SIGTSTP || signal == SIGTTIN || signal == SIGTTOU;
}

// Whether the signal can be caught and is not harmless. SIGCHLD tells that the guard has ended.
bool is_of_concern(int signal) {
  for (const int other : {SIGKILL, SIGSTOP, SIGCONT, SIGURG, SIGWINCH})
    if (signal == other) return false;
  return true;
}

void stop_and_pass_on(int signal, siginfo_t* info, void* context) {
  const int error = errno;
  if (signal != SIGCHLD || info->si_pid == watched_child) {
    send_stop();
    ++passed_stops;
  }
  const struct sigaction& old = before[as_index(signal)];
  if ((old.sa_flags & SA_SIGINFO) != 0) {
    old.sa_sigaction(signal, info, context);
  } else if (old.sa_handler == SIG_DFL && stops_process(signal)) {
    ::raise(SIGSTOP);  // this handler is still there when the process continues
  } else if (old.sa_handler == SIG_DFL && signal != SIGCHLD) {
    // The signal is delivered again when this handler returns.
    ::sigaction(signal, &old, nullptr);
    ::raise(signal);
  } else if (old.sa_handler != SIG_IGN && old.sa_handler != SIG_DFL) {
    old.sa_handler(signal);
  }
  errno = error;
}

// Installs handler_stack. False if the thread already has such a stack, for example under a
// sanitizer; the handlers then run on that one.
bool bring_handler_stack() {
  stack_t old{};
  if (::sigaltstack(nullptr, &old) != 0 || (old.ss_flags & SS_DISABLE) == 0) return false;
  stack_t ours{};
  ours.ss_sp = handler_stack.data();
  ours.ss_size = handler_stack.size();
  return ::sigaltstack(&ours, nullptr) == 0;
}

void take_handler_stack_away() {
  stack_t now{};
  if (::sigaltstack(nullptr, &now) != 0 || now.ss_sp != handler_stack.data()) return;
  stack_t none{};
  none.ss_flags = SS_DISABLE;
  ::sigaltstack(&none, nullptr);
}

}  // namespace

StopGuard::StopGuard(int file, std::string_view bytes) {
  assert(stop_file.load() < 0 && "one stop guard at a time");
  static const int registered = std::atexit(send_stop);
  (void)registered;
  stop_bytes = packed(bytes);
  closing_bytes = 0;
  stop_file = file;
  own_stack_ = bring_handler_stack();
  for (int signal = 1; signal < NSIG; ++signal) {
    auto& old = before[as_index(signal)];
    if (!is_of_concern(signal) || ::sigaction(signal, nullptr, &old) != 0) continue;
    if ((old.sa_flags & SA_SIGINFO) == 0 && old.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_sigaction = stop_and_pass_on;
    action.sa_flags = SA_SIGINFO | SA_RESTART | SA_ONSTACK;
    ::sigaction(signal, &action, nullptr);
  }
}

StopGuard::~StopGuard() {
  send_stop();
  stop_file = watched_child = -1;
  for (int signal = 1; signal < NSIG; ++signal) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) != 0) continue;
    const bool ours = (now.sa_flags & SA_SIGINFO) != 0 && now.sa_sigaction == stop_and_pass_on;
    if (ours) ::sigaction(signal, &before[as_index(signal)], nullptr);
  }
  if (own_stack_) take_handler_stack_away();
}

void StopGuard::open_channel(std::string_view closing) { closing_bytes = packed(closing); }
void StopGuard::close_channel() { closing_bytes = 0; }
void StopGuard::watch_child(pid_t child) { watched_child = child; }
unsigned StopGuard::signals_passed() { return passed_stops; }

}  // namespace palpate::device
