// Comparison of two result folders: every CSV file with the file of the same name.
#pragma once

#include <string>
#include <vector>

#include "compare/compare.h"

namespace palpate::compare {

struct FileComparison {
  enum class State { compared, missing, extra };

  std::string file;  // relative to both folders
  State state = State::compared;
  Comparison comparison = {};  // only if compared

  [[nodiscard]] bool equal() const { return state == State::compared && comparison.equal(); }
};

struct FolderComparison {
  std::vector<FileComparison> files;  // by name

  [[nodiscard]] bool equal() const;
};

// Compares every .csv file below `want`, at any depth, with the file of the same relative path
// below `got`; a file in only one of them is a difference. Throws InputError if a folder cannot be
// read, `want` contains no CSV file, or a CSV file cannot be parsed.
[[nodiscard]] FolderComparison compare_folders(const std::string& got, const std::string& want,
                                               const Tolerances& tolerances);

// The comparisons of all files, each below the file's name.
[[nodiscard]] std::string comparison_text(const FolderComparison& comparison);

}  // namespace palpate::compare
