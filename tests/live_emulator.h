// The emulator as another program: started with its arguments, ended with the object.
#pragma once

#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "emulator_program.h"
#include "temporary_folder.h"

namespace palpate::test {

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// How long a link's sample is waited for that must come, s.
inline constexpr double wire_patience = 20.0;

class LiveEmulator {
 public:
  explicit LiveEmulator(std::vector<std::string> arguments)
      : program_(std::move(arguments)), hello_(program_.line()) {}

  // A port's path for the stand, a number for the arm.
  [[nodiscard]] std::string port() const {
    const auto& port = hello_.at("port");
    return port.is_string() ? port.get<std::string>() : port.dump();
  }
  // Of the arm: the text that names it, and its events, to palpate.
  [[nodiscard]] std::string arm_link() const {
    return "inverse3:127.0.0.1:" + port() + ":" + hello_.at("events_port").dump();
  }
  void send(int signal) const { program_.send(signal); }
  // Ends it and gives its summary; an empty object where it was killed.
  nlohmann::json end() {
    if (!program_.runs()) return summary_;
    send(SIGCONT);
    send(SIGTERM);
    summary_ = program_.line();
    if (summary_.is_discarded()) summary_ = nlohmann::json::object();
    program_.wait();
    return summary_;
  }

 private:
  emulator::test::Program program_;
  nlohmann::json hello_;
  nlohmann::json summary_;
};

// A file of a test's own, removed with the object.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& content) : path_(folder_.file("file", content)) {}
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string text() const { return read_file(path_); }

 private:
  TemporaryFolder folder_;
  std::string path_;
};

}  // namespace palpate::test
