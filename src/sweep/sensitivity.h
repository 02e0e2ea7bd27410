// Sensitivity of the outputs to the factors: Sobol indices, else rank correlations.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "record/table.h"
#include "sweep/columns.h"

namespace palpate::sweep {

// A share of the variance with its 95 % interval; the ends are NaN if the share is exact.
struct Share {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};

struct Indices {
  Share first;  // S_i = V[E(y | x_i)] / V(y): the factor alone
  Share total;  // S_Ti = E[V(y | x_~i)] / V(y): the factor with all its interactions
};

struct BootstrapOptions {
  std::size_t resamples = 1000;
  unsigned long long seed = 1;
};

// Indices of one output of a Saltelli design, one per factor. `values`: at least two blocks of
// `factors` + 2 finite numbers, in each A, B, then A with one factor after the other from B. First
// order by Saltelli and others 2010, Comput. Phys. Commun. 181, 259, table 2 (b), of outputs minus
// their mean; total by Jansen 1999, Comput. Phys. Commun. 117, 35. Intervals are percentiles of
// resampled blocks, somewhat too wide for a Sobol sequence. NaN if the values do not vary.
//                                                       docs/theory.md [first_index], [total_index]
[[nodiscard]] std::vector<Indices> saltelli_indices(std::span<const double> values,
                                                    std::size_t factors,
                                                    const BootstrapOptions& options = {});

// Indices of one output of a full grid, one per factor: exact shares of the variance over its
// points, all levels weighted equally. `values`: finite numbers, the last factor varies fastest.
[[nodiscard]] std::vector<Indices> grid_indices(std::span<const double> values,
                                                std::span<const std::size_t> levels);

// Spearman's rank correlation of two columns of the same length over the rows in which both are
// finite; equal values get their mean rank. NaN if one of the columns does not vary.
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

// Indices for a Saltelli design and a full grid; otherwise rank correlations of numeric factors.
struct Sensitivity {
  std::vector<SensitivityRow> indices = {};
  std::vector<CorrelationRow> correlations = {};
  std::vector<std::string> notes = {};  // sentences on cases excluded and indices not computed
};
[[nodiscard]] Sensitivity sensitivity(const SweepColumns& columns,
                                      const BootstrapOptions& options = {});

// sensitivity.csv: output, factor, first_order, first_order_low, first_order_high, total,
// total_low, total_high, samples; and correlation.csv: output, factor, rank_correlation, cases.
[[nodiscard]] record::Table sensitivity_table(const Sensitivity& found);
[[nodiscard]] record::Table correlation_table(const Sensitivity& found);

}  // namespace palpate::sweep
