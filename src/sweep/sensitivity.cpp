// Chooses indices or rank correlations by the design of a sweep, and makes their tables.
#include "sweep/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/index.h"
#include "base/text.h"

namespace palpate::sweep {
namespace {

bool all_numbers(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

// Adds a note; outputs with the same sentence share one note.
void note(Sensitivity& found, const std::string& output, const std::string& sentence) {
  for (std::string& known : found.notes) {
    if (!known.ends_with(": " + sentence)) continue;
    known.insert(known.size() - sentence.size() - 2, ", " + ticked(output));
    return;
  }
  found.notes.push_back("sensitivity of " + ticked(output) + ": " + sentence);
}

void saltelli(const SweepColumns& columns, const OutputColumn& output,
              const BootstrapOptions& options, Sensitivity& found) {
  const std::size_t factors = columns.factors.size();
  const std::size_t block = factors + 2;
  std::vector<double> kept;
  for (std::size_t at = 0; at + block <= output.values.size(); at += block) {
    const std::span<const double> values(output.values.data() + at, block);
    if (all_numbers(values)) kept.insert(kept.end(), values.begin(), values.end());
  }
  const std::size_t blocks = output.values.size() / block;
  const std::size_t whole = kept.size() / block;
  if (whole < blocks)
    note(
        found, output.name,
        std::to_string(blocks - whole) + " of " + std::to_string(blocks) + " blocks of " +
            std::to_string(block) +
            " cases are excluded, because one of their cases failed or is missing; if that depends "
            "on the factors, the indices are biased");
  if (whole < 2) {
    note(found, output.name, "at least two complete blocks are needed; run what is missing");
    return;
  }
  const std::vector<Indices> indices = saltelli_indices(kept, factors, options);
  for (std::size_t f = 0; f < factors; ++f)
    if (std::isfinite(indices[f].total.value))
      found.indices.push_back({output.name, columns.factors[f].choice.name, indices[f], whole});
}

void grid(const SweepColumns& columns, const OutputColumn& output, Sensitivity& found) {
  const auto gaps =
      output.values.size() - as_index(std::count_if(output.values.begin(), output.values.end(),
                                                    [](double v) { return std::isfinite(v); }));
  if (gaps > 0) {
    note(found, output.name,
         std::to_string(gaps) + " of " + std::to_string(output.values.size()) +
             " cases have no value, and the indices of a grid need all; run what is missing, "
             "narrow the ranges to where cases complete, or take `design = \"saltelli\"`");
    return;
  }
  std::vector<std::size_t> levels;
  for (const FactorColumn& factor : columns.factors) levels.push_back(factor.choice.levels);
  const std::vector<Indices> indices = grid_indices(output.values, levels);
  for (std::size_t f = 0; f < levels.size(); ++f)
    found.indices.push_back(
        {output.name, columns.factors[f].choice.name, indices[f], output.values.size()});
}

// Ranks from 1; equal values get the mean of their ranks.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> rank(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t k = i; k < end; ++k) rank[order[k]] = 0.5 * static_cast<double>(i + 1 + end);
    i = end;
  }
  return rank;
}

void correlations(const SweepColumns& columns, const OutputColumn& output, Sensitivity& found) {
  for (const FactorColumn& factor : columns.factors) {
    if (!factor.is_number()) continue;
    std::size_t cases = 0;
    for (std::size_t i = 0; i < output.values.size(); ++i)
      if (std::isfinite(output.values[i]) && std::isfinite(factor.values[i])) ++cases;
    const double correlation = rank_correlation(factor.values, output.values);
    if (std::isfinite(correlation))
      found.correlations.push_back({output.name, factor.choice.name, correlation, cases});
  }
}

record::Cell cell_of(double value) {
  if (std::isnan(value)) return {};
  return value;
}

}  // namespace

double rank_correlation(std::span<const double> x, std::span<const double> y) {
  std::vector<double> a, b;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    a.push_back(x[i]);
    b.push_back(y[i]);
  }
  a = ranks(a);
  b = ranks(b);
  const double middle = 0.5 * (static_cast<double>(a.size()) + 1.0);
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    xx += (a[i] - middle) * (a[i] - middle);
    yy += (b[i] - middle) * (b[i] - middle);
    xy += (a[i] - middle) * (b[i] - middle);
  }
  if (xx == 0.0 || yy == 0.0) return std::numeric_limits<double>::quiet_NaN();
  return xy / std::sqrt(xx * yy);
}

Sensitivity sensitivity(const SweepColumns& columns, const BootstrapOptions& options) {
  Sensitivity found;
  const bool has_indices = columns.kind == DesignKind::saltelli || columns.kind == DesignKind::grid;
  for (const OutputColumn& output : columns.outputs) {
    if (columns.kind == DesignKind::saltelli)
      saltelli(columns, output, options, found);
    else if (columns.kind == DesignKind::grid)
      grid(columns, output, found);
    else
      correlations(columns, output, found);
  }
  if (!has_indices && !columns.outputs.empty())
    found.notes.push_back(
        "this design gives no Sobol indices, only rank correlations: `design = \"saltelli\"` gives "
        "indices with intervals, a full `grid` exact ones over its points");
  return found;
}

record::Table sensitivity_table(const Sensitivity& found) {
  record::Table table;
  table.columns = {"output", "factor",    "first_order", "first_order_low", "first_order_high",
                   "total",  "total_low", "total_high",  "samples"};
  for (const SensitivityRow& row : found.indices) {
    const Share& first = row.indices.first;
    const Share& total = row.indices.total;
    table.rows.push_back({row.output, row.factor, cell_of(first.value), cell_of(first.low),
                          cell_of(first.high), cell_of(total.value), cell_of(total.low),
                          cell_of(total.high), static_cast<double>(row.samples)});
  }
  return table;
}

record::Table correlation_table(const Sensitivity& found) {
  record::Table table;
  table.columns = {"output", "factor", "rank_correlation", "cases"};
  for (const CorrelationRow& row : found.correlations)
    table.rows.push_back({row.output, row.factor, row.correlation, static_cast<double>(row.cases)});
  return table;
}

}  // namespace palpate::sweep
