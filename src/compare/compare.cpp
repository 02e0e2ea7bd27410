// Compares two tables column by column and row by row.
#include "compare/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "base/text.h"
#include "compare/tube.h"

namespace palpate::compare {
namespace {

// A name from a file as part of a line: it ends none, and is no command for a build server.
std::string one_line(const std::string& name) {
  std::string line;
  for (const char c : name) line += c == '\n' ? std::string("\\x0a") : std::string(1, c);
  return line.starts_with("::") ? "\\x3a" + line.substr(1) : line;
}

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
  text += "got " + cell_text(worst.got) + ", want " + cell_text(worst.want);
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

std::string comparison_text(const Comparison& comparison, Show show) {
  std::string text;
  if (!comparison.rows_equal()) text += "rows: " + rows_text(comparison) + "\n";
  for (const ColumnComparison& column : comparison.columns)
    if (show == Show::all || !column.equal())
      text += one_line(column.name) + ": " + verdict_text(column) + "\n";
  return text;
}

}  // namespace palpate::compare
