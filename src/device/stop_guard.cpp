// Signal handlers and a second process that send the stop.
#include "device/stop_guard.h"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <new>

#include "base/error.h"
#include "base/index.h"
#include "device/clock.h"

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

// A full queue is emptied and the write repeated, because the stop matters more than its content.
void write_stop(int line, std::string_view bytes) {
  for (int tries = 0; tries < 3 && !bytes.empty(); ++tries) {
    if (::write(line, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size())) return;
    if (errno == EAGAIN) ::tcflush(line, TCOFLUSH);
  }
}

void write_packed(int file, unsigned value) {
  char bytes[4];
  std::size_t size = 0;
  for (; size < 4 && (value >> (8 * size) & 0xffu) != 0; ++size)
    bytes[size] = static_cast<char>(value >> (8 * size) & 0xffu);
  write_stop(file, {bytes, size});
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

// After fork() the guard calls only functions that are async-signal-safe, because other threads of
// the program may have held locks.

struct GuardProcess::Shared {
  std::atomic<unsigned> beats = 0;
  std::atomic<unsigned> stops = 0;
  std::atomic<bool> motion = false;
  std::atomic<double> looked = 0.0;  // s, wire_time(), when the guard looked last
};

namespace {

static_assert(std::atomic<double>::is_always_lock_free);

constexpr int look_time = 5;         // ms, between two looks at the program
constexpr double again_time = 0.05;  // s, between two stops
constexpr int most_stops = 10;       // in half a second, as Mark10::stop()
constexpr double deaf_time = 0.25;   // s without a look, after which the guard counts as dead
constexpr int priority = 90;         // above that of --realtime, of 1 to 99

void leave_the_terminal() {
  ::setsid();
  ::prctl(PR_SET_NAME, "stand-stop");  // `pkill palpate` does not find it
  sched_param wanted{};
  wanted.sched_priority = priority;
  ::sched_setscheduler(0, SCHED_FIFO, &wanted);  // without permission it stays an ordinary process
  // Whoever reads the program's output must not wait for the guard.
  const int nothing = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
}

// Sends the stop, the second time after the end of a channel to the gauge that may be open.
class Stops {
 public:
  explicit Stops(int line) : line_(line) {}
  [[nodiscard]] bool due(double now) const { return sent_ < most_stops && now >= next_; }
  void send(double now) {
    write_stop(line_, sent_ == 0 ? "s" : "\\s");
    ++sent_;
    next_ = now + again_time;
  }
  [[nodiscard]] bool over() const { return sent_ == most_stops; }

 private:
  int line_;
  int sent_ = 0;
  double next_ = 0.0;  // s
};

template <class Shared>  // GuardProcess::Shared, which is private
[[noreturn]] void guard(int line, int socket, Shared& shared, GuardProcess::Heed heed) {
  leave_the_terminal();
  unsigned beats = shared.beats;
  double heard = wire_time();
  Stops stops(line);
  while (true) {
    pollfd program{socket, POLLIN, 0};
    ::poll(&program, 1, look_time);
    const double now = wire_time();
    shared.looked = now;
    char last = 0;
    if (program.revents != 0 && ::recv(socket, &last, 1, MSG_DONTWAIT) == 1) ::_exit(0);
    if (program.revents != 0) break;  // the program has ended without saying so
    if (shared.beats != beats || !shared.motion || heed == GuardProcess::Heed::end_only) {
      beats = shared.beats;
      heard = now;
      stops = Stops(line);
    } else if (now - heard > GuardProcess::silence && stops.due(now)) {
      stops.send(now);
      ++shared.stops;
    }
  }
  for (stops = Stops(line); !stops.over(); ::poll(nullptr, 0, look_time))
    if (const double now = wire_time(); stops.due(now)) stops.send(now);
  ::_exit(0);
}

}  // namespace

GuardProcess::GuardProcess(int file, Heed heed) : heed_(heed) {
  const auto refuse = [&] {
    throw LinkError(std::string("palpate: the process that guards the stand cannot be started: ") +
                    std::strerror(errno) + "; end some programs and try again");
  };
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) refuse();
  socket_ = ends[0];
  const Descriptor others = ends[1];
  void* memory =
      ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) refuse();
  shared_ = new (memory) Shared;
  shared_->looked = wire_time();
  // All signals are blocked in the guard, from its first moment on.
  sigset_t all;
  sigset_t usual;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &usual);
  child_ = ::fork();
  if (child_ != 0) ::pthread_sigmask(SIG_SETMASK, &usual, nullptr);
  if (child_ < 0) refuse();
  if (child_ == 0) {
    socket_ = {};
    // Above the standard streams, which the guard gives up.
    guard(::fcntl(file, F_DUPFD, 3), ::fcntl(others, F_DUPFD, 3), *shared_, heed);
  }
}

GuardProcess::~GuardProcess() {
  (void)::send(socket_, "e", 1, MSG_NOSIGNAL);
  socket_ = {};
  // A guard that is stopped would never end.
  if (!ended_) ::kill(child_, SIGCONT);
  while (!ended_ && ::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
  ::munmap(shared_, sizeof(Shared));
}

void GuardProcess::beat() { ++shared_->beats; }

void GuardProcess::watch(bool motion) {
  beat();
  shared_->motion = motion;
}

bool GuardProcess::alive() {
  if (!ended_) ended_ = ::waitpid(child_, nullptr, WNOHANG) != 0;
  if (ended_) return false;
  return heed_ == Heed::end_only || wire_time() - shared_->looked < deaf_time;
}

bool GuardProcess::has_acted() {
  const unsigned earlier = seen_;
  seen_ = shared_->stops;
  return seen_ != earlier;
}

}  // namespace palpate::device
