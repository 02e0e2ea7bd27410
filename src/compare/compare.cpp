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
    column.worst = {i + 1, a, b, found.relative, found.allowed};
  }
  return column;
}

std::string cell_text(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return number_text(*number);
  if (const auto* word = std::get_if<std::string>(&cell)) return "`" + *word + "`";
  return "nothing";
}

std::string worst_text(const WorstRow& worst) {
  std::string text = "row " + std::to_string(worst.row) + ": got " + cell_text(worst.got) +
                     ", want " + cell_text(worst.want);
  if (std::isfinite(worst.relative))
    text += ", relative difference " + rounded_text(worst.relative, 3);
  const bool numbers =
      std::holds_alternative<double>(worst.got) && std::holds_alternative<double>(worst.want);
  if (numbers) text += ", allowed " + rounded_text(worst.allowed, 3);
  return text;
}

std::string column_text(const ColumnComparison& column) {
  switch (column.state) {
    case State::ignored: return column.name + ": ignored";
    case State::missing: return column.name + ": DIFFERS, the column is missing";
    case State::extra: return column.name + ": DIFFERS, the column is not wanted";
    case State::compared: break;
  }
  if (!column.worst) return column.name + ": the same";
  if (column.differing == 0) return column.name + ": equal; worst " + worst_text(*column.worst);
  return column.name + ": DIFFERS in " + std::to_string(column.differing) +
         (column.differing == 1 ? " row" : " rows") + "; worst " + worst_text(*column.worst);
}

}  // namespace

bool ColumnComparison::equal() const {
  return state == State::ignored || (state == State::compared && differing == 0);
}

bool Comparison::equal() const {
  return (rows_got == rows_want || !rows_compared) &&
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
  return comparison;
}

std::string comparison_text(const Comparison& comparison) {
  std::string text;
  if (comparison.rows_compared && comparison.rows_got != comparison.rows_want)
    text += "rows: DIFFERS, got " + std::to_string(comparison.rows_got) + ", want " +
            std::to_string(comparison.rows_want) + "\n";
  for (const ColumnComparison& column : comparison.columns) text += column_text(column) + "\n";
  return text;
}

}  // namespace palpate::compare
