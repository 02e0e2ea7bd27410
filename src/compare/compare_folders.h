// Comparison of two result folders: every CSV file with the file of the same name.
#pragma once

#include <functional>
#include <map>
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

// Tables by the names of their files, each read when it is compared.
using Tables = std::map<std::string, std::function<record::Table()>>;

// Every .csv file below a folder, at any depth, by its path relative to it. Throws InputError if
// the folder cannot be read.
[[nodiscard]] Tables tables_below(const std::string& folder);

// Compares every table of `want` with the one of the same name in `got`; a table in only one of
// them is a difference. Throws InputError if a file cannot be parsed, or if the tolerances name a
// column that no table has.
[[nodiscard]] FolderComparison compare_tables(const Tables& got, const Tables& want,
                                              const Tolerances& tolerances);

// Compares the CSV files of two folders as compare_tables() does. Throws InputError also if a
// folder cannot be read or `want` contains no CSV file.
[[nodiscard]] FolderComparison compare_folders(const std::string& got, const std::string& want,
                                               const Tolerances& tolerances);

// The differences of all files, each below the file's name.
[[nodiscard]] std::string comparison_text(const FolderComparison& comparison);
// How much is equal: `equal: 2 columns`, of several files with their number.
[[nodiscard]] std::string equal_text(const FolderComparison& comparison);
// What is said of a file that is in one of the folders only.
[[nodiscard]] std::string verdict_text(FileComparison::State state);

// The same as a table, one row per column: file, column, state (same, equal, differs, ignored,
// missing, extra), rows_differing, and row, case, x_name, x, got, want, relative and allowed of the
// worst row. A file in one folder only, and different numbers of rows, have a row without a column.
[[nodiscard]] record::Table comparison_table(const FolderComparison& comparison);

}  // namespace palpate::compare
