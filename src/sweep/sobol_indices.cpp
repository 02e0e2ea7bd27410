// The estimators of Sobol indices and their bootstrap; the exact shares of a grid.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <random>

#include "base/index.h"
#include "sweep/sensitivity.h"

namespace palpate::sweep {
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
  std::sort(sample.begin(), sample.end());
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
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (*least == *most) return std::vector<Indices>(factors, {exactly(unknown), exactly(unknown)});

  std::vector<double> sum(width, 0.0);
  for (std::size_t j = 0; j < blocks; ++j) add_block(j, sum);
  Estimates of_all{std::vector<double>(factors), std::vector<double>(factors)};
  estimate(sum, blocks, of_all);

  std::vector<std::vector<double>> first(factors), total(factors);
  std::mt19937_64 generator(options.seed);
  Estimates resampled = of_all;
  for (std::size_t r = 0; r < options.resamples; ++r) {
    std::fill(sum.begin(), sum.end(), 0.0);
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
