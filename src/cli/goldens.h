// Kept results of scenarios: where they are, and how they are computed.
#pragma once

#include <string>
#include <vector>

#include "compare/compare_folders.h"
#include "report/results.h"

namespace palpate::cli {

// A scenario with its kept results. Those of NAME.toml are in NAME.expected/ beside it, with their
// tolerances in NAME.tolerances.toml; `scenario.toml`, which is called after its folder, has them
// in expected/ and tolerances.toml.
struct KeptResult {
  std::string scenario;    // path
  std::string expected;    // folder
  std::string tolerances;  // path of a file that need not exist

  [[nodiscard]] static KeptResult of(const std::string& scenario);
  [[nodiscard]] bool is_kept() const;
};

// The kept results of scenarios, and of all scenarios at or below folders, sorted by path. Throws
// InputError for a path that does not exist, a scenario without a kept result, and if there are
// none at all.
[[nodiscard]] std::vector<KeptResult> kept_results(const std::vector<std::string>& subjects);

// Runs a scenario and returns its CSV files. Throws InputError and MeshError.
[[nodiscard]] report::CsvFiles compute(const std::string& scenario, int workers);

// Writes the files into the folder, and removes CSV files there that are no longer written. Throws
// SystemError.
void keep(const report::CsvFiles& files, const std::string& folder);

}  // namespace palpate::cli
