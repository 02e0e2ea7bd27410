// Runs a program by posix_spawn and reads its output through a pipe.
#include "plot/process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "base/error.h"
#include "base/index.h"

namespace palpate::plot {
namespace {

using Clock = std::chrono::steady_clock;

// Settings of the child process: empty input, one pipe for both outputs, working directory, and a
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

constexpr std::size_t most_output = std::size_t{1} << 20;

// Reads until the other end is closed. Returns false if `end` comes first, or where nothing more
// can be read: `error` is then the number of the error.
bool drain(int pipe, Clock::time_point end, std::string& output, int& error) {
  std::array<char, 4096> buffer;
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return false;
    pollfd waiting{pipe, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(left)) <= 0) continue;
    const ssize_t got = ::read(pipe, buffer.data(), buffer.size());
    if (got > 0) output.append(buffer.data(), std::min(as_index(got), most_output - output.size()));
    if (got == 0) return true;
    if (got < 0 && errno != EINTR) {
      error = errno;
      return false;
    }
  }
}

// Waits for a child and returns its status. Kills its group at `end`, or at once unless `in_time`.
int wait_for(pid_t child, Clock::time_point end, bool& in_time) {
  int status = 0;
  while (in_time && ::waitpid(child, &status, WNOHANG) == 0) {
    in_time = Clock::now() < end;
    constexpr useconds_t pause = 1000;
    ::usleep(pause);
    if (in_time) continue;
  }
  if (in_time) return status;
  ::kill(-child, SIGKILL);
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

ProcessResult run_process(const Command& command) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
    throw SystemError(std::string("no pipe can be made: ") + std::strerror(errno));
  std::vector<char*> argv;
  for (const std::string& word : command.argv) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);

  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(command.limit));
  pid_t child = 0;
  int error = 0;
  {
    const Setup setup(pipe[1], command.folder);
    error =
        ::posix_spawnp(&child, argv[0], &setup.actions, &setup.attributes, argv.data(), environ);
  }
  ::close(pipe[1]);
  ProcessResult result;
  if (error != 0) {
    ::close(pipe[0]);
    if (error != ENOENT && error != EACCES)
      throw SystemError("`" + command.argv[0] + "` cannot be started: " + std::strerror(error));
    result.end = ProcessResult::End::not_found;
    return result;
  }
  bool in_time = drain(pipe[0], end, result.output, error);
  ::close(pipe[0]);
  const int status = wait_for(child, end, in_time);
  if (error != 0)
    throw SystemError("the output of `" + command.argv[0] +
                      "` cannot be read: " + std::strerror(error));
  if (!in_time) {
    result.end = ProcessResult::End::timed_out;
  } else if (WIFSIGNALED(status)) {
    result.end = ProcessResult::End::killed;
    result.code = WTERMSIG(status);
  } else {
    result.code = WEXITSTATUS(status);
  }
  return result;
}

}  // namespace palpate::plot
