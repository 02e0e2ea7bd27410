// The emulator's program, started and listened to; and a client's end of its port.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "temporary_folder.h"

namespace emulator::test {

namespace fs = std::filesystem;

inline int milliseconds_left(std::chrono::steady_clock::time_point end) {
  const auto left = end - std::chrono::steady_clock::now();
  return std::max(0, static_cast<int>(left / std::chrono::milliseconds(1)));
}

// Generous: a machine that is busy must not fail a test that is about bytes.
constexpr std::chrono::seconds patience{20};

class TemporaryFolder {
 public:
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return *this / name;
  }
  [[nodiscard]] std::string operator/(const std::string& name) const {
    return (folder_ / name).string();
  }

 private:
  palpate::test::TemporaryFolder folder_;
};

inline std::string read_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// A running emulator; ended with it.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), PALPATE_EMULATOR);
    arguments.insert(arguments.end(), {"--for", "60 s"});  // should this test die
    launch(arguments);
  }
  // With exactly these arguments.
  static Program plain(std::vector<std::string> arguments) {
    Program program;
    arguments.insert(arguments.begin(), PALPATE_EMULATOR);
    program.launch(arguments);
    return program;
  }
  ~Program() {
    if (child_ > 0) (void)end();
    for (const int descriptor : {out_, err_})
      if (descriptor >= 0) ::close(descriptor);
  }
  Program(Program&& other) noexcept
      : child_(std::exchange(other.child_, -1)),
        out_(std::exchange(other.out_, -1)),
        err_(std::exchange(other.err_, -1)) {}
  Program& operator=(Program&&) = delete;

  // The next line of its stdout as JSON.
  nlohmann::json line() {
    return nlohmann::json::parse(next_line(out_, out_text_), nullptr, false);
  }
  std::string error_line() { return next_line(err_, err_text_); }

  // SIGTERM; the exit code.
  int end() {
    ::kill(child_, SIGTERM);
    return wait();
  }
  int wait() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  [[nodiscard]] pid_t pid() const { return child_; }

 private:
  Program() = default;

  void launch(std::vector<std::string>& arguments) {
    std::array<int, 2> out{};
    std::array<int, 2> err{};
    if (::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0) std::abort();
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    child_ = ::fork();
    if (child_ == 0) {
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
    const auto end = std::chrono::steady_clock::now() + patience;
    for (;;) {
      const auto newline = text.find('\n');
      if (newline != std::string::npos) {
        std::string line = text.substr(0, newline);
        text.erase(0, newline + 1);
        return line;
      }
      pollfd ready{descriptor, POLLIN, 0};
      if (::poll(&ready, 1, milliseconds_left(end)) <= 0) return {};
      std::array<char, 512> chunk{};
      const ssize_t got = ::read(descriptor, chunk.data(), chunk.size());
      if (got <= 0) return {};
      text.append(chunk.data(), static_cast<std::size_t>(got));
    }
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
    termios line{};
    ::tcgetattr(descriptor_, &line);
    ::cfmakeraw(&line);
    ::cfsetspeed(&line, rate);
    ::tcsetattr(descriptor_, TCSANOW, &line);
  }
  ~Port() { ::close(descriptor_); }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  void say(const std::string& bytes) const {
    EXPECT_EQ(::write(descriptor_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  // As many lines; fewer where nothing comes for `time`.
  [[nodiscard]] std::string lines(int count, std::chrono::milliseconds time = patience) const {
    std::string text;
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::count(text.begin(), text.end(), '\n') < count) {
      pollfd ready{descriptor_, POLLIN, 0};
      if (::poll(&ready, 1, milliseconds_left(end)) <= 0) break;
      std::array<char, 512> chunk{};
      const ssize_t got = ::read(descriptor_, chunk.data(), chunk.size());
      if (got <= 0) break;
      text.append(chunk.data(), static_cast<std::size_t>(got));
    }
    return text;
  }
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace emulator::test
