// Makes the grid of a response from columns, and its table.
#include "sweep/response.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.h"
#include "base/text.h"
#include "sweep/labels.h"

namespace palpate::sweep {
namespace {

using sweep::FactorColumn;

constexpr std::size_t most_levels = 40;  // six maps then have 2 MB, and the page as much

// A factor of a full grid.
struct GridFactor {
  const FactorColumn* column = nullptr;
  std::size_t stride = 1;               // distance of its levels in the columns, in cases
  std::vector<std::size_t> order = {};  // the levels that are drawn, by value
  std::size_t every = 1;                // every k-th level is drawn
};

std::vector<GridFactor> grid_factors(const sweep::SweepColumns& columns) {
  std::vector<GridFactor> all;
  std::size_t stride = columns.cases;
  for (const FactorColumn& factor : columns.factors) {
    stride /= factor.choice.levels;
    GridFactor one{&factor, stride};
    std::vector<std::size_t> order(factor.choice.levels);
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (factor.is_number())
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return factor.values[a * stride] < factor.values[b * stride];
      });
    one.every = (order.size() + most_levels - 1) / most_levels;
    for (std::size_t i = 0; i < order.size(); i += one.every) one.order.push_back(order[i]);
    all.push_back(one);
  }
  return all;
}

std::string level_text(const FactorColumn& factor, double value) {
  return factor.is_number() ? number_text(value) : factor.words[static_cast<std::size_t>(value)];
}

// The edges of a point's cell in a map: halfway to the neighbouring values, and at the value itself
// where there is none, so that no colour stands beyond what was computed.
struct Edges {
  double low, high;
};
Edges edges(const std::vector<double>& values, std::size_t i, sweep::Scale scale) {
  const bool log = scale == sweep::Scale::logarithmic;
  const auto between = [&](double a, double b) { return log ? std::sqrt(a * b) : 0.5 * (a + b); };
  const double here = values[i];
  return {i > 0 ? between(values[i - 1], here) : here,
          i + 1 < values.size() ? between(here, values[i + 1]) : here};
}

record::Cell number(double value) {
  if (!std::isfinite(value)) return {};
  return value;
}

}  // namespace

std::optional<Response> response(const sweep::SweepColumns& columns,
                                 const sweep::OutputColumn& output, const std::string& title) {
  const std::vector<GridFactor> factors = grid_factors(columns);
  const GridFactor* across = nullptr;
  const GridFactor* along = nullptr;
  for (const GridFactor& factor : factors) {
    if (!factor.column->is_number() || factor.column->choice.levels < 2) continue;
    if (across == nullptr)
      across = &factor;
    else if (along == nullptr)
      along = &factor;
  }
  if (across == nullptr) return std::nullopt;
  for (const GridFactor& factor : factors)
    if (along == nullptr && !factor.column->is_number()) along = &factor;

  Response made{.name = "response_" + file_word(output.name),
                .title = title + ": " + output_label(output.name),
                .output = output.name,
                .across = across->column->choice};
  std::size_t base = 0;  // the first case with all other factors at their middle levels
  for (const GridFactor& factor : factors) {
    const auto& name = factor.column->choice.name;
    if (&factor == across || &factor == along) {
      if (factor.every > 1)
        made.title += ", one level in " + std::to_string(factor.every) + " of " + name;
      continue;
    }
    const std::size_t middle = factor.order[factor.order.size() / 2];
    base += middle * factor.stride;
    if (factor.column->choice.levels > 1)
      made.title += ", " + name + " = " +
                    level_text(*factor.column, factor.column->values[middle * factor.stride]);
  }
  for (const std::size_t level : across->order)
    made.grid.x.push_back(across->column->values[level * across->stride]);
  const std::vector<std::size_t> single{0};
  for (const std::size_t k : along == nullptr ? single : along->order) {
    const std::size_t from = along == nullptr ? base : base + k * along->stride;
    if (along != nullptr) made.grid.y.push_back(along->column->values[k * along->stride]);
    for (const std::size_t level : across->order)
      made.grid.values.push_back(output.values[from + level * across->stride]);
  }
  if (std::none_of(made.grid.values.begin(), made.grid.values.end(),
                   [](double value) { return std::isfinite(value); }))
    return std::nullopt;
  if (along != nullptr) {
    made.along = along->column->choice;
    made.words = along->column->words;
  }
  made.logarithmic = spread_wide(made.grid.values);
  return made;
}

record::Table response_table(const Response& response) {
  const plot::ValueGrid& grid = response.grid;
  const std::string& x = response.across.column;
  record::Table table{{x}, {}};
  if (response.along) table.columns.push_back(response.along->column);
  if (response.is_map())
    for (const std::string& column : {x, response.along->column})
      for (const char* end : {"low_", "high_"}) table.columns.push_back(end + column);
  table.columns.push_back(response.output);
  for (std::size_t j = 0; j * grid.x.size() < grid.values.size(); ++j)
    for (std::size_t i = 0; i < grid.x.size(); ++i) {
      std::vector<record::Cell> row{grid.x[i]};
      if (response.along && !response.is_map())
        row.push_back(response.words[static_cast<std::size_t>(grid.y[j])]);
      if (response.is_map()) {
        const Edges of_x = edges(grid.x, i, response.across.scale);
        const Edges of_y = edges(grid.y, j, response.along->scale);
        row.insert(row.end(), {grid.y[j], of_x.low, of_x.high, of_y.low, of_y.high});
      }
      row.push_back(number(grid.values[j * grid.x.size() + i]));
      table.rows.push_back(row);
    }
  return table;
}

}  // namespace palpate::sweep
