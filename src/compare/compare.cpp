// Compares two tables column by column and row by row, and two folders file by file; writes JUnit
// XML and GitHub's workflow commands.
#include "compare/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <system_error>

#include "base/document.h"
#include "base/fields.h"
#include "base/index.h"
#include "base/text.h"
#include "base/written.h"
#include "record/csv.h"

namespace palpate::compare {
namespace {

void fields(FieldVisitor& visitor, Tolerance& tolerance) {
  visitor.number({"rel", "part of the wanted value"}, tolerance.rel, at_least(0.0));
  visitor.number({"abs", "in the unit of the column"}, tolerance.abs, at_least(0.0));
  visitor.flag({"ignore", "whether it is compared at all"}, tolerance.ignore);
  visitor.text({"reason", "why it may differ"}, tolerance.reason);
}

Tolerances read(const Node& root) {
  Tolerances all;
  const Member* columns = root.find("column");
  const Member* tube = root.find("tube");
  if (columns != nullptr)
    for (const Member& column : columns->value.members) {
      all.columns[column.key] = {};
      all.places.emplace_back(column.key, column.place);
    }
  if (tube != nullptr) all.tube.emplace();
  std::optional<double> width;
  const auto keys = [&](FieldVisitor& top) {
    top.table({"default", "of all columns"},
              [&](FieldVisitor& visitor) { fields(visitor, all.standard); });
    top.table({"column", "by name"}, [&](FieldVisitor& visitor) {
      for (auto& [name, tolerance] : all.columns)
        visitor.table({name.c_str(), "a column"},
                      [&one = tolerance](FieldVisitor& inner) { fields(inner, one); });
    });
    top.table({"tube", "around a curve"}, [&](FieldVisitor& visitor) {
      visitor.text({"x", "its column"}, all.tube->x);
      visitor.number({"width", "in the unit of that column"}, width, at_least(0.0));
    });
  };
  // What a column does not give is that of the default, which the first reading finds.
  (void)read_fields(root, keys);
  for (auto& [name, tolerance] : all.columns) {
    tolerance = all.standard;
    tolerance.reason.clear();
  }
  std::vector<Problem> problems = read_fields(root, keys).problems;
  if (tube != nullptr && tube->value.kind == Node::Kind::table) {
    if (const Member* x = tube->value.find("x"))
      all.places.emplace_back(all.tube->x, x->value.place);
    for (const auto& [key, example] : {std::pair{"x", "x = \"time_s\""}, {"width", "width = 0.05"}})
      if (tube->value.find(key) == nullptr)
        problems.push_back(
            {tube->place, "`tube` wants `" + std::string(key) + "`; write `" + example + "`"});
    all.tube->width = width.value_or(0.0);
  }
  if (!problems.empty()) throw InputError(problems);
  return all;
}

}  // namespace

const Tolerance& Tolerances::of(const std::string& column) const {
  const auto found = columns.find(column);
  return found == columns.end() ? standard : found->second;
}

Tolerances parse_tolerances(std::string_view text, const std::string& file) {
  return read(parse_toml(text, file));
}

Tolerances read_tolerances(const std::string& path) { return read(read_toml(path)); }

namespace {

using record::Cell;
using record::Table;
using State = ColumnComparison::State;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Whether two cells are identical; NaN equals NaN.
bool same(const Cell& got, const Cell& want) {
  const auto* g = std::get_if<double>(&got);
  const auto* w = std::get_if<double>(&want);
  return got == want || (g != nullptr && w != nullptr && std::isnan(*g) && std::isnan(*w));
}

// A difference of `size` divided by the allowed one, both at least 0: above 1 if, and only if, it
// is beyond the allowed one; infinite beyond an allowed difference of 0.
double excess(double size, double allowed) {
  if (size <= allowed) return size / allowed;  // at most 1
  return allowed > 0.0 ? std::max(size / allowed, std::nextafter(1.0, 2.0)) : infinity;
}

const double* finite(const Cell& cell) {
  const auto* number = std::get_if<double>(&cell);
  return number != nullptr && std::isfinite(*number) ? number : nullptr;
}

// The values of WANT in a window of x.
struct Window {
  double low = infinity, high = -infinity;
  bool met = false;  // one of them is identical to the value of GOT

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

struct Judged {
  double excess = 0.0;  // above 1 is beyond the tolerance
  WorstRow row;
};

// |got - want| <= abs + rel |want| of the nearest value in the window; values other than finite
// numbers must be identical to one of it.
Judged judge(const Cell& got, const Window& window, const Tolerance& tolerance) {
  Judged judged;
  judged.row.got = got;
  if (window.met) return judged;
  judged.excess = judged.row.relative = infinity;
  if (window.low > window.high) return judged;
  const double* value = finite(got);
  const double nearest = value ? std::clamp(*value, window.low, window.high) : window.low;
  judged.row.want = nearest;
  judged.row.allowed = tolerance.abs + tolerance.rel * std::abs(nearest);
  if (value == nullptr) return judged;
  const double distance = std::abs(*value - nearest);
  if (distance == 0.0) {
    judged.excess = judged.row.relative = 0.0;
    return judged;
  }
  if (nearest != 0.0) judged.row.relative = distance / std::abs(nearest);
  judged.excess = excess(distance, judged.row.allowed);
  return judged;
}

// Counts a row, from 0, and keeps the worst.
void count(ColumnComparison& column, Judged judged, std::size_t row, double& most) {
  if (judged.excess > 1.0) ++column.differing;
  if (judged.excess <= most) return;
  most = judged.excess;
  judged.row.row = row + 1;
  column.worst = judged.row;
}

ColumnComparison compare_column(const Table& got, const Table& want, const std::string& name,
                                const Tolerance& tolerance) {
  ColumnComparison column{.name = name};
  const auto g = as_index(got.find(name));
  const auto w = as_index(want.find(name));
  double most = 0.0;
  for (std::size_t i = 0; i < std::min(got.rows.size(), want.rows.size()); ++i) {
    const Cell& wanted = want.rows[i][w];
    Window window{.met = same(got.rows[i][g], wanted)};
    if (const double* value = finite(wanted)) window.take(*value);
    Judged judged = judge(got.rows[i][g], window, tolerance);
    judged.row.want = wanted;
    count(column, judged, i, most);
  }
  return column;
}

std::string cell_text(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return number_text(*number);
  if (const auto* word = std::get_if<std::string>(&cell)) return "`" + *word + "`";
  return "nothing";
}

std::string worst_text(const WorstRow& worst) {
  std::string text = "row " + std::to_string(worst.row) + ": ";
  if (!worst.case_name.empty()) text += "case `" + one_line(worst.case_name) + "`, ";
  if (!worst.x_name.empty()) {
    const auto* x = std::get_if<double>(&worst.x);  // a place, which six digits tell
    text += one_line(worst.x_name) + " " + (x ? rounded_text(*x, 6) : cell_text(worst.x)) + ", ";
  }
  // Digits that show the difference to three of its own; the JSON has all of them.
  int digits = 17;
  if (std::isfinite(worst.relative) && worst.relative > 0.0)
    digits = std::clamp(3 - static_cast<int>(std::floor(std::log10(worst.relative))), 4, 17);
  const auto shown = [&](const Cell& cell) {
    const auto* number = std::get_if<double>(&cell);
    return number != nullptr && digits < 17 ? rounded_text(*number, digits) : cell_text(cell);
  };
  text += "got " + shown(worst.got) + ", want " + shown(worst.want);
  if (std::isfinite(worst.relative))
    text += ", relative difference " + rounded_text(worst.relative, 3);
  const bool numbers =
      std::holds_alternative<double>(worst.got) && std::holds_alternative<double>(worst.want);
  if (numbers) text += ", allowed " + rounded_text(worst.allowed, 3);
  return text;
}

// The column that tells where in a curve a row is: that of the tube, or time, or displacement.
std::string x_of(const Table& table, const std::optional<Tube>& tube) {
  if (tube && table.find(tube->x) >= 0) return tube->x;
  for (const char* known : {"time_s", "travel_mm"})
    if (table.find(known) >= 0) return known;
  return "";
}

// Adds the case and the x of the worst row, unless it is the column itself that differs.
void locate(ColumnComparison& column, const Table& got, const std::string& x) {
  if (!column.worst || column.worst->row == 0) return;
  const auto& row = got.rows[column.worst->row - 1];
  if (const int at = got.find("case"); at >= 0 && column.name != "case")
    if (const auto* word = std::get_if<std::string>(&row[as_index(at)]))
      column.worst->case_name = *word;
  if (x.empty() || x == column.name) return;
  column.worst->x_name = x;
  column.worst->x = row[as_index(got.find(x))];
}

// The rows of one case with their x. Rows without a finite x are excluded.
struct Course {
  std::vector<double> x;
  std::vector<std::size_t> rows;
};
using Courses = std::map<std::string, Course>;

Courses courses_of(const Table& table, const std::string& x, bool by_case) {
  Courses courses;
  const auto column = as_index(table.find(x));
  const auto name = as_index(table.find("case"));
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto* number = std::get_if<double>(&table.rows[i][column]);
    if (number == nullptr || !std::isfinite(*number)) continue;
    std::string key;
    if (by_case)
      if (const auto* word = std::get_if<std::string>(&table.rows[i][name])) key = *word;
    courses[key].x.push_back(*number);
    courses[key].rows.push_back(i);
  }
  return courses;
}

class Want {
 public:
  Want(const Table& table, const std::string& name, const Course& course)
      : table_(table), column_(as_index(table.find(name))), course_(course) {}

  [[nodiscard]] Window around(double x, double width, const Cell& got) const {
    Window window;
    const auto& xs = course_.x;
    const auto first = std::ranges::lower_bound(xs, x - width) - xs.begin();
    const auto last = std::ranges::upper_bound(xs, x + width) - xs.begin();
    for (auto i = first; i < last; ++i) {
      const Cell& cell = at(i);
      window.met = window.met || same(got, cell);
      if (const double* value = finite(cell)) window.take(*value);
    }
    // Between two rows a word may be that of either row.
    if (first == last && finite(got) == nullptr)
      for (const auto i : {first - 1, first})
        if (i >= 0 && i < static_cast<std::ptrdiff_t>(xs.size()))
          window.met = window.met || same(got, at(i));
    edge(first, x - width, window);
    edge(last, x + width, window);
    return window;
  }

 private:
  [[nodiscard]] const Cell& at(std::ptrdiff_t i) const {
    return table_.rows[course_.rows[as_index(i)]][column_];
  }
  // Adds the value at `x` on the line from row i - 1 to row i.
  void edge(std::ptrdiff_t i, double x, Window& window) const {
    if (i < 1 || i >= static_cast<std::ptrdiff_t>(course_.x.size())) return;
    const double* before = finite(at(i - 1));
    const double* after = finite(at(i));
    if (before == nullptr || after == nullptr) return;
    const double from = course_.x[as_index(i - 1)];
    const double to = course_.x[as_index(i)];
    const double share = to > from ? (x - from) / (to - from) : 1.0;
    window.take(*before + share * (*after - *before));
  }

  const Table& table_;
  std::size_t column_;
  const Course& course_;
};

bool by_case(const Table& got, const Table& want) {
  return got.find("case") >= 0 && want.find("case") >= 0;
}

// Compares every value of GOT with the range of WANT within the tube's width of the same x, with
// linear interpolation between WANT's rows; of cases, if both have them, only with the same. Words
// and non-finite values must be identical to the value of one of the rows in the tube or, if there
// is none, of one of the two rows around it. The `want` of the worst row is the nearest value. Both
// tables have the columns; x rises within a case.
ColumnComparison compare_in_tube(const Table& got, const Table& want, const std::string& name,
                                 const Tolerances& tolerances) {
  ColumnComparison column{.name = name};
  const Tube& tube = *tolerances.tube;
  const bool cases = by_case(got, want);
  const Courses theirs = courses_of(want, tube.x, cases);
  const auto value = as_index(got.find(name));
  const Course none;
  double most = 0.0;
  for (const auto& [key, ours] : courses_of(got, tube.x, cases)) {
    const auto found = theirs.find(key);
    const Want wanted(want, name, found == theirs.end() ? none : found->second);
    for (std::size_t i = 0; i < ours.x.size(); ++i) {
      const Cell& cell = got.rows[ours.rows[i]][value];
      count(column, judge(cell, wanted.around(ours.x[i], tube.width, cell), tolerances.of(name)),
            ours.rows[i], most);
    }
  }
  return column;
}

// Compares the column of x: both must begin and end within the tube's width of each other.
ColumnComparison compare_ends(const Table& got, const Table& want, const Tube& tube) {
  ColumnComparison column{.name = tube.x};
  const bool cases = by_case(got, want);
  const Courses ours = courses_of(got, tube.x, cases);
  for (const auto& [key, theirs] : courses_of(want, tube.x, cases)) {
    const auto found = ours.find(key);
    const bool none = found == ours.end();
    for (const bool first : {true, false}) {
      const double wanted = first ? theirs.x.front() : theirs.x.back();
      const double there = none    ? infinity
                           : first ? found->second.x.front()
                                   : found->second.x.back();
      const double distance = std::abs(there - wanted);
      if (distance <= tube.width) continue;
      ++column.differing;
      WorstRow& worst = column.worst.emplace();
      if (!none) {
        worst.row = (first ? found->second.rows.front() : found->second.rows.back()) + 1;
        worst.got = there;
      }
      worst.want = wanted;
      worst.relative = wanted != 0.0 ? distance / std::abs(wanted) : infinity;
      worst.allowed = tube.width;
    }
  }
  return column;
}

}  // namespace

std::string verdict_text(const ColumnComparison& column) {
  switch (column.state) {
    case State::ignored: return "ignored";
    case State::missing: return "DIFFERS, the column is missing";
    case State::extra: return "DIFFERS, the column is not wanted";
    case State::compared: break;
  }
  if (!column.worst) return "the same";
  if (column.differing == 0) return "equal; worst " + worst_text(*column.worst);
  return "DIFFERS in " + count_text(column.differing, "row") + "; worst " +
         worst_text(*column.worst);
}

int rank_of(const ColumnComparison& column) {
  const std::array curves{"force_N", "strain", "stress_kPa"};
  const bool of_curve = column.worst && !column.worst->x_name.empty();
  if (of_curve && std::ranges::find(curves, column.name) != curves.end()) return 0;
  if (of_curve) return 2;
  const std::array results{"peak_", "force_at_", "secant_modulus_kPa", "elastic_strain",
                           "creep_half_time_s"};
  return std::ranges::any_of(results,
                             [&](const char* name) { return column.name.starts_with(name); })
             ? 1
             : 3;
}

bool ColumnComparison::equal() const {
  return state == State::ignored || (state == State::compared && differing == 0);
}

bool Comparison::rows_equal() const { return rows_got == rows_want || !rows_compared; }

bool Comparison::equal() const {
  return rows_equal() &&
         std::ranges::all_of(columns, [](const auto& each) { return each.equal(); });
}

Comparison compare(const Table& got, const Table& want, const Tolerances& tolerances) {
  Comparison comparison{.rows_got = got.rows.size(), .rows_want = want.rows.size()};
  const auto& tube = tolerances.tube;
  const bool in_tube = tube && got.find(tube->x) >= 0 && want.find(tube->x) >= 0;
  comparison.rows_compared = !in_tube;
  for (const std::string& name : want.columns) {
    const Tolerance& tolerance = tolerances.of(name);
    if (tolerance.ignore)
      comparison.columns.push_back({.name = name, .state = State::ignored});
    else if (got.find(name) < 0)
      comparison.columns.push_back({.name = name, .state = State::missing});
    else if (in_tube && name == tube->x)
      comparison.columns.push_back(compare_ends(got, want, *tube));
    else if (in_tube)
      comparison.columns.push_back(compare_in_tube(got, want, name, tolerances));
    else
      comparison.columns.push_back(compare_column(got, want, name, tolerance));
  }
  for (const std::string& name : got.columns)
    if (want.find(name) < 0)
      comparison.columns.push_back(
          {.name = name, .state = tolerances.of(name).ignore ? State::ignored : State::extra});
  const std::string x = x_of(got, tube);
  for (ColumnComparison& column : comparison.columns) locate(column, got, x);
  return comparison;
}

namespace {

// Refuses tolerances for columns that no table has: a misspelt name would allow nothing.
void refuse_unknown_columns(const Tolerances& tolerances, const std::set<std::string>& columns) {
  const std::vector<std::string> known(columns.begin(), columns.end());
  std::vector<Problem> problems;
  const auto ask = [&](const std::string& name, const Place& place) {
    if (columns.contains(name)) return;
    problems.push_back(
        {place,
         "`" + name + "` is no column of these files; " +
             did_you_mean(name, known, "take it out, or name one of " + joined(known, ", "))});
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
  return std::ranges::all_of(files, [](const auto& each) { return each.equal(); });
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

std::string Item::sentence() const {
  return file.empty() ? text : one_line(file) + ", " + one_line(name) + ": " + text;
}

std::vector<Item> items_of(const FolderComparison& comparison) {
  std::vector<Item> items;
  for (const FileComparison& file : comparison.files) {
    const auto failed = [&](const std::string& name, const std::string& text) {
      items.push_back({Item::State::failed, file.file, name, "DIFFERS, " + text});
    };
    if (file.state == FileComparison::State::missing) failed("file", "the file is missing");
    if (file.state == FileComparison::State::extra) failed("file", "the file is not wanted");
    if (!file.comparison.rows_equal())
      failed("rows",
             "got " + std::to_string(file.comparison.rows_got) + ", want " +
                 std::to_string(file.comparison.rows_want) + "; compared: the first " +
                 std::to_string(std::min(file.comparison.rows_got, file.comparison.rows_want)));
    for (const ColumnComparison& column : file.comparison.columns) {
      Item item{.file = file.file, .name = column.name, .rank = rank_of(column), .column = &column};
      if (column.state == ColumnComparison::State::ignored) item.state = Item::State::skipped;
      if (!column.equal()) {
        item.state = Item::State::failed;
        item.text = verdict_text(column);
      }
      items.push_back(std::move(item));
    }
  }
  return items;
}

std::vector<Item> differences(const FolderComparison& comparison) {
  std::vector<Item> all = items_of(comparison);
  std::erase_if(all, [](const Item& item) { return item.state != Item::State::failed; });
  std::ranges::stable_sort(all, {}, &Item::rank);
  return all;
}

std::string common_rows_text(const FolderComparison& comparison, const std::string& file) {
  for (const FileComparison& one : comparison.files)
    if (const auto& [got, want] = std::pair(one.comparison.rows_got, one.comparison.rows_want);
        one.file == file && !one.comparison.rows_equal())
      return " over the first " + std::to_string(std::min(got, want)) + " of " +
             count_text(std::max(got, want), "row");
  return "";
}

std::string headline(const FolderComparison& comparison) {
  std::size_t columns = 0;
  for (const FileComparison& file : comparison.files) columns += file.comparison.columns.size();
  const std::size_t files = comparison.files.size();
  const std::string all =
      count_text(columns, "column") + (files == 1 ? "" : " of " + count_text(files, "file"));
  if (comparison.equal()) return "equal: " + all;
  const std::vector<Item> found = differences(comparison);
  const auto differing =
      std::ranges::count_if(found, [](const Item& item) { return item.column != nullptr; });
  const Item& first = found.front();
  std::string text = "DIFFERS in " + std::to_string(differing) + " of " + all + ", in " +
                     (first.column != nullptr ? one_line(first.name)
                      : first.name == "rows"  ? "the number of rows"
                                              : "what files there are");
  if (first.column != nullptr && first.column->worst &&
      std::isfinite(first.column->worst->relative))
    text += " by " + percent_text(first.column->worst->relative);
  if (first.column != nullptr) text += common_rows_text(comparison, first.file);
  return text;
}

std::string difference_lines(const FolderComparison& comparison) {
  constexpr std::size_t most = 8;
  const std::vector<Item> found = differences(comparison);
  std::string text;
  for (std::size_t i = 0; i < std::min(found.size(), most); ++i)
    text += (comparison.files.size() == 1 ? one_line(found[i].name) + ": " + found[i].text
                                          : found[i].sentence()) +
            "\n";
  if (found.size() > most)
    text += "and " + std::to_string(found.size() - most) +
            " more; `--json` tells all of them, `palpate compare GOT WANT --report FILE` writes "
            "them on a page\n";
  return text;
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

namespace {

std::vector<Item> items_of(const Check& check) {
  if (!check.error.empty()) return {{Item::State::error, "", "run", check.error}};
  return items_of(check.comparison);
}

std::string counts(const std::vector<Item>& items) {
  const auto count = [&](Item::State state) {
    std::size_t number = 0;
    for (const Item& item : items) number += item.state == state ? 1U : 0U;
    return std::to_string(number);
  };
  return " tests=\"" + std::to_string(items.size()) + "\" failures=\"" +
         count(Item::State::failed) + "\" errors=\"" + count(Item::State::error) + "\" skipped=\"" +
         count(Item::State::skipped) + "\"";
}

std::string test_case(const Check& check, const Item& item) {
  std::string text = "    <testcase classname=\"" +
                     escaped(check.name + (item.file.empty() ? "" : "/" + item.file)) +
                     "\" name=\"" + escaped(item.name) + "\"";
  const std::string message = " message=\"" + escaped(item.sentence()) + "\"/></testcase>\n";
  switch (item.state) {
    case Item::State::good: return text + "/>\n";
    case Item::State::skipped: return text + "><skipped/></testcase>\n";
    case Item::State::failed: return text + "><failure type=\"difference\"" + message;
    case Item::State::error: return text + "><error type=\"no result\"" + message;
  }
  return text;
}

enum class Part { property, message };

// Escapes as GitHub's own toolkit does; properties end at a comma or a colon.
std::string command_text(const std::string& text, Part part) {
  std::string safe;
  for (const char letter : text) {
    switch (letter) {
      case '%': safe += "%25"; break;
      case '\r': safe += "%0D"; break;
      case '\n': safe += "%0A"; break;
      case ':': safe += part == Part::property ? "%3A" : ":"; break;
      case ',': safe += part == Part::property ? "%2C" : ","; break;
      default: safe += letter;
    }
  }
  return safe;
}

// The line of the worst row in the wanted file, whose header is line 1; 0 in a tube, whose rows are
// not those of the wanted file, and where there is none.
std::size_t line_of(const Check& check, const Item& item) {
  if (item.column == nullptr || !item.column->worst) return 0;
  for (const FileComparison& file : check.comparison.files)
    if (file.file == item.file && file.comparison.rows_compared) return item.column->worst->row + 1;
  return 0;
}

}  // namespace

std::string junit_text(std::span<const Check> checks) {
  std::vector<Item> all;
  std::string suites;
  for (const Check& check : checks) {
    const std::vector<Item> items = items_of(check);
    all.insert(all.end(), items.begin(), items.end());
    suites += "  <testsuite name=\"" + escaped(check.name) + "\"" + counts(items) + ">\n";
    for (const Item& item : items) suites += test_case(check, item);
    suites += "  </testsuite>\n";
  }
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"palpate\"" + counts(all) +
         ">\n" + suites + "</testsuites>\n";
}

std::string github_annotations(std::span<const Check> checks) {
  std::string text;
  for (const Check& check : checks) {
    if (check.equal()) continue;
    const std::vector<Item> bad =
        check.error.empty() ? differences(check.comparison) : items_of(check);
    const Item& item = bad.front();
    std::filesystem::path file(check.error.empty() ? check.want : check.name);
    if (!item.file.empty() && !check.one_file) file /= item.file;
    text += "::error file=" + command_text(file.generic_string(), Part::property);
    if (const std::size_t line = line_of(check, item); line > 0)
      text += ",line=" + std::to_string(line);
    const std::string more =
        bad.size() == 1 ? "" : " (" + std::to_string(bad.size()) + " differences in all)";
    text += ",title=" + command_text("palpate: " + check.name, Part::property) +
            "::" + command_text(item.sentence() + more, Part::message) + "\n";
  }
  return text;
}

}  // namespace palpate::compare
