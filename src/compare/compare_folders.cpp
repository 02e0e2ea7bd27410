// Compares two folders file by file.
#include "compare/compare_folders.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "record/csv.h"

namespace palpate::compare {
namespace {

using record::Cell;

// Refuses tolerances for columns that no table has: a misspelt name would allow nothing.
void refuse_unknown_columns(const Tolerances& tolerances, const std::set<std::string>& columns) {
  const std::vector<std::string> known(columns.begin(), columns.end());
  std::vector<Problem> problems;
  const auto ask = [&](const std::string& name, const Place& place) {
    if (columns.contains(name)) return;
    const auto near = nearest(name, known);
    problems.push_back({place, "`" + name + "` is no column of these files; " +
                                   (near ? "did you mean `" + *near + "`?"
                                         : "take it out, or name one of " + joined(known, ", "))});
  };
  for (const auto& [name, place] : tolerances.places) ask(name, place);
  if (!problems.empty()) throw InputError(problems);
}

FileComparison compare_file(const std::string& file, const Tables& got, const Tables& want,
                            const Tolerances& tolerances, std::set<std::string>& columns) {
  FileComparison result{.file = file};
  const auto ours = got.find(file);
  const auto theirs = want.find(file);
  record::Table left, right;
  if (ours != got.end()) left = ours->second();
  if (theirs != want.end()) right = theirs->second();
  columns.insert(left.columns.begin(), left.columns.end());
  columns.insert(right.columns.begin(), right.columns.end());
  if (ours == got.end())
    result.state = FileComparison::State::missing;
  else if (theirs == want.end())
    result.state = FileComparison::State::extra;
  else
    result.comparison = compare(left, right, tolerances);
  return result;
}

const char* state_word(const ColumnComparison& column) {
  switch (column.state) {
    case ColumnComparison::State::ignored: return "ignored";
    case ColumnComparison::State::missing: return "missing";
    case ColumnComparison::State::extra: return "extra";
    case ColumnComparison::State::compared: break;
  }
  return !column.worst ? "same" : column.equal() ? "equal" : "differs";
}

std::vector<Cell> row_of(const std::string& file, const ColumnComparison& column) {
  std::vector<Cell> row{file, column.name, std::string(state_word(column)),
                        static_cast<double>(column.differing)};
  row.resize(12);
  if (!column.worst) return row;
  const WorstRow& worst = *column.worst;
  row[4] = static_cast<double>(worst.row);
  if (!worst.case_name.empty()) row[5] = worst.case_name;
  if (!worst.x_name.empty()) row[6] = worst.x_name;
  row[7] = worst.x;
  row[8] = worst.got;
  row[9] = worst.want;
  if (std::isfinite(worst.relative)) row[10] = worst.relative;
  row[11] = worst.allowed;
  return row;
}

std::vector<Cell> row_without_column(const std::string& file, const char* state) {
  std::vector<Cell> row{file, {}, std::string(state)};
  row.resize(12);
  return row;
}

}  // namespace

bool FolderComparison::equal() const {
  return std::all_of(files.begin(), files.end(), [](const auto& each) { return each.equal(); });
}

Tables tables_below(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  Tables tables;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
    if (entry->is_regular_file(error) && entry->path().extension() == ".csv")
      tables[entry->path().lexically_relative(folder).generic_string()] =
          [path = entry->path().string()] { return record::read_csv(path); };
  if (error)
    throw InputError({folder, 0, 0},
                     "cannot be read: " + error.message() + "; give a folder of results");
  return tables;
}

FolderComparison compare_tables(const Tables& got, const Tables& want,
                                const Tolerances& tolerances) {
  std::set<std::string> names;
  for (const auto& [name, table] : got) names.insert(name);
  for (const auto& [name, table] : want) names.insert(name);
  FolderComparison folders;
  std::set<std::string> columns;
  for (const std::string& name : names)
    folders.files.push_back(compare_file(name, got, want, tolerances, columns));
  refuse_unknown_columns(tolerances, columns);
  return folders;
}

FolderComparison compare_folders(const std::string& got, const std::string& want,
                                 const Tolerances& tolerances) {
  const Tables wanted = tables_below(want);
  if (wanted.empty())
    throw InputError({want, 0, 0}, "holds no CSV file to compare with; give a folder of results");
  return compare_tables(tables_below(got), wanted, tolerances);
}

std::string verdict_text(FileComparison::State state) {
  switch (state) {
    case FileComparison::State::missing: return "DIFFERS, the file is missing";
    case FileComparison::State::extra: return "DIFFERS, the file is not wanted";
    case FileComparison::State::compared: break;
  }
  return "compared";
}

std::string comparison_text(const FolderComparison& comparison) {
  std::string text;
  for (const FileComparison& file : comparison.files) {
    if (file.equal()) continue;
    if (file.state != FileComparison::State::compared) {
      text += one_line(file.file) + ": " + verdict_text(file.state) + "\n";
      continue;
    }
    text += one_line(file.file) + ": DIFFERS\n" + comparison_text(file.comparison);
  }
  return text;
}

std::string equal_text(const FolderComparison& comparison) {
  std::size_t columns = 0;
  for (const FileComparison& file : comparison.files)
    for (const ColumnComparison& column : file.comparison.columns)
      if (column.equal()) ++columns;
  const std::size_t files = comparison.files.size();
  return "equal: " + std::to_string(columns) + (columns == 1 ? " column" : " columns") +
         (files == 1 ? "" : " of " + std::to_string(files) + " files") + "\n";
}

record::Table comparison_table(const FolderComparison& comparison) {
  record::Table table{{"file", "column", "state", "rows_differing", "row", "case", "x_name", "x",
                       "got", "want", "relative", "allowed"},
                      {}};
  for (const FileComparison& file : comparison.files) {
    if (file.state != FileComparison::State::compared) {
      table.rows.push_back(row_without_column(
          file.file, file.state == FileComparison::State::missing ? "missing" : "extra"));
      continue;
    }
    if (!file.comparison.rows_equal()) {
      std::vector<Cell> row = row_without_column(file.file, "rows_differ");
      row[8] = static_cast<double>(file.comparison.rows_got);
      row[9] = static_cast<double>(file.comparison.rows_want);
      table.rows.push_back(std::move(row));
    }
    for (const ColumnComparison& column : file.comparison.columns)
      table.rows.push_back(row_of(file.file, column));
  }
  return table;
}

}  // namespace palpate::compare
