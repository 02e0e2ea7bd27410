// The emulator's program, started and listened to; and a client's end of its port.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "patience.h"
#include "temporary_folder.h"

#ifndef PALPATE_EMULATOR
#error "this test starts a program now: configure again, so that it gets the label `cli`"
#endif

namespace emulator::test {

namespace fs = std::filesystem;
using nlohmann::json;
using palpate::test::patience;
using palpate::test::read_file;
using palpate::test::seen;
using palpate::test::TemporaryFolder;

// Adds what a descriptor has to give, once there is something; false at its end. That nothing
// comes at all fails the test.
inline bool read_more(int descriptor, std::string& text) {
  pollfd ready{descriptor, POLLIN, 0};
  if (::poll(&ready, 1, static_cast<int>(patience / std::chrono::milliseconds(1))) <= 0) {
    ADD_FAILURE() << "nothing comes after `" << text << "`";
    return false;
  }
  std::array<char, 512> chunk{};
  const ssize_t got = ::read(descriptor, chunk.data(), chunk.size());
  if (got > 0) text.append(chunk.data(), static_cast<std::size_t>(got));
  return got > 0;
}

// A running emulator; ended with it.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), PALPATE_EMULATOR);
    launch(arguments);
  }
  ~Program() {
    if (child_ > 0) (void)end();
    for (const int descriptor : {out_, err_})
      if (descriptor >= 0) ::close(descriptor);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  // The next line of its stdout as JSON.
  json line() { return json::parse(next_line(out_, out_text_), nullptr, false); }
  std::string error_line() { return next_line(err_, err_text_); }

  // SIGTERM; the exit code.
  int end() {
    send(SIGTERM);
    return wait();
  }
  void send(int signal) const {
    if (child_ > 0) ::kill(child_, signal);  // -1 would be every process
  }
  int wait() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  [[nodiscard]] bool runs() const { return child_ > 0; }

 private:
  void launch(std::vector<std::string>& arguments) {
    std::array<int, 2> out{};
    std::array<int, 2> err{};
    if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0) std::abort();
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    child_ = ::fork();
    if (child_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // should this test die
      ::dup2(out[1], STDOUT_FILENO);
      ::dup2(err[1], STDERR_FILENO);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    ::close(out[1]);
    ::close(err[1]);
    out_ = out[0];
    err_ = err[0];
  }

  static std::string next_line(int descriptor, std::string& text) {
    std::size_t newline = text.find('\n');
    for (; newline == std::string::npos; newline = text.find('\n'))
      if (!read_more(descriptor, text)) return {};
    std::string line = text.substr(0, newline);
    text.erase(0, newline + 1);
    return line;
  }

  pid_t child_ = -1;
  int out_ = -1;
  int err_ = -1;
  std::string out_text_ = {};
  std::string err_text_ = {};
};

// A client's end of a serial port.
class Port {
 public:
  explicit Port(const std::string& path, speed_t rate = B115200)
      : descriptor_(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    EXPECT_GE(descriptor_, 0) << path;
    set_rate(rate);
  }
  ~Port() { ::close(descriptor_); }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  void say(const std::string& bytes) const {
    EXPECT_EQ(::write(descriptor_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  void set_rate(speed_t rate) const {
    termios line{};
    ::tcgetattr(descriptor_, &line);
    ::cfmakeraw(&line);
    ::cfsetspeed(&line, rate);
    ::tcsetattr(descriptor_, TCSANOW, &line);
  }
  // As many lines; fewer where the port is gone.
  [[nodiscard]] std::string lines(int count) const {
    std::string text;
    while (std::count(text.begin(), text.end(), '\n') < count && read_more(descriptor_, text)) {
    }
    return text;
  }
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace emulator::test
