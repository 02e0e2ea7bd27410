// run.json: what made a result, from what, and when.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "report/machine.h"
#include "scenario/family.h"

namespace palpate::report {

// What run.json says of how a result was made, beyond what the result itself knows.
struct Origin {
  std::vector<std::string> argv;
  std::string started;  // UTC
};

struct HashedFile {
  std::string path = {};
  std::string sha256 = {};
};

struct CaseEntry {
  enum class State { finished, failed };

  std::string name = {};
  State state = State::finished;
  std::string why = {};                        // where failed
  std::map<std::string, double> timings = {};  // s, by stage
};

struct Manifest {
  Build build = {};
  std::map<std::string, std::string> libraries = {};  // name to version
  Machine machine = {};
  std::vector<std::string> argv = {};
  std::string started = {};  // UTC, as utc_now gives it
  std::string ended = {};
  std::vector<HashedFile> inputs = {};
  std::vector<HashedFile> outputs = {};
  std::vector<CaseEntry> cases = {};
  bool complete = false;
};

// The hash of a file as it stands below `folder` (empty: here). Throws InputError as read_text.
[[nodiscard]] HashedFile hashed_file(const std::string& path, const std::string& folder = {});

// Eigen, Ceres, OpenEXR, nlohmann json and TetGen, whose version its own room knows.
[[nodiscard]] std::map<std::string, std::string> library_versions(const std::string& tetgen);

// What every manifest begins with: build, libraries, machine, what was called, the inputs' hashes.
[[nodiscard]] Manifest begin_manifest(const Origin& origin,
                                      const std::vector<scenario::InputFile>& inputs);

// The manifest as JSON, two spaces a level, `\n` at the end; keys in a fixed order.
[[nodiscard]] std::string manifest_text(const Manifest& manifest);

}  // namespace palpate::report
