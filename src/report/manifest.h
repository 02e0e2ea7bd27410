// run.json: the program, machine, inputs, outputs and times of a result.
#pragma once

#include <string>
#include <vector>

#include "base/files.h"

namespace palpate::report {

struct Build {
  std::string version = {};
  std::string type = {};
  std::string compiler = {};
  std::string flags = {};
};
[[nodiscard]] Build this_build();

// The time in UTC as `2026-01-31T12:00:00Z`; SOURCE_DATE_EPOCH, if set, replaces the clock.
[[nodiscard]] std::string utc_now();

// A time in seconds since 1970-01-01 in the same format.
[[nodiscard]] std::string utc_text(long long seconds);

// The command that made a result.
struct Origin {
  std::vector<std::string> argv;
  std::string started;  // UTC
};

struct CaseEntry {
  std::string name = {};
  std::string why = {};  // reason of a failure; empty: finished
  double seconds = 0.0;
};

struct Manifest {
  Origin origin = {};
  std::vector<HashedFile> inputs = {};
  std::vector<HashedFile> outputs = {};
  std::vector<CaseEntry> cases = {};
  bool complete = false;
};

// The manifest as JSON with keys in a fixed order, indented by two spaces, with `\n` at the end:
// besides what it holds, this build, its libraries and this machine.
[[nodiscard]] std::string manifest_text(const Manifest& manifest);

}  // namespace palpate::report
