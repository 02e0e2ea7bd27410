// Compares two tables column by column and row by row.
#include "compare/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "base/document.h"
#include "base/error.h"
#include "base/index.h"
#include "base/text.h"

namespace palpate::compare {
namespace {

const std::vector<std::string>& tables() {
  static const std::vector<std::string> names{"default", "column", "tube"};
  return names;
}
const std::vector<std::string>& keys() {
  static const std::vector<std::string> names{"rel", "abs", "ignore", "reason"};
  return names;
}
const std::vector<std::string>& tube_keys() {
  static const std::vector<std::string> names{"x", "width"};
  return names;
}

std::string unknown(const std::string& key, std::span<const std::string> known) {
  const std::string message = "`" + key + "` is not known here";
  if (const auto near = nearest(key, known)) return message + "; did you mean `" + *near + "`?";
  return message + "; write one of `" + joined(known, "`, `") + "`";
}

std::string wants(const std::string& key, const std::string& what, const Node& got,
                  const std::string& remedy) {
  return "`" + key + "` wants " + what + ", got `" + got.shown() + "`; write it as `" + remedy +
         "`";
}

class Reader {
 public:
  void read(const Node& root, Tolerances& tolerances) {
    if (const Member* standard = root.find("default")) table(*standard, tolerances.standard);
    for (const Member& member : root.members) {
      if (member.key == "default") continue;
      if (member.key == "tube") {
        tube(member, tolerances.tube.emplace());
        if (const Member* x = member.value.find("x"))
          tolerances.places.emplace_back(tolerances.tube->x, x->value.place);
        continue;
      }
      if (member.key != "column") {
        report(member.place, unknown(member.key, tables()));
      } else if (member.value.kind != Node::Kind::table) {
        report(member.value.place, "`column` wants tables, as `[column.force_N]`");
      } else {
        for (const Member& column : member.value.members) {
          Tolerance tolerance = tolerances.standard;
          tolerance.reason.clear();
          table(column, tolerance);
          tolerances.columns[column.key] = tolerance;
          tolerances.places.emplace_back(column.key, column.place);
        }
      }
    }
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  void table(const Member& from, Tolerance& to) {
    if (from.value.kind != Node::Kind::table)
      return report(from.value.place, "`" + from.key + "` wants a table, got `" +
                                          from.value.shown() + "`; give it keys, as `rel = 1e-9`");
    for (const Member& member : from.value.members) {
      if (member.key == "rel")
        number(member, to.rel, "1e-9");
      else if (member.key == "abs")
        number(member, to.abs, "1e-12");
      else if (member.key == "ignore")
        truth(member, to.ignore);
      else if (member.key == "reason")
        text(member, to.reason, "reason = \"rounding of 1e4 steps\"");
      else
        report(member.place, unknown(member.key, keys()));
    }
  }

  void tube(const Member& from, Tube& to) {
    if (from.value.kind != Node::Kind::table)
      return report(from.value.place, "`tube` wants a table, got `" + from.value.shown() +
                                          "`; write `[tube]` and below it `x` and `width`");
    for (const Member& member : from.value.members) {
      if (member.key == "x")
        text(member, to.x, "x = \"time_s\"");
      else if (member.key == "width")
        number(member, to.width, "0.05");
      else
        report(member.place, unknown(member.key, tube_keys()));
    }
    if (to.x.empty())
      report(from.place, "`tube` wants the name of the column of x; write `x = \"time_s\"`");
    if (from.value.find("width") == nullptr)
      report(from.place, "`tube` wants a width, in the unit of its column; write `width = 0.05`");
  }

  void number(const Member& from, double& to, const std::string& example) {
    const bool good =
        from.value.is_number() && std::isfinite(from.value.number) && from.value.number >= 0.0;
    if (good)
      to = from.value.number;
    else
      report(from.value.place,
             wants(from.key, "a number of 0 or more", from.value, from.key + " = " + example));
  }

  void truth(const Member& from, bool& to) {
    if (from.value.kind == Node::Kind::boolean)
      to = from.value.boolean;
    else
      report(from.value.place, wants(from.key, "true or false", from.value, "ignore = true"));
  }

  void text(const Member& from, std::string& to, const std::string& example) {
    if (from.value.kind == Node::Kind::text)
      to = from.value.text;
    else
      report(from.value.place, wants(from.key, "a text", from.value, example));
  }

  void report(const Place& place, const std::string& message) {
    problems_.push_back({place, message});
  }

  std::vector<Problem> problems_;
};

}  // namespace

const Tolerance& Tolerances::of(const std::string& column) const {
  const auto found = columns.find(column);
  return found == columns.end() ? standard : found->second;
}

Tolerances parse_tolerances(std::string_view text, const std::string& file) {
  Tolerances tolerances;
  Reader().read(parse_toml(text, file), tolerances);
  return tolerances;
}

Tolerances read_tolerances(const std::string& path) {
  Tolerances tolerances;
  Reader().read(read_toml(path), tolerances);
  return tolerances;
}

namespace {

using record::Cell;
using record::Table;
using State = ColumnComparison::State;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Difference {
  double relative = 0.0;
  double allowed = 0.0;
  double excess = 0.0;  // difference / allowed; above 1 is beyond the tolerance
};

// |got - want| <= abs + rel |want|; values other than finite numbers must be identical.
Difference difference(const Cell& got, const Cell& want, const Tolerance& tolerance) {
  const auto* g = std::get_if<double>(&got);
  const auto* w = std::get_if<double>(&want);
  Difference result;
  if (same(got, want)) return result;
  result.relative = result.excess = infinity;
  if (w != nullptr && std::isfinite(*w))
    result.allowed = tolerance.abs + tolerance.rel * std::abs(*w);
  if (g == nullptr || w == nullptr || !std::isfinite(*g) || !std::isfinite(*w)) return result;
  const double size = std::abs(*g - *w);
  if (*w != 0.0) result.relative = size / std::abs(*w);
  result.excess = excess(size, result.allowed);
  return result;
}

ColumnComparison compare_column(const Table& got, const Table& want, const std::string& name,
                                const Tolerance& tolerance) {
  ColumnComparison column{.name = name};
  const auto g = as_index(got.find(name));
  const auto w = as_index(want.find(name));
  double most = 0.0;
  for (std::size_t i = 0; i < std::min(got.rows.size(), want.rows.size()); ++i) {
    const Cell& a = got.rows[i][g];
    const Cell& b = want.rows[i][w];
    const Difference found = difference(a, b, tolerance);
    if (found.excess > 1.0) ++column.differing;
    if (found.excess <= most) continue;
    most = found.excess;
    column.worst = {
        .row = i + 1, .got = a, .want = b, .relative = found.relative, .allowed = found.allowed};
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
  if (!worst.x_name.empty()) text += one_line(worst.x_name) + " " + cell_text(worst.x) + ", ";
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

// The column that tells where in a curve a row is: that of the tube, or time, or travel.
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
  return "DIFFERS in " + std::to_string(column.differing) +
         (column.differing == 1 ? " row" : " rows") + "; worst " + worst_text(*column.worst);
}

std::string rows_text(const Comparison& comparison) {
  return "DIFFERS, got " + std::to_string(comparison.rows_got) + ", want " +
         std::to_string(comparison.rows_want);
}

int rank_of(const ColumnComparison& column) {
  const std::array curves{"force_N", "strain", "stress_kPa"};
  const bool of_curve = column.worst && !column.worst->x_name.empty();
  if (of_curve && std::find(curves.begin(), curves.end(), column.name) != curves.end()) return 0;
  if (of_curve) return 2;
  const std::array results{"peak_", "force_at_", "secant_modulus_kPa", "elastic_strain",
                           "creep_half_time_s"};
  return std::any_of(results.begin(), results.end(),
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
         std::all_of(columns.begin(), columns.end(), [](const auto& each) { return each.equal(); });
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

std::string comparison_text(const Comparison& comparison) {
  std::string text;
  if (!comparison.rows_equal()) text += "rows: " + rows_text(comparison) + "\n";
  for (const ColumnComparison& column : comparison.columns)
    if (!column.equal()) text += one_line(column.name) + ": " + verdict_text(column) + "\n";
  return text;
}

namespace {

using record::Cell;
using record::Table;

constexpr double unbounded = std::numeric_limits<double>::infinity();

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

const double* finite(const Cell& cell) {
  const auto* number = std::get_if<double>(&cell);
  return number != nullptr && std::isfinite(*number) ? number : nullptr;
}

// The values of WANT in a window of x.
struct Window {
  double low = unbounded, high = -unbounded;
  bool met = false;  // one of them is identical to the value of GOT

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

class Want {
 public:
  Want(const Table& table, const std::string& name, const Course& course)
      : table_(table), column_(as_index(table.find(name))), course_(course) {}

  [[nodiscard]] Window around(double x, double width, const Cell& got) const {
    Window window;
    const auto& xs = course_.x;
    const auto first = std::lower_bound(xs.begin(), xs.end(), x - width) - xs.begin();
    const auto last = std::upper_bound(xs.begin(), xs.end(), x + width) - xs.begin();
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

struct Judged {
  double excess = 0.0;  // above 1 is beyond the tolerance
  WorstRow row;
};

Judged judge(const Cell& got, const Window& window, const Tolerance& tolerance) {
  Judged judged;
  judged.row.got = got;
  if (window.met) return judged;
  judged.excess = judged.row.relative = unbounded;
  const double* value = finite(got);
  if (value == nullptr || window.low > window.high) return judged;
  const double nearest = std::clamp(*value, window.low, window.high);
  const double distance = std::abs(*value - nearest);
  judged.row.want = nearest;
  judged.row.allowed = tolerance.abs + tolerance.rel * std::abs(nearest);
  if (distance == 0.0) {
    judged.excess = judged.row.relative = 0.0;
    return judged;
  }
  if (nearest != 0.0) judged.row.relative = distance / std::abs(nearest);
  judged.excess = excess(distance, judged.row.allowed);
  return judged;
}

}  // namespace

bool same(const Cell& got, const Cell& want) {
  const auto* g = std::get_if<double>(&got);
  const auto* w = std::get_if<double>(&want);
  return got == want || (g != nullptr && w != nullptr && std::isnan(*g) && std::isnan(*w));
}

double excess(double size, double allowed) {
  if (size <= allowed) return size / allowed;  // at most 1
  return allowed > 0.0 ? std::max(size / allowed, std::nextafter(1.0, 2.0)) : unbounded;
}

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
      Judged judged = judge(cell, wanted.around(ours.x[i], tube.width, cell), tolerances.of(name));
      if (judged.excess > 1.0) ++column.differing;
      if (judged.excess <= most) continue;
      most = judged.excess;
      judged.row.row = ours.rows[i] + 1;
      column.worst = judged.row;
    }
  }
  return column;
}

ColumnComparison compare_ends(const Table& got, const Table& want, const Tube& tube) {
  ColumnComparison column{.name = tube.x};
  const bool cases = by_case(got, want);
  const Courses ours = courses_of(got, tube.x, cases);
  for (const auto& [key, theirs] : courses_of(want, tube.x, cases)) {
    const auto found = ours.find(key);
    const bool none = found == ours.end();
    for (const bool first : {true, false}) {
      const double wanted = first ? theirs.x.front() : theirs.x.back();
      const double there = none    ? unbounded
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
      worst.relative = wanted != 0.0 ? distance / std::abs(wanted) : unbounded;
      worst.allowed = tube.width;
    }
  }
  return column;
}

}  // namespace palpate::compare
