// A chart as a table, and as sentences that a person can act on.
#pragma once

#include <string>
#include <vector>

#include "record/table.h"
#include "study/chart.h"

namespace palpate::study {

// No error smaller than this is claimed, whatever the reference: what straight lines between rows
// may add.
inline constexpr double comparison_error = 1e-4;

// What of a case's rows is worth taking. Costs are medians, errors the greatest ones over the
// programme, none of them smaller than the reference's own.
struct Verdict {
  double floor = 0.0;                // the least error that is claimed
  std::vector<double> cost;          // us a simulated ms, by row; 0 where it was not measured
  std::vector<double> error;         // claimed, by row; 0 likewise
  std::vector<std::size_t> front;    // rows, by rising cost
  std::optional<std::size_t> knee;   // a row
  std::optional<std::size_t> taken;  // by `auto`, a row
  std::optional<std::size_t> cheapest_within;  // the tolerance
  std::optional<std::size_t> nearest;          // the least error; of equal ones the cheapest
};
[[nodiscard]] Verdict judge(const CaseChart& chart);

// chart.csv, one row a variant: case, group, variant, what it settled on, status, errors (ratios of
// the reference's greatest value), the reference's own, costs with their spread, what it is worth,
// and the settings and remarks in words.
[[nodiscard]] record::Table chart_table(const std::vector<CaseChart>& charts);

// chart.md: what each case's chart says, in markdown.
[[nodiscard]] std::string chart_text(const std::vector<CaseChart>& charts);

// `--set "key=value" ...`, as a shell takes it; `as the scenario stands` for none.
[[nodiscard]] std::string set_line(const std::vector<std::string>& settings);

}  // namespace palpate::study
