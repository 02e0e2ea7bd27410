// A chart as a table and as sentences.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "chart/chart.h"
#include "plot/gnuplot.h"
#include "record/table.h"

namespace palpate::chart {

// One choice. It is excluded unless both numbers are positive and finite.
struct Tradeoff {
  double cost = 0.0;
  double error = 0.0;
};

// The indices of the choices for which no other choice is both cheaper and at least as accurate, or
// more accurate and at most as expensive; by rising cost, hence falling error. First of equals.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const Tradeoff> all);

// The index (0: the cheapest) of the choice of `front`, by rising cost, that lies farthest below
// the chord between its first and last choice, in logarithms of cost and error. Before the knee a
// little cost buys much accuracy, after it much cost buys little. The result does not depend on
// units, because scaling the axes keeps the order of the distances from a chord. Nothing if the
// front has fewer than three choices or none below the chord. docs/theory.md [knee]
[[nodiscard]] std::optional<std::size_t> knee(std::span<const Tradeoff> front);

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

// Its sentences for a page.
struct ChartSentences {
  std::string reference, result;
  std::string settings = {};           // the result below a headline that has its configuration
  std::vector<std::string> more = {};  // the knee, what runs in real time, time integration
};
[[nodiscard]] ChartSentences chart_sentences(const CaseChart& chart);

// `--set "key=value" ...`, quoted for a shell; `as the scenario stands` for none.
[[nodiscard]] std::string set_line(const std::vector<std::string>& settings);

// The figure NAME of a case, over the rows of chart.csv beside it, log-log: cost in us per
// simulated ms against error in percent, with the spread of the timings, the Pareto front, its
// knee, the choice of `auto`, real time, the tolerance, and the error of the reference. One colour
// per model, one marker per integrator. Nothing if no configuration could be compared.
[[nodiscard]] std::optional<plot::Sheet> scatter_sheet(const CaseChart& chart,
                                                       const std::string& name,
                                                       const std::string& title);

}  // namespace palpate::chart
