// What an output's variance comes from: Sobol indices, and rank correlations where there are none.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "record/table.h"
#include "study/sweep_columns.h"

namespace palpate::study {

// A share of the variance; the ends of its 95 % interval are no numbers where it is exact.
struct Share {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};

struct Indices {
  Share first;  // S_i = V[E(y | x_i)] / V(y): what the factor does by itself
  Share total;  // S_Ti = E[V(y | x_~i)] / V(y): with all its interactions
};

struct BootstrapOptions {
  std::size_t resamples = 1000;
  unsigned long long seed = 1;
};

// Of a Saltelli design's outputs: blocks of `factors` + 2, in each A, B, then A with one factor
// from B; every value a number, two blocks at least. First order by Saltelli and others 2010,
// Comput. Phys. Commun. 181, 259, table 2 (b), of outputs less their mean; total by Jansen 1999,
// Comput. Phys. Commun. 117, 35. Intervals: percentiles of resampled blocks, which for points of
// a Sobol sequence are rather too wide. Values that do not vary give no numbers.
[[nodiscard]] std::vector<Indices> saltelli_indices(std::span<const double> values,
                                                    std::size_t factors,
                                                    const BootstrapOptions& options = {});

// Of a full grid's outputs, the last factor varying fastest: the exact shares of the variance over
// its points, each level of a factor weighing the same. Every value a number.
[[nodiscard]] std::vector<Indices> grid_indices(std::span<const double> values,
                                                std::span<const std::size_t> levels);

// Spearman's correlation of two columns of one length over the rows where both are numbers, ties
// at their mean rank; no number where one of them does not vary.
[[nodiscard]] double rank_correlation(std::span<const double> x, std::span<const double> y);

struct SensitivityRow {
  std::string output = {};
  std::string factor = {};
  Indices indices = {};
  std::size_t samples = 0;  // blocks, or points of the grid
};

struct CorrelationRow {
  std::string output = {};
  std::string factor = {};
  double correlation = 0.0;
  std::size_t cases = 0;
};

// What the design of a sweep allows: indices of `saltelli` and of a full grid, rank correlations
// of numbers in the others.
struct Sensitivity {
  std::vector<SensitivityRow> indices = {};
  std::vector<CorrelationRow> correlations = {};
  std::vector<std::string> notes = {};  // sentences: what was left out, what cannot be had
};
[[nodiscard]] Sensitivity sensitivity(const SweepColumns& columns,
                                      const BootstrapOptions& options = {});

// sensitivity.csv: output, factor, first_order, first_order_low, first_order_high, total,
// total_low, total_high, samples; and correlation.csv: output, factor, rank_correlation, cases.
[[nodiscard]] record::Table sensitivity_table(const Sensitivity& found);
[[nodiscard]] record::Table correlation_table(const Sensitivity& found);

}  // namespace palpate::study
