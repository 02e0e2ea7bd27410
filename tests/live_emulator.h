// The emulator as another program: started with its arguments, ended with the object.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "temporary_folder.h"

namespace palpate::test {

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class LiveEmulator {
 public:
  explicit LiveEmulator(std::vector<std::string> arguments) {
    int pipe[2] = {-1, -1};
    EXPECT_EQ(::pipe2(pipe, O_CLOEXEC), 0);
    arguments.insert(arguments.begin(), PALPATE_EMULATOR);
    // None outlives a test that was killed.
    arguments.insert(arguments.end(), {"--for", "60 s"});
    std::vector<char*> argv;
    for (std::string& word : arguments) argv.push_back(word.data());
    argv.push_back(nullptr);
    child_ = ::fork();
    if (child_ == 0) {
      ::dup2(pipe[1], 1);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    ::close(pipe[1]);
    out_ = ::fdopen(pipe[0], "r");
    hello_ = line();
  }
  ~LiveEmulator() {
    end();
    std::fclose(out_);
  }
  LiveEmulator(const LiveEmulator&) = delete;
  LiveEmulator& operator=(const LiveEmulator&) = delete;

  // A port's path for the stand, a number for the arm.
  [[nodiscard]] std::string port() const {
    const auto& port = hello_.at("port");
    return port.is_string() ? port.get<std::string>() : port.dump();
  }
  // Of the arm: the text that names it, and its events, to palpate.
  [[nodiscard]] std::string arm_link() const {
    return "inverse3:127.0.0.1:" + port() + ":" + hello_.at("events_port").dump();
  }
  void send(int signal) const { ::kill(child_, signal); }
  // Ends it and gives its summary; an empty object where it was killed.
  nlohmann::json end() {
    if (child_ <= 0) return summary_;
    ::kill(child_, SIGCONT);
    ::kill(child_, SIGTERM);
    summary_ = line();
    ::waitpid(child_, nullptr, 0);
    child_ = -1;
    return summary_;
  }

 private:
  nlohmann::json line() {
    std::string text;
    for (int c = std::fgetc(out_); c != EOF && c != '\n'; c = std::fgetc(out_))
      text += static_cast<char>(c);
    const auto parsed = nlohmann::json::parse(text, nullptr, false);
    return parsed.is_discarded() ? nlohmann::json::object() : parsed;
  }

  pid_t child_ = -1;
  std::FILE* out_ = nullptr;
  nlohmann::json hello_;
  nlohmann::json summary_;
};

// A file of a test's own, removed with the object.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& content) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string text() const {
    std::ifstream stream(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

 private:
  TemporaryFolder folder_;
  std::string path_ = (folder_ / "file").string();
};

}  // namespace palpate::test
