// run.json: the program, machine, inputs, outputs and times of a result.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/files.h"
#include "scenario/family.h"

namespace palpate::report {

struct Machine {
  std::string cpu = {};  // model name in /proc/cpuinfo
  int cores = 0;         // number that this process may use; 0 if unknown
  std::string kernel = {};
};
[[nodiscard]] Machine this_machine();

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
  enum class State { finished, failed };

  std::string name = {};
  State state = State::finished;
  std::string why = {};                        // reason of a failure
  std::map<std::string, double> timings = {};  // s, by stage
};

struct Manifest {
  Build build = {};
  std::map<std::string, std::string> libraries = {};  // versions by name
  Machine machine = {};
  std::vector<std::string> argv = {};
  std::string started = {};  // UTC, in the format of utc_now
  std::string ended = {};
  std::vector<HashedFile> inputs = {};
  std::vector<HashedFile> outputs = {};
  std::vector<CaseEntry> cases = {};
  bool complete = false;
};

// Versions of Eigen, Ceres, OpenEXR, nlohmann json and TetGen; that of TetGen is given.
[[nodiscard]] std::map<std::string, std::string> library_versions(const std::string& tetgen);

// Returns a manifest with build, libraries, machine, command, times and the hashes of the inputs.
[[nodiscard]] Manifest begin_manifest(const Origin& origin,
                                      const std::vector<scenario::InputFile>& inputs);

// The manifest as JSON with keys in a fixed order, indented by two spaces, with `\n` at the end.
[[nodiscard]] std::string manifest_text(const Manifest& manifest);

}  // namespace palpate::report
