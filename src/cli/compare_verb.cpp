// `palpate compare`: compares two files or two folders.
#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "base/text.h"
#include "cli/checks.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "page/page.h"
#include "plot/gnuplot.h"
#include "record/csv.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

// The columns of a file that differ, or those that agree, each with its worst row.
page::Markup table_of(const compare::FileComparison& file, bool differing) {
  record::Table table{{"column", "got", "wanted", "relative", "allowed", "rows", "where"}, {}};
  for (const compare::ColumnComparison& column : file.comparison.columns) {
    if (column.equal() == differing) continue;
    std::vector<record::Cell> row(table.columns.size());
    row[0] = column.name;
    if (!column.worst) {
      row[6] = compare::verdict_text(column);
    } else {
      const compare::WorstRow& worst = *column.worst;
      row[1] = worst.got;
      row[2] = worst.want;
      row[3] = worst.relative;
      row[4] = worst.allowed;
      row[5] = static_cast<double>(column.differing);
      row[6] = "row " + std::to_string(worst.row) +
               (worst.case_name.empty() ? "" : ", case " + worst.case_name);
    }
    table.rows.push_back(row);
  }
  if (differing && !file.comparison.rows_equal())
    table.rows.push_back({"rows",
                          static_cast<double>(file.comparison.rows_got),
                          static_cast<double>(file.comparison.rows_want),
                          {},
                          {},
                          {},
                          {}});
  return table.rows.empty() ? page::Markup() : page::table(file.file, table);
}

// The column of a file that differs first by rank_of(); without a difference, the first curve.
const compare::ColumnComparison* told_first(const compare::FileComparison& file) {
  const compare::ColumnComparison* first = nullptr;
  for (const compare::ColumnComparison& column : file.comparison.columns)
    if (column.worst && !column.equal() &&
        (first == nullptr || compare::rank_of(column) < compare::rank_of(*first)))
      first = &column;
  return first;
}

// Whether the rows of every case have another value of the column than the row before.
bool rises(const record::Table& table, int column) {
  const int name = table.find("case");
  for (std::size_t i = 1; i < table.rows.size(); ++i) {
    const auto& before = table.rows[i - 1];
    const auto& row = table.rows[i];
    if (name >= 0 && row[as_index(name)] != before[as_index(name)]) continue;
    if (row[as_index(column)] == before[as_index(column)]) return false;
  }
  return true;
}

std::vector<std::string> cases_of(const record::Table& table) {
  std::vector<std::string> cases;
  if (const int at = table.find("case"); at >= 0)
    for (const auto& row : table.rows)
      if (const auto* name = std::get_if<std::string>(&row[as_index(at)]);
          name != nullptr && std::find(cases.begin(), cases.end(), *name) == cases.end())
        cases.push_back(*name);
  return cases;
}

// The curve of both results in one figure: what was got as a line, what is wanted dashed.
std::optional<plot::Figure> overlay(const std::string& got, const std::string& want,
                                    const compare::FileComparison& file) {
  const record::Table left = record::read_csv(got), right = record::read_csv(want);
  const auto both = [&](const char* name) { return left.find(name) >= 0 && right.find(name) >= 0; };
  const compare::ColumnComparison* first = told_first(file);
  std::string y = first != nullptr && compare::rank_of(*first) < 2 ? first->name : "";
  for (const char* curve : {"force_N", "strain", "stress_kPa"})
    if (y.empty() && both(curve)) y = curve;
  std::string x;
  if (both("travel_mm") && y != "travel_mm" && rises(left, left.find("travel_mm")) &&
      rises(right, right.find("travel_mm")))
    x = "travel_mm";
  else if (both("time_s"))
    x = "time_s";
  if (x.empty() || y.empty()) return std::nullopt;
  const std::vector<std::string> names = cases_of(left), wanted_names = cases_of(right);
  std::vector<std::array<std::string, 2>> cases;  // of both results
  for (const std::string& name : names)
    if (std::find(wanted_names.begin(), wanted_names.end(), name) != wanted_names.end())
      cases.push_back({name, name});
  constexpr std::size_t most = 3;
  if (cases.size() > most) {  // the worst one
    const std::string& worst = first != nullptr ? first->worst->case_name : cases.front()[0];
    cases = {worst.empty() ? cases.front() : std::array{worst, worst}};
  }
  if (cases.empty())  // of other names: the first of both
    cases = {
        {names.empty() ? "" : names.front(), wanted_names.empty() ? "" : wanted_names.front()}};
  plot::Figure figure{.name = "overlay",
                      .title = file.file,
                      .x_label = x,
                      .y_label = y,
                      .from_zero = y == "force_N"};
  for (std::size_t i = 0; i < cases.size(); ++i)
    for (const bool wanted : {false, true})
      figure.series.push_back(
          {.csv_file = fs::absolute(wanted ? want : got).string(),
           .case_name = cases[i][wanted ? 1 : 0],
           .x_column = x,
           .y_column = y,
           .label = (cases[i][0].empty() ? "" : cases[i][wanted ? 1 : 0] + ", ") +
                    (wanted ? "wanted" : "got"),
           .colour = 2 * i + (wanted ? 1 : 0),
           .dashed = wanted});
  return figure;
}

// The overlays of all files, drawn in a folder beside the page that is gone afterwards.
page::Markup overlays(const Compare& command, const compare::FolderComparison& comparison,
                      const Talk& talk) {
  const bool folders = fs::is_directory(command.want);
  const std::string folder = command.report + ".partial";
  page::Markup all;
  for (const compare::FileComparison& file : comparison.files) {
    if (file.state != compare::FileComparison::State::compared) continue;
    const auto at = [&](const std::string& root) {
      return folders ? root + "/" + file.file : root;
    };
    const auto figure = overlay(at(command.got), at(command.want), file);
    if (!figure) continue;
    make_folders(folder);
    const plot::Drawing drawing = plot::draw(plot::sheet_of(*figure), folder);
    if (!drawing.warning.empty()) talk.warn(drawing.warning);
    const std::string caption =
        figure->y_label + " against " + figure->x_label + " in " + file.file +
        (file.equal() ? ": both agree." : ": the line was got, the dashed line is wanted.");
    const fs::path picture = fs::path(folder) / "overlay.svg";
    if (fs::exists(picture)) {
      const page::Markup svg =
          page::inline_svg(read_text(picture.string()), page::id_of(file.file), caption);
      all += page::element("figure", page::element("div", svg, {{"class", "plot"}}) +
                                         page::element("figcaption", caption));
    }
    fs::remove_all(folder);
  }
  return all;
}

std::string cell_text(const record::Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return rounded_text(*number, 4);
  const auto* word = std::get_if<std::string>(&cell);
  return word == nullptr ? "nothing" : "`" + *word + "`";
}

void write_page(const Compare& command, const compare::FolderComparison& comparison,
                const Talk& talk) {
  const std::string got = fs::path(command.got).filename().string();
  const std::string want = fs::path(command.want).filename().string();
  page::Page page(got == want ? got + ", got and wanted" : got + " compared with " + want,
                  "comparison");
  page::Markup differing, agreeing;
  std::vector<std::string> alone;
  const compare::ColumnComparison* worst = nullptr;
  std::size_t columns = 0, all = 0;
  for (const compare::FileComparison& file : comparison.files) {
    if (file.state != compare::FileComparison::State::compared) {
      alone.push_back("`" + file.file + "`: " + compare::verdict_text(file.state));
      continue;
    }
    differing += table_of(file, true);
    agreeing += table_of(file, false);
    const compare::ColumnComparison* first = told_first(file);
    if (first != nullptr &&
        (worst == nullptr || compare::rank_of(*first) < compare::rank_of(*worst)))
      worst = first;
    for (const compare::ColumnComparison& column : file.comparison.columns) {
      ++all;
      if (!column.equal()) ++columns;
    }
  }
  const std::string count = std::to_string(columns) + " of " + std::to_string(all) + " columns";
  if (comparison.equal()) {
    page.headline("Agrees", "in all " + std::to_string(all) + " columns");
  } else if (worst == nullptr) {
    page.headline("Differs", "in its files, columns or rows");
  } else {
    const compare::WorstRow& row = *worst->worst;
    const auto* got_number = std::get_if<double>(&row.got);
    const auto* want_number = std::get_if<double>(&row.want);
    if (std::isfinite(row.relative))
      page.headline(rounded_text(100.0 * row.relative, 3) + " %",
                    "largest difference of " + worst->name);
    else if (got_number != nullptr && want_number != nullptr)  // where 0 is wanted
      page.headline(rounded_text(std::abs(*got_number - *want_number), 3),
                    "largest difference of " + worst->name);
    else
      page.headline("Differs", "in " + worst->name);
    page.answer({count + " differ by more than the tolerances, `" + worst->name + "` in " +
                 std::to_string(worst->differing) + " rows; most" +
                 (row.x_name.empty() ? "" : " at " + row.x_name + " " + cell_text(row.x)) +
                 ", where " + cell_text(row.got) + " was got and " + cell_text(row.want) +
                 " is wanted."});
  }
  page.answer(alone);
  page.section("Curves", overlays(command, comparison, talk));
  page.section("What differs", differing);
  page.section("What agrees", agreeing, page::Page::Shown::folded);
  make_folders(fs::path(command.report).parent_path().string());
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
  if (!command.report.empty()) write_page(command, checks.front().comparison, talk);
  return checks.front().equal() ? exit_good : exit_different;
}

}  // namespace palpate::cli
