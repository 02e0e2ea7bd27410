// A chart as a table and as sentences.
#pragma once

#include <string>
#include <vector>

#include "chart/chart.h"
#include "record/table.h"

namespace palpate::chart {

// The smallest error that is ever claimed: linear interpolation between rows may add as much.
inline constexpr double comparison_error = 1e-4;

// The cost of a variant that takes as long as the time that it simulates, us per simulated ms.
inline constexpr double real_time_cost = 1000.0;

// The comparison of the rows of a case. Costs are medians, errors the largest over the loading
// history, but at least `floor`. Rows are given by index.
struct Verdict {
  double floor = 0.0;              // the smallest error that is claimed, relative
  std::vector<double> cost;        // us per simulated ms, by row; 0 if it was not measured
  std::vector<double> error;       // claimed, by row; 0 if it was not measured
  std::vector<std::size_t> front;  // rows of the Pareto front, by rising cost
  std::optional<std::size_t> knee;
  std::optional<std::size_t> taken;            // the choice of `auto`
  std::optional<std::size_t> cheapest_within;  // the cheapest row within the tolerance
  std::optional<std::size_t> nearest;          // least error; of equal ones the cheapest
};
[[nodiscard]] Verdict judge(const CaseChart& chart);

// chart.csv, one row per variant: case, group, variant, its resolved choices, status, errors
// (relative to the largest value of the reference), the error of the reference, costs with their
// spread, flags (front, knee, `auto`, within tolerance), settings and note. Columns: docs/speed.md.
[[nodiscard]] record::Table chart_table(const std::vector<CaseChart>& charts);

// chart.md: the findings of each case in markdown.
[[nodiscard]] std::string chart_text(const std::vector<CaseChart>& charts);

// `--set "key=value" ...`, quoted for a shell; `as the scenario stands` for none.
[[nodiscard]] std::string set_line(const std::vector<std::string>& settings);

}  // namespace palpate::chart
