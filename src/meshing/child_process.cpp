// A forked child with a pipe and a deadline; the parent never waits longer than the deadline.
#include "meshing/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "base/index.h"

namespace palpate::meshing {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double for_ever = 3.15e7;  // s: a year, within the range of every clock

// The address space in use, in bytes, or 0 if the system does not report it. Limits are added to
// it, because a sanitizer alone reserves terabytes.
double address_space() {
  double pages = 0.0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

void limit(decltype(RLIMIT_AS) resource, double amount) {
  rlimit value{};
  getrlimit(resource, &value);
  const double hard =
      value.rlim_max == RLIM_INFINITY ? INFINITY : static_cast<double>(value.rlim_max);
  value.rlim_cur = static_cast<rlim_t>(std::min(amount, hard));
  setrlimit(resource, &value);
}

bool write_all(int file, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = write(file, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) done += as_index(count);
  }
  return true;
}

// All that the child does. Stdio buffers copied from the parent are never flushed: whatever the
// library prints goes to /dev/null, and _exit() does not flush.
[[noreturn]] void live(int pipe_end, const std::function<std::string()>& work,
                       const ChildLimits& limits, double address_space_before) {
  const int null = open("/dev/null", O_RDWR);
  for (const int standard : {0, 1, 2}) dup2(null, standard);
  const int answer = pipe_end == 3 ? 3 : dup2(pipe_end, 3);
  close_range(4, ~0U, 0);  // otherwise other children's pipes would stay open
  for (const int signal :
       {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE, SIGXCPU, SIGTERM, SIGINT})
    std::signal(signal, SIG_DFL);
  limit(RLIMIT_CORE, 0.0);
  limit(RLIMIT_CPU, std::ceil(std::min(limits.time, for_ever)) + 1.0);
  if (address_space_before > 0.0) limit(RLIMIT_AS, address_space_before + limits.memory);
  try {
    _exit(write_all(answer, work()) ? 0 : 1);
  } catch (...) {
    _exit(1);
  }
}

// Milliseconds until `deadline` for poll(), rounded up; 0 when it has passed.
int remaining(Clock::time_point deadline) {
  const double left = std::chrono::duration<double, std::milli>(deadline - Clock::now()).count();
  return static_cast<int>(std::clamp(std::ceil(left), 0.0, 1e9));
}

// True at the end of the answer, false at the deadline.
bool read_until(int file, Clock::time_point deadline, std::string& bytes) {
  std::array<char, 65536> buffer;
  while (true) {
    pollfd wanted{file, POLLIN, 0};
    const int ready = poll(&wanted, 1, remaining(deadline));
    if (ready == 0) return false;
    if (ready < 0) continue;  // EINTR: check the time again
    const ssize_t count = read(file, buffer.data(), buffer.size());
    if (count == 0) return true;
    if (count > 0) bytes.append(buffer.data(), as_index(count));
  }
}

int reap(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

ChildResult run_in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  const std::chrono::duration<double> time(std::min(limits.time, for_ever));
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
  const double before = address_space();
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw SystemError(std::string("no pipe to a child process: ") + std::strerror(errno));
  const pid_t child = fork();
  if (child == 0) live(ends[1], work, limits, before);
  const int fork_error = errno;
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    throw SystemError(std::string("no child process: ") + std::strerror(fork_error));
  }

  ChildAnswer answer;
  const bool in_time = read_until(ends[0], deadline, answer.bytes);
  if (!in_time) kill(child, SIGKILL);
  close(ends[0]);
  const int status = reap(child);
  if (!in_time) return ChildTimeout{};
  if (WIFSIGNALED(status)) return ChildSignal{WTERMSIG(status)};
  if (WEXITSTATUS(status) != 0) return ChildExit{WEXITSTATUS(status)};
  return answer;
}

}  // namespace palpate::meshing
