// Comparison of two tables, which columns differ and in which row most, and of two result folders,
// every CSV file with the file of the same name; and comparisons as forges and build servers show
// them, in JUnit XML and annotations.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "record/table.h"

namespace palpate::compare {

// Numbers are equal where |got - want| <= abs + rel |want|; `abs` is in the column's own unit.
struct Tolerance {
  double rel = 1e-9;
  double abs = 0.0;
  bool ignore = false;
  std::string reason = {};
};

// With a tube, rows are not compared one by one: a value is equal if it lies, within its tolerance,
// between the minimum and the maximum of the other result over x - width to x + width.
struct Tube {
  std::string x = {};  // name of the column of x
  double width = 0.0;  // in the unit of that column
};

struct Tolerances {
  Tolerance standard;
  std::map<std::string, Tolerance> columns = {};
  std::optional<Tube> tube = {};
  // Where the file names a column, that of the tube included.
  std::vector<std::pair<std::string, Place>> places = {};

  [[nodiscard]] const Tolerance& of(const std::string& column) const;
};

// Reads TOML with `[default]` and `[column.NAME]` (keys `rel`, `abs`, `ignore`, `reason`; a column
// takes missing keys, except `reason`, from the default) and `[tube]` (keys `x`, `width`). Throws
// InputError with all problems at file:line:column.
[[nodiscard]] Tolerances parse_tolerances(std::string_view text, const std::string& file);
[[nodiscard]] Tolerances read_tolerances(const std::string& path);

// The row with the largest difference relative to the tolerance.
struct WorstRow {
  std::size_t row = 0;         // in GOT, counted from 1 below the header
  std::string case_name = {};  // the row's word in the column `case`; empty without one
  std::string x_name = {};     // the column that tells where the row is; empty if there is none
  record::Cell x = {};
  record::Cell got = {};
  record::Cell want = {};
  double relative =
      0.0;               // |got - want| / |want|; infinite unless both are finite and want is not 0
  double allowed = 0.0;  // tolerance, abs + rel |want|
};

struct ColumnComparison {
  enum class State { compared, ignored, missing, extra };

  std::string name = {};
  State state = State::compared;
  std::size_t differing = 0;           // rows beyond the tolerance
  std::optional<WorstRow> worst = {};  // empty if no row differs at all

  [[nodiscard]] bool equal() const;
};

struct Comparison {
  std::vector<ColumnComparison> columns = {};  // in WANT's order, then those only in GOT
  std::size_t rows_got = 0;
  std::size_t rows_want = 0;
  bool rows_compared = true;  // row by row; false in a tube

  [[nodiscard]] bool rows_equal() const;  // as many rows as wanted, or compared in a tube
  [[nodiscard]] bool equal() const;
};

// Compares row by row, with columns identified by name, in any order. NaN equals NaN, an infinity
// one of the same sign, a missing value a missing one; words must be identical. Missing and extra
// rows and columns are differences, unless the column is ignored. With a tube, see compare.h.
[[nodiscard]] Comparison compare(const record::Table& got, const record::Table& want,
                                 const Tolerances& tolerances);

// What differs in a column, where most, and both values.
[[nodiscard]] std::string verdict_text(const ColumnComparison& column);

// The order in which columns are told: first what a curve is drawn of, `force_N`, `strain` and
// `stress_kPa` (0), then its peak and other results of a case (1), then other columns of curves
// (2), then the rest (3), such as the number of nodes or a balance.
[[nodiscard]] int rank_of(const ColumnComparison& column);
inline constexpr int last_result_rank = 2;

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

// One thing that was compared: a column, the number of rows, or a whole file.
struct Item {
  enum class State { good, skipped, failed, error };  // `skipped`: ignored; `error`: not compared

  State state = State::good;
  std::string file = {};                     // relative to the folder
  std::string name = {};                     // of the column; else `rows` or `file`
  std::string text = {};                     // what is wrong
  int rank = 2;                              // as rank_of()
  const ColumnComparison* column = nullptr;  // of the comparison; null for rows and files

  // `force_indentation.csv, force_N: DIFFERS in ...`; without a file the text alone.
  [[nodiscard]] std::string sentence() const;
};
// All of them, in the order of files and columns; and those that differ, by their rank.
[[nodiscard]] std::vector<Item> items_of(const FolderComparison& comparison);
[[nodiscard]] std::vector<Item> differences(const FolderComparison& comparison);

// ` over the first 201 of 401 rows`: what is compared of a file whose tables are of different
// length in GOT and WANT; else empty.
[[nodiscard]] std::string common_rows_text(const FolderComparison& comparison,
                                           const std::string& file);
// The comparison in a line: `equal: 35 columns of 2 files`, or `DIFFERS in 17 of 35 columns of 2
// files, in force_N by 0.5 %`, the column that comes first by its rank.
[[nodiscard]] std::string headline(const FolderComparison& comparison);
// One line per difference, by rank, at most eight, and how many more there are.
[[nodiscard]] std::string difference_lines(const FolderComparison& comparison);

// The same as a table, one row per column: file, column, state (same, equal, differs, ignored,
// missing, extra), rows_differing, and row, case, x_name, x, got, want, relative and allowed of the
// worst row. A file in one folder only, and different numbers of rows, have a row without a column.
[[nodiscard]] record::Table comparison_table(const FolderComparison& comparison);

// The comparison of one result with what is wanted, or the reason why there is none.
struct Check {
  std::string name;                  // of the result or the scenario
  std::string want;                  // path of the wanted folder or file
  bool one_file = false;             // whether it is a file
  FolderComparison comparison = {};  // empty if `error` is not
  std::string error = {};            // a sentence

  [[nodiscard]] bool equal() const { return error.empty() && comparison.equal(); }
};

// JUnit XML: a test suite per check and a test case per column, whose `classname` is the name of
// the check and the file. A column that differs has a failure, whose message names the file, the
// case, the row and both values; an ignored column is skipped; a check with an error has one test
// case, with that error. Contains no time, so that the same comparison gives the same bytes.
[[nodiscard]] std::string junit_text(std::span<const Check> checks);

// One line per check that is not equal, in the form of GitHub's workflow commands, `::error
// file=...`: its first difference by rank_of(), with the number of further ones. The file is the
// wanted one, the line that of the worst row. Each line ends with `\n`.
[[nodiscard]] std::string github_annotations(std::span<const Check> checks);

}  // namespace palpate::compare
