// `palpate compare`: compares two files or two folders.
#include <array>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "cli/checks.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "page/page.h"
#include "record/csv.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

std::string state_text(const compare::ColumnComparison& column) {
  using State = compare::ColumnComparison::State;
  switch (column.state) {
    case State::ignored: return "ignored";
    case State::missing: return "missing";
    case State::extra: return "extra";
    case State::compared: break;
  }
  return column.equal() ? "agrees" : "differs in " + std::to_string(column.differing) + " rows";
}

// One row per column of a file, with its worst row.
page::Markup table_of(const std::string& file, const compare::Comparison& comparison) {
  record::Table table{{"column", "verdict", "worst row", "got", "wanted", "relative", "allowed"},
                      {}};
  for (const compare::ColumnComparison& column : comparison.columns) {
    std::vector<record::Cell> row(table.columns.size());
    row[0] = column.name;
    row[1] = state_text(column);
    if (column.worst) {
      row[2] = static_cast<double>(column.worst->row);
      row[3] = column.worst->got;
      row[4] = column.worst->want;
      row[5] = column.worst->relative;
      row[6] = column.worst->allowed;
    }
    table.rows.push_back(row);
  }
  return page::element("h3", file) + page::table(file, table);
}

void write_page(const Compare& command, const compare::FolderComparison& comparison) {
  const std::string got = fs::path(command.got).filename().string();
  const std::string want = fs::path(command.want).filename().string();
  page::Page page(got + " compared with " + want, "comparison");
  page::Markup tables;
  std::size_t differing = 0;
  for (const compare::FileComparison& file : comparison.files) {
    if (!file.equal()) ++differing;
    if (file.state == compare::FileComparison::State::compared)
      tables += table_of(file.file, file.comparison);
    else
      tables += page::element("p", file.file + " is in one of the two folders only.");
  }
  page.answer({comparison.equal()
                   ? "Everything agrees within the tolerances."
                   : std::to_string(differing) + " of " + std::to_string(comparison.files.size()) +
                         " files differ by more than the tolerances."});
  page.section("Columns", tables);
  make_folders(std::filesystem::path(command.report).parent_path().string());
  write_atomically(command.report, page.html());
}

compare::Tables one_table(const std::string& name, const std::string& path) {
  return {{name, [path] { return record::read_csv(path); }}};
}

}  // namespace

int perform(const Compare& command, const Arguments&, const Talk& talk) {
  compare::Tolerances tolerances;
  if (!command.tolerances.empty()) tolerances = compare::read_tolerances(command.tolerances);
  for (const std::string& path : {command.got, command.want})
    if (!fs::exists(path))
      throw InputError({path, 0, 0}, "is not there; give a CSV file or a result folder");
  const bool folders = fs::is_directory(command.want);
  if (folders != fs::is_directory(command.got))
    throw InputError(
        {command.got, 0, 0},
        "and " + command.want + " are a file and a folder; give two files or two folders");
  const std::string name = fs::path(command.want).filename().string();
  const std::array checks{compare::Check{
      .name = command.got,
      .want = command.want,
      .one_file = !folders,
      .comparison = folders ? compare::compare_folders(command.got, command.want, tolerances)
                            : compare::compare_tables(one_table(name, command.got),
                                                      one_table(name, command.want), tolerances)}};
  report_checks(checks, command.options, talk);
  if (!command.report.empty()) write_page(command, checks.front().comparison);
  return checks.front().equal() ? exit_good : exit_different;
}

}  // namespace palpate::cli
