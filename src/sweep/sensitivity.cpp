// Chooses indices or rank correlations by the design of a sweep, and makes their tables.
#include "sweep/sensitivity.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "base/index.h"
#include "base/text.h"

namespace palpate::sweep {
namespace {

bool all_numbers(std::span<const double> values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
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
    note(found, output.name,
         std::to_string(blocks - whole) + " of " + std::to_string(blocks) + " blocks of " +
             std::to_string(block) +
             " cases are excluded, because one of their cases failed or is missing; if that "
             "depends on the factors, the indices are biased");
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
      output.values.size() -
      as_index(std::ranges::count_if(output.values, [](double v) { return std::isfinite(v); }));
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
  std::ranges::stable_sort(order,
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
    table.rows.push_back({row.output, row.factor, record::known(first.value),
                          record::known(first.low), record::known(first.high),
                          record::known(total.value), record::known(total.low),
                          record::known(total.high), static_cast<double>(row.samples)});
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

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr Share exactly(double value) { return {value, unknown, unknown}; }

double mean(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// The terms of each block in the sums of the estimators: two per factor, then two of A and B.
struct BlockSums {
  std::size_t factors = 0;
  std::vector<double> terms = {};  // block after block, width() numbers each

  [[nodiscard]] std::size_t width() const { return 2 * factors + 2; }
  [[nodiscard]] std::size_t blocks() const { return terms.size() / width(); }
};

BlockSums block_sums(std::span<const double> values, std::size_t factors) {
  BlockSums sums{factors, {}};
  const double centre = mean(values);
  for (std::size_t at = 0; at < values.size(); at += factors + 2) {
    const double a = values[at] - centre;
    const double b = values[at + 1] - centre;
    for (std::size_t f = 0; f < factors; ++f) {
      const double ab = values[at + 2 + f] - centre;
      sums.terms.push_back(b * (ab - a));
      sums.terms.push_back(0.5 * (a - ab) * (a - ab));
    }
    sums.terms.push_back(a + b);
    sums.terms.push_back(a * a + b * b);
  }
  return sums;
}

// S_i  = mean((f(B) - c) (f(A_B^i) - f(A))) / V           Saltelli 2010, table 2 (b)
// S_Ti = mean((f(A) - f(A_B^i))^2) / (2 V)                Jansen 1999
// V is the variance of A and B together, c the mean of all values; without c a large mean would
// dominate S_i.                                   docs/theory.md [first_index], [total_index]
struct Estimates {
  std::vector<double> first, total;
};
void estimate(std::span<const double> sum, std::size_t blocks, Estimates& out) {
  const double n = static_cast<double>(blocks);
  const double m = sum[sum.size() - 2] / (2.0 * n);
  const double variance = sum[sum.size() - 1] / (2.0 * n) - m * m;
  for (std::size_t f = 0; f < out.first.size(); ++f) {
    out.first[f] = sum[2 * f] / n / variance;
    out.total[f] = sum[2 * f + 1] / n / variance;
  }
}

// The ends of the middle 95 % of the numbers.
Share interval(double value, std::vector<double>& sample) {
  std::ranges::sort(sample);
  const auto at = [&](double share) {
    return sample[as_index(std::lround(share * static_cast<double>(sample.size() - 1)))];
  };
  return {value, at(0.025), at(0.975)};
}

}  // namespace

std::vector<Indices> saltelli_indices(std::span<const double> values, std::size_t factors,
                                      const BootstrapOptions& options) {
  const BlockSums sums = block_sums(values, factors);
  const std::size_t blocks = sums.blocks();
  const std::size_t width = sums.width();
  assert(blocks >= 2 && values.size() == blocks * (factors + 2));
  const auto add_block = [&](std::size_t block, std::vector<double>& sum) {
    const double* const terms = sums.terms.data() + block * width;
    for (std::size_t k = 0; k < width; ++k) sum[k] += terms[k];
  };
  const auto [least, most] = std::ranges::minmax_element(values);
  if (*least == *most) return std::vector<Indices>(factors, {exactly(unknown), exactly(unknown)});

  std::vector<double> sum(width, 0.0);
  for (std::size_t j = 0; j < blocks; ++j) add_block(j, sum);
  Estimates of_all{std::vector<double>(factors), std::vector<double>(factors)};
  estimate(sum, blocks, of_all);

  std::vector<std::vector<double>> first(factors), total(factors);
  std::mt19937_64 generator(options.seed);
  Estimates resampled = of_all;
  for (std::size_t r = 0; r < options.resamples; ++r) {
    std::ranges::fill(sum, 0.0);
    // The remainder's bias towards small numbers is below blocks / 2^64.
    for (std::size_t j = 0; j < blocks; ++j) add_block(generator() % blocks, sum);
    estimate(sum, blocks, resampled);
    for (std::size_t f = 0; f < factors; ++f) {
      if (std::isfinite(resampled.first[f])) first[f].push_back(resampled.first[f]);
      if (std::isfinite(resampled.total[f])) total[f].push_back(resampled.total[f]);
    }
  }
  std::vector<Indices> indices;
  for (std::size_t f = 0; f < factors; ++f)
    indices.push_back(
        {first[f].empty() ? exactly(of_all.first[f]) : interval(of_all.first[f], first[f]),
         total[f].empty() ? exactly(of_all.total[f]) : interval(of_all.total[f], total[f])});
  return indices;
}

std::vector<Indices> grid_indices(std::span<const double> values,
                                  std::span<const std::size_t> levels) {
  const double centre = mean(values);
  const double n = static_cast<double>(values.size());
  double variance = 0.0;
  for (const double value : values) variance += (value - centre) * (value - centre) / n;
  std::vector<Indices> indices;
  std::size_t stride = values.size();  // distance of the factor's levels
  for (const std::size_t count : levels) {
    stride /= count;
    const double c = static_cast<double>(count);
    std::vector<double> of_level(count, 0.0);
    double within = 0.0;  // mean over the other factors of the variance along this one
    for (std::size_t start = 0; start < values.size(); start += stride * count)
      for (std::size_t at = start; at < start + stride; ++at) {
        double sum = 0.0;
        for (std::size_t l = 0; l < count; ++l) {
          const double value = values[at + l * stride] - centre;
          of_level[l] += value * c / n;
          sum += value;
        }
        for (std::size_t l = 0; l < count; ++l) {
          const double off = values[at + l * stride] - centre - sum / c;
          within += off * off / n;
        }
      }
    double between = 0.0;
    for (const double level : of_level) between += level * level / c;
    indices.push_back({exactly(between / variance), exactly(within / variance)});
  }
  return indices;
}

}  // namespace palpate::sweep
