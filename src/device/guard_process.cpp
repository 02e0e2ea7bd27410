// After fork() the guard calls only functions that are async-signal-safe, because other threads of
// the program may have held locks.
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
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>

#include "base/error.h"
#include "device/clock.h"

namespace palpate::device {

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

// A full queue is emptied first, because the stop matters more than its content.
void write_stop(int line, const char* bytes) {
  for (int tries = 0; tries < 3; ++tries) {
    if (::write(line, bytes, std::strlen(bytes)) >= 0) return;
    if (errno == EAGAIN) ::tcflush(line, TCOFLUSH);
  }
}

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
  std::array<int, 2> ends{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) refuse();
  void* memory =
      ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) refuse();
  shared_ = new (memory) Shared;
  shared_->looked = wire_time();
  // All signals are blocked in the guard, from its first moment on.
  sigset_t all;
  sigset_t before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  child_ = ::fork();
  if (child_ != 0) ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (child_ < 0) refuse();
  if (child_ == 0) {
    ::close(ends[0]);
    // Above the standard streams, which the guard gives up.
    guard(::fcntl(file, F_DUPFD, 3), ::fcntl(ends[1], F_DUPFD, 3), *shared_, heed);
  }
  ::close(ends[1]);
  socket_ = ends[0];
}

GuardProcess::~GuardProcess() {
  (void)::send(socket_, "e", 1, MSG_NOSIGNAL);
  ::close(socket_);
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
  const unsigned before = seen_;
  seen_ = shared_->stops;
  return seen_ != before;
}

}  // namespace palpate::device
