// A child with a pipe and a deadline; the parent never waits longer than the deadline.
#include "base/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
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
#include "base/files.h"
#include "base/index.h"
#include "base/stop_scope.h"

namespace palpate {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double for_ever = 3.15e7;  // s: a year, within the range of every clock
constexpr std::size_t most_output = std::size_t{1} << 20;

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(std::min(seconds, for_ever)));
}

// A pipe that no other child inherits; its ends are closed with it.
struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
      throw SystemError(std::string("no pipe can be made: ") + std::strerror(errno));
    reads = ends[0];
    writes = ends[1];
  }
  Descriptor reads, writes;
};

// Reads until the other end is closed. Returns false if `end` or a stop comes first, or where
// nothing more can be read: `error` is then the number of the error.
bool drain(int pipe, Clock::time_point end, std::size_t most, std::string& output, int& error) {
  std::array<char, 65536> buffer;
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0 || StopScope::stopped()) return false;
    pollfd waiting{pipe, POLLIN, 0};
    constexpr long until_next_look = 50;  // ms: a signal may reach another thread
    if (::poll(&waiting, 1, static_cast<int>(std::min(left, until_next_look))) <= 0) continue;
    const ssize_t got = ::read(pipe, buffer.data(), buffer.size());
    if (got > 0) output.append(buffer.data(), std::min(as_index(got), most - output.size()));
    if (got == 0) return true;
    if (got < 0 && errno != EINTR) {
      error = errno;
      return false;
    }
  }
}

// Waits for a child and returns its status. Kills it (if negative, its group) at `end`, or at once
// unless `in_time`.
int wait_for(pid_t child, pid_t whom, Clock::time_point end, bool& in_time) {
  int status = 0;
  while (in_time && ::waitpid(child, &status, WNOHANG) == 0) {
    in_time = Clock::now() < end && !StopScope::stopped();
    constexpr useconds_t pause = 1000;
    if (in_time) ::usleep(pause);
  }
  if (in_time) return status;
  ::kill(whom, SIGKILL);
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

// What a child that has been started writes, and how it ends.
ChildResult follow(Pipe& pipe, pid_t child, bool with_its_group, Clock::time_point end,
                   std::size_t most, const std::string& name) {
  pipe.writes = {};
  ChildResult result;
  int error = 0;
  bool in_time = drain(pipe.reads, end, most, result.output, error);
  const int status = wait_for(child, with_its_group ? -child : child, end, in_time);
  if (error != 0)
    throw SystemError("the output of " + name + " cannot be read: " + std::strerror(error));
  if (!in_time) {
    result.end = StopScope::stopped() ? ChildResult::End::stopped : ChildResult::End::timed_out;
  } else if (WIFSIGNALED(status)) {
    result.end = ChildResult::End::killed;
    result.code = WTERMSIG(status);
  } else {
    result.code = WEXITSTATUS(status);
  }
  return result;
}

// Settings of another program: empty input, one pipe for both outputs, working directory, and a
// process group of its own, so that it can be killed together with its children.
class Setup {
 public:
  Setup(int output, const std::string& folder) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, 1);
    posix_spawn_file_actions_adddup2(&actions, output, 2);
    if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
  }
  ~Setup() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  Setup(const Setup&) = delete;
  Setup& operator=(const Setup&) = delete;

  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

// The address space in use, in bytes, or 0 if the system does not report it. Limits are added to
// it, because a sanitizer alone reserves terabytes.
double address_space() {
  double pages = 0.0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

void limit(decltype(RLIMIT_AS) resource, double amount) {
  rlimit value{};
  ::getrlimit(resource, &value);
  const double hard =
      value.rlim_max == RLIM_INFINITY ? INFINITY : static_cast<double>(value.rlim_max);
  value.rlim_cur = static_cast<rlim_t>(std::min(amount, hard));
  ::setrlimit(resource, &value);
}

// All that a forked child does. Stdio buffers copied from the parent are never flushed: whatever a
// library prints goes to /dev/null, and _exit() does not flush.
[[noreturn]] void live(int pipe_end, const std::function<std::string()>& work,
                       const ChildLimits& limits, double address_space_before) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int null = ::open("/dev/null", O_RDWR);
  for (const int standard : {0, 1, 2}) ::dup2(null, standard);
  const int answer = pipe_end == 3 ? 3 : ::dup2(pipe_end, 3);
  ::close_range(4, ~0U, 0);  // otherwise other children's pipes would stay open
  for (const int signal :
       {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE, SIGXCPU, SIGTERM, SIGINT})
    std::signal(signal, SIG_DFL);
  limit(RLIMIT_CORE, 0.0);
  limit(RLIMIT_CPU, std::ceil(std::min(limits.time, for_ever)) + 1.0);
  if (address_space_before > 0.0) limit(RLIMIT_AS, address_space_before + limits.memory);
  try {
    ::_exit(write_all(answer, work()) ? 0 : 1);
  } catch (...) {
    ::_exit(1);
  }
}

}  // namespace

ChildResult run_process(const Command& command) {
  Pipe pipe;
  std::vector<char*> argv;
  for (const std::string& word : command.argv) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const auto end = after(command.limit);
  const std::string name = "`" + command.argv[0] + "`";
  pid_t child = 0;
  const Setup setup(pipe.writes, command.folder);
  const int error =
      ::posix_spawnp(&child, argv[0], &setup.actions, &setup.attributes, argv.data(), environ);
  if (error == ENOENT || error == EACCES) return {.end = ChildResult::End::not_found};
  if (error != 0) throw SystemError(name + " cannot be started: " + std::strerror(error));
  return follow(pipe, child, true, end, most_output, name);
}

ChildResult run_in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  const auto end = after(limits.time);
  const double before = address_space();
  Pipe pipe;
  const pid_t child = ::fork();
  if (child == 0) live(pipe.writes, work, limits, before);
  if (child < 0) throw SystemError(std::string("no child process: ") + std::strerror(errno));
  ChildResult result = follow(pipe, child, false, end, std::string::npos, "a child process");
  if (result.end == ChildResult::End::stopped) throw Stopped();
  return result;
}

}  // namespace palpate
