// `palpate compare`: compares two files or two folders.
#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "base/text.h"
#include "base/written.h"
#include "cli/checks.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "page/page.h"
#include "plot/gnuplot.h"
#include "record/csv.h"
#include "sweep/columns.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

// What the two results are called on the page.
struct Names {
  std::string got, want;
  std::string both = {};  // the last part of both paths, if it is the same
};

// Both paths without what they begin and end with in common, but for one part at least: `out/a` and
// `golden/a` are `out` and `golden`. Equal paths are `got` and `wanted`.
Names names_of(const Compare& command) {
  const auto parts = [](const std::string& path) {
    std::vector<std::string> all;
    for (const fs::path& part : fs::absolute(path).lexically_normal())
      if (!part.empty()) all.push_back(part.string());
    return all;
  };
  std::vector<std::string> got = parts(command.got), want = parts(command.want);
  const std::string both = got.back() == want.back() ? got.back() : "";
  if (got == want) return {"got", "wanted", both};
  while (got.size() > 1 && want.size() > 1 && got.back() == want.back()) {
    got.pop_back();
    want.pop_back();
  }
  while (got.size() > 1 && want.size() > 1 && got.front() == want.front()) {
    got.erase(got.begin());
    want.erase(want.begin());
  }
  return {joined(got, "/"), joined(want, "/"), both};
}

using compare::Item;

std::string where_text(const compare::ColumnComparison& column) {
  if (!column.worst) return compare::verdict_text(column);
  const compare::WorstRow& worst = *column.worst;
  return "row " + std::to_string(worst.row) +
         (worst.case_name.empty() ? "" : ", case " + worst.case_name);
}

record::Table table_of(const std::vector<Item>& items, const Names& names) {
  record::Table table{
      {"column", names.got, names.want, "difference", "where most", "rows", "allowed"}, {}};
  for (const Item& item : items) {
    const compare::ColumnComparison& column = *item.column;
    std::vector<record::Cell> row(table.columns.size());
    row[0] = column.name;
    row[4] = where_text(column);
    if (column.worst) {
      row[1] = column.worst->got;
      row[2] = column.worst->want;
      if (std::isfinite(column.worst->relative)) row[3] = percent_text(column.worst->relative);
      row[5] = static_cast<double>(column.differing);
      row[6] = column.worst->allowed;
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

// The results that differ, at most eight; of files without results, the first columns.
page::Markup first_table(std::vector<Item> differing, const Names& names) {
  constexpr std::size_t most = 8;
  const auto rest = std::ranges::find_if(
      differing, [](const Item& one) { return one.rank > compare::last_result_rank; });
  if (rest != differing.begin()) differing.erase(rest, differing.end());
  if (differing.size() > most) differing.resize(most);
  if (differing.empty()) return {};
  record::Table table = table_of(differing, names);
  for (auto& row : table.rows) row.pop_back();  // `allowed` is below
  table.columns.pop_back();
  return page::table(
      "The value that differs most in each column, and by how much of that of " + names.want,
      table);
}

// These columns file by file, those without any difference by their names.
page::Markup all_tables(const compare::FolderComparison& comparison, const std::vector<Item>& items,
                        const Names& names) {
  page::Markup all;
  for (const compare::FileComparison& file : comparison.files) {
    std::vector<Item> of_file;
    std::vector<std::string> same;
    for (const Item& item : items) {
      if (item.file != file.file) continue;
      if (item.state == Item::State::good && !item.column->worst)
        same.push_back(ticked(item.name));
      else
        of_file.push_back(item);
    }
    if (!of_file.empty()) all += page::table(file.file, table_of(of_file, names));
    if (!same.empty())
      all += page::paragraphs({"The same in " + ticked(file.file) + ": " + joined(same, ", ")});
  }
  return all;
}

// `Model in a: layer, with a stated error of 2.5 %`, of a result folder; of several cases every
// model and the largest error. Empty without a model.
std::string model_text(const std::string& name, const std::string& folder) {
  const std::string file = folder + "/findings.csv";
  if (!fs::exists(file)) return "";
  const record::Table table = record::read_csv(file);
  const int model = table.find("model"), error = table.find("stated_error");
  std::set<std::string> models;
  double most = 0.0;
  for (const auto& row : table.rows) {
    if (model >= 0)
      if (const auto* word = std::get_if<std::string>(&row[as_index(model)])) models.insert(*word);
    if (error >= 0)
      if (const auto* number = std::get_if<double>(&row[as_index(error)]))
        most = std::max(most, *number);
  }
  if (models.empty()) return "";
  return "Model in " + name + ": " +
         joined(std::vector<std::string>(models.begin(), models.end()), ", ") +
         (most > 0.0 ? ", with a stated error of " +
                           std::string(table.rows.size() > 1 ? "up to " : "") + error_text(most)
                     : "");
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
          name != nullptr && std::ranges::find(cases, *name) == cases.end())
        cases.push_back(*name);
  return cases;
}

// The label of an axis: `Displacement (mm)` of the column `travel_mm`.
std::string axis_label(const std::string& column) {
  return sweep::output_label(column == "travel_mm" ? "displacement_mm" : column);
}

// The curve of both results in one figure: what was got as a line, what is wanted dashed. `first`
// is the column that differs, null if none does.
std::optional<plot::Figure> overlay(const std::string& got, const std::string& want,
                                    const compare::FileComparison& file, const Names& sides,
                                    const compare::ColumnComparison* first) {
  const record::Table left = record::read_csv(got), right = record::read_csv(want);
  const auto both = [&](const char* name) { return left.find(name) >= 0 && right.find(name) >= 0; };
  std::string y = first != nullptr && !first->worst->x_name.empty() ? first->name : "";
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
    if (std::ranges::find(wanted_names, name) != wanted_names.end()) cases.push_back({name, name});
  constexpr std::size_t most = 3;
  if (cases.size() > most) {  // the worst one
    const std::string& worst = first != nullptr ? first->worst->case_name : cases.front()[0];
    cases = {worst.empty() ? cases.front() : std::array{worst, worst}};
  }
  if (cases.empty())  // of other names: the first of both
    cases = {
        {names.empty() ? "" : names.front(), wanted_names.empty() ? "" : wanted_names.front()}};
  const bool same_case = cases.size() == 1 && cases[0][0] == cases[0][1];
  plot::Figure figure{.name = "overlay",
                      .title = file.file,
                      .x_label = axis_label(x),
                      .y_label = axis_label(y),
                      .from_zero = y == "force_N"};
  for (std::size_t i = 0; i < cases.size(); ++i)
    for (const bool wanted : {false, true})
      figure.series.push_back({.csv_file = fs::absolute(wanted ? want : got).string(),
                               .case_name = cases[i][wanted ? 1 : 0],
                               .x_column = x,
                               .y_column = y,
                               .label = (same_case ? "" : cases[i][wanted ? 1 : 0] + ", ") +
                                        (wanted ? sides.want : sides.got),
                               .colour = 2 * i + (wanted ? 1 : 0),
                               .dashed = wanted});
  return figure;
}

std::vector<Item> columns_that_differ(const compare::FolderComparison& comparison) {
  std::vector<Item> items = compare::differences(comparison);
  std::erase_if(items, [](const Item& item) { return item.column == nullptr; });
  return items;
}

// The overlays of all files, drawn in a folder beside the page that is gone afterwards.
std::vector<page::Markup> overlays(const Compare& command,
                                   const compare::FolderComparison& comparison, const Names& names,
                                   const Talk& talk) {
  const bool folders = fs::is_directory(command.want);
  const std::string folder = command.report + ".partial";
  std::vector<page::Markup> all;
  const std::vector<Item> differing = columns_that_differ(comparison);
  for (const compare::FileComparison& file : comparison.files) {
    if (file.state != compare::FileComparison::State::compared) continue;
    const auto at = [&](const std::string& root) {
      return folders ? root + "/" + file.file : root;
    };
    const auto first = std::ranges::find_if(
        differing, [&](const Item& item) { return item.file == file.file && item.column->worst; });
    const auto figure = overlay(at(command.got), at(command.want), file, names,
                                first == differing.end() ? nullptr : first->column);
    if (!figure) continue;
    make_folders(folder);
    const plot::Drawing drawing = plot::draw(plot::sheet_of(*figure), folder);
    if (!drawing.warning.empty()) talk.warn(drawing.warning);
    const std::string caption =
        figure->y_label + " against " + within_sentence(figure->x_label) + " in " + file.file +
        (file.equal() ? ": both agree."
                      : ": the line is " + names.got + ", the dashed one " + names.want + ".");
    const fs::path picture = fs::path(folder) / "overlay.svg";
    if (fs::exists(picture)) {
      const page::Markup svg =
          page::inline_svg(read_text(picture.string()), page::id_of(file.file), caption);
      all.push_back(page::element("figure", page::element("div", svg, {{"class", "plot"}}) +
                                                page::element("figcaption", caption)));
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
  const Names names = names_of(command);
  page::Page page(
      (names.both.empty() ? "" : names.both + ": ") + names.got + " compared with " + names.want,
      "comparison");
  const std::vector<Item> differing = columns_that_differ(comparison);
  std::vector<std::string> alone;
  for (const Item& item : compare::differences(comparison))
    if (item.column == nullptr)
      alone.push_back("`" + item.file + "`, " + item.name + ": " + item.text);
  std::vector<Item> agreeing = compare::items_of(comparison);
  std::erase_if(agreeing, [](const Item& item) { return item.state == Item::State::failed; });
  const std::size_t all = differing.size() + agreeing.size();
  const auto first = std::ranges::find_if(
      differing, [](const Item& item) { return item.column->worst.has_value(); });
  const compare::ColumnComparison* worst = first == differing.end() ? nullptr : first->column;
  if (comparison.equal()) {
    page.headline("Agrees", "in all " + std::to_string(all) + " columns");
  } else if (worst == nullptr) {
    page.headline("Differs", "in its files, columns or rows");
  } else {
    const compare::WorstRow& row = *worst->worst;
    const std::string common = compare::common_rows_text(comparison, first->file);
    const auto* got_number = std::get_if<double>(&row.got);
    const auto* want_number = std::get_if<double>(&row.want);
    if (std::isfinite(row.relative))
      page.headline(rounded_text(100.0 * row.relative, 3) + " %",
                    "largest difference of " + worst->name + common);
    else if (got_number != nullptr && want_number != nullptr)  // where 0 is wanted
      page.headline(rounded_text(std::abs(*got_number - *want_number), 3),
                    "largest difference of " + worst->name + common);
    else
      page.headline("Differs", "in " + worst->name + common);
    page.answer({std::to_string(differing.size()) + " of " + std::to_string(all) +
                 " columns differ by more than the tolerances, `" + worst->name + "` in " +
                 count_text(worst->differing, "row") + "; most" +
                 (row.x_name.empty() ? "" : " at " + row.x_name + " " + cell_text(row.x)) +
                 ", where it is " + cell_text(row.got) + " in " + names.got + " and " +
                 cell_text(row.want) + " in " + names.want + "."});
  }
  page.answer(alone);
  page.answer({model_text(names.got, command.got), model_text(names.want, command.want)});
  page.figures(overlays(command, comparison, names, talk));
  page.section("What differs", first_table(differing, names));
  constexpr auto folded = page::Page::Shown::folded;
  page.section("All columns that differ", all_tables(comparison, differing, names), folded);
  page.section("All columns that agree", all_tables(comparison, agreeing, names), folded);
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
  if (checks.front().equal()) return exit_good;
  if (command.report.empty())
    talk.next("compare", command.got,
              " " + shown_word(command.want) + " --report differences.html");
  return exit_different;
}

}  // namespace palpate::cli
