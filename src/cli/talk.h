// Talk to people on stderr, events to programs on stdout.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/arguments.h"

namespace palpate::cli {

class Talk {
 public:
  explicit Talk(const Manner& manner);

  void say(const std::string& sentence) const;   // stderr, unless quiet
  void warn(const std::string& sentence) const;  // stderr, unless quiet
  static void error(const std::string& sentence);

  // A line that stands until the next one, on terminals only; empty wipes it.
  void progress(const std::string& line) const;

  // One JSON object on stdout, where --json was given: {"event": event, ...}.
  void event(const std::string& name,
             const std::vector<std::pair<std::string, std::string>>& details) const;

  // Whether progress() shows anything.
  [[nodiscard]] bool shows_progress() const { return terminal_ && !manner_.quiet && !manner_.json; }
  [[nodiscard]] bool json() const { return manner_.json; }

 private:
  Manner manner_;
  bool terminal_ = false;
};

// Data for stdout. Throws SystemError where it cannot be written.
void print(const std::string& data);

}  // namespace palpate::cli
