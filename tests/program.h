// The program itself, run in a temporary folder: its streams, its exit code, its files.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "patience.h"
#include "temporary_folder.h"

#ifndef PALPATE_PROGRAM
#error "this test starts a program now: configure again, so that it gets the label `cli`"
#endif

namespace palpate::test {

namespace fs = std::filesystem;

// The names in a folder, in order.
inline std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

struct Ended {
  int code = -1;   // exit code, where it exited
  int signal = 0;  // that ended it, else
  std::string out = {};
  std::string err = {};
};

struct Invocation {
  std::vector<std::string> arguments = {};
  fs::path folder = {};                                       // where it runs
  std::vector<std::pair<std::string, std::string>> set = {};  // environment
  std::vector<std::string> unset = {};
  std::function<void()> before = {};  // in the child, before exec
  std::string program = PALPATE_PROGRAM;
};

// A process that has been started; its streams go to files, so that no pipe can fill.
class Running {
 public:
  explicit Running(const Invocation& call) {
    std::vector<char*> argv{const_cast<char*>(call.program.c_str())};
    for (const std::string& word : call.arguments) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    // Here, for one that is killed at once may not get as far.
    for (const std::string& stream : {out_, err_}) write_file(stream, "");
    child_ = ::fork();
    if (child_ != 0) return;
    if (!call.folder.empty() && ::chdir(call.folder.c_str()) != 0) ::_exit(126);
    ::unsetenv("CI");  // tests of its effect set it
    for (const auto& [name, value] : call.set) ::setenv(name.c_str(), value.c_str(), 1);
    for (const std::string& name : call.unset) ::unsetenv(name.c_str());
    ::dup2(::open("/dev/null", O_RDONLY), 0);
    ::dup2(::open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 1);
    ::dup2(::open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 2);
    if (call.before) call.before();
    ::execvp(argv[0], argv.data());
    ::_exit(127);
  }
  ~Running() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
    }
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  [[nodiscard]] pid_t id() const { return child_; }
  void send(int signal) const {
    if (child_ > 0) ::kill(child_, signal);  // -1 would be every process
  }

  // Waits for something that the program does; false where it ends, or patience does, first.
  bool until(const std::function<bool()>& there) {
    bool ended = false;
    const auto there_or_ended = [&] {
      siginfo_t info{};
      ended = ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
              info.si_pid == child_;
      return there() || ended;
    };
    return seen(there_or_ended) && (!ended || there());
  }

  Ended wait() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    Ended ended;
    if (WIFEXITED(status)) ended.code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
    ended.out = read_file(out_);
    ended.err = read_file(err_);
    return ended;
  }

 private:
  TemporaryFolder streams_;
  std::string out_ = (streams_ / "stdout").string();
  std::string err_ = (streams_ / "stderr").string();
  pid_t child_ = -1;
};

inline Ended run_program(const Invocation& call) { return Running(call).wait(); }

// With the words of `more` behind the others.
inline Ended palpate(const fs::path& folder, std::vector<std::string> arguments,
                     const std::vector<std::string>& more = {}) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program({.arguments = std::move(arguments), .folder = folder});
}

inline bool says(const Ended& ended, const std::string& words) {
  return ended.err.find(words) != std::string::npos;
}

inline std::string project_file(const std::string& name) {
  return std::string(PALPATE_SOURCE_DIR) + "/" + name;
}

// A page with plain spaces, also between a number and its unit, where no line may end.
inline std::string read_page(const fs::path& page) {
  std::string html = read_file(page), plain;
  for (std::size_t at = 0, next = 0; at < html.size(); at = next + 2) {
    next = std::min(html.find("\u00a0", at), html.size());
    plain += html.substr(at, next - at) + (next < html.size() ? " " : "");
  }
  return plain;
}

// The number with which a page begins, and what stands beside it.
inline std::string headline_of(const fs::path& page) {
  const std::string html = read_page(page), begin = "<p class=\"big";
  const std::size_t from = html.find(begin);
  if (from == std::string::npos || html.find("<section") < from) return "";
  std::string words;
  bool tag = false;
  for (std::size_t at = from; at < html.find("</p>", from); ++at) {
    tag = html[at] == '<' || tag;
    if (!tag) words += html[at];
    if (html[at] == '>') tag = false;
  }
  return words;
}

}  // namespace palpate::test
