// Two result folders side by side: every CSV file of one against its namesake.
#pragma once

#include <string>
#include <vector>

#include "report/compare.h"

namespace palpate::report {

struct FileComparison {
  enum class State { compared, missing, extra };

  std::string file;  // relative to both folders
  State state = State::compared;
  Comparison comparison = {};  // where compared

  [[nodiscard]] bool equal() const { return state == State::compared && comparison.equal(); }
};

struct FolderComparison {
  std::vector<FileComparison> files;  // by name

  [[nodiscard]] bool equal() const;
};

// Compares every .csv below `want` with the file of that name below `got`; files that only one
// side has are differences. Throws InputError where a folder cannot be read, `want` holds no CSV
// file, or a CSV file cannot be parsed.
[[nodiscard]] FolderComparison compare_folders(const std::string& got, const std::string& want,
                                               const Tolerances& tolerances);

// The files' comparisons one after the other, each under its name.
[[nodiscard]] std::string comparison_text(const FolderComparison& comparison);

}  // namespace palpate::report
