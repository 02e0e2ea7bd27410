// The likelihood needs three products of the data with themselves, whatever the correlation.
#include "fit/correlated.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>

#include "base/index.h"
#include "base/numerics.h"

namespace palpate::fit {
namespace {

using Matrix = Eigen::MatrixXd;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double largest_rho = 0.999;

// Products of the rows v_i of [J e], with each column scaled to order one.
struct Products {
  Matrix all;    // sum over i = 1..n of v_i v_i^T
  Matrix next;   // sum over i = 2..n of v_i v_(i-1)^T + v_(i-1) v_i^T
  Matrix inner;  // sum over i = 2..n-1 of v_i v_i^T

  // Of the whitened rows sqrt(1-rho^2) v_1 and v_i - rho v_(i-1).
  [[nodiscard]] Matrix whitened(double rho) const { return all - rho * next + rho * rho * inner; }
};

Products products_of(const Rows& rows) {
  const Eigen::Index n = rows.rows();
  Products made;
  made.all = rows.transpose() * rows;
  const Matrix cross = rows.bottomRows(n - 1).transpose() * rows.topRows(n - 1);
  made.next = cross + cross.transpose();
  made.inner = rows.middleRows(1, n - 2).transpose() * rows.middleRows(1, n - 2);
  return made;
}

// -2 log of the restricted likelihood, without constants, and the variance of the innovations:
// (n-p) log s^2 + log |Jw^T Jw| - log(1-rho^2),  s^2 = |ew - Jw b|^2 / (n-p)
struct Likelihood {
  double minus_two_log = std::numeric_limits<double>::infinity();
  double variance = 0.0;
};
Likelihood likelihood(const Products& products, double rho, double degrees) {
  const Matrix whitened = products.whitened(rho);
  const Eigen::Index p = whitened.rows() - 1;
  const Eigen::LDLT<Matrix> normal(whitened.topLeftCorner(p, p));
  if (normal.info() != Eigen::Success || !(normal.vectorD().minCoeff() > 0.0)) return {};
  const Eigen::VectorXd product = whitened.topRightCorner(p, 1);
  const double squares = whitened(p, p) - product.dot(normal.solve(product));
  if (!(squares > 0.0)) return {};
  return {degrees * std::log(squares / degrees) + normal.vectorD().array().log().sum() -
              std::log(1.0 - rho * rho),
          squares / degrees};
}

// The rho in [0, largest_rho] of the smallest value: the best of a grid, then Brent's method.
double best_rho(const Products& products, double degrees) {
  const auto at = [&](double rho) { return likelihood(products, rho, degrees).minus_two_log; };
  constexpr int steps = 100;
  const auto place = [](double i) {
    return largest_rho * std::sin(0.5 * std::numbers::pi * i / steps);
  };
  int best = 0;
  double least = at(0.0);
  for (int i = 1; i <= steps; ++i)
    if (const double value = at(place(i)); value < least) {
      least = value;
      best = i;
    }
  return numerics::minimum({place(std::max(best - 1, 0)), place(std::min(best + 1, steps))}, at);
}

// S = J^T C J with C_ij = rho^|i-j|, by a sum forwards and a sum backwards.
Matrix correlated_product(const Rows& rows, Eigen::Index p, double rho) {
  const Eigen::Index n = rows.rows();
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(p);
  Matrix product = Matrix::Zero(p, p);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto row = rows.row(i).head(p);
    product +=
        row.transpose() * row + row.transpose() * (rho * sum) + (rho * sum).transpose() * row;
    sum = row + rho * sum;
  }
  return product;
}

// sum_j x_j e^(-2 pi i jk/N), in place; N is a power of two.      Cooley and Tukey 1965
void transform(std::vector<std::complex<double>>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1U;
    for (; (j & bit) != 0; bit >>= 1U) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t length = 2; length <= n; length *= 2) {
    const std::complex<double> turn =
        std::polar(1.0, -2.0 * std::numbers::pi / static_cast<double>(length));
    for (std::size_t i = 0; i < n; i += length) {
      std::complex<double> at = 1.0;
      for (std::size_t k = 0; k < length / 2; ++k, at *= turn) {
        const auto even = x[i + k];
        const auto odd = at * x[i + k + length / 2];
        x[i + k] = even + odd;
        x[i + k + length / 2] = even - odd;
      }
    }
  }
}

std::vector<std::complex<double>> padded(const Eigen::VectorXd& values, std::size_t size) {
  std::vector<std::complex<double>> all(size);
  for (Eigen::Index i = 0; i < values.size(); ++i) all[as_index(i)] = values[i];
  transform(all);
  return all;
}

// Bands of frequency that grow by a twentieth, of the bins `from` to `to` of `spacing` each.
struct Bands {
  std::vector<std::vector<std::size_t>> bins;
  std::vector<double> f;  // mean frequency, cycles per row

  Bands(std::size_t from, std::size_t to, double spacing) {
    double next = 0.0;
    for (std::size_t k = from; k <= to; ++k) {
      const auto at = static_cast<double>(k);
      if (bins.empty() || at >= next) {
        bins.emplace_back();
        next = std::max(at + 1.0, 1.05 * at);
      }
      bins.back().push_back(k);
    }
    for (const auto& band : bins)
      f.push_back(0.5 * spacing * static_cast<double>(band.front() + band.back()));
  }
};

// Sums over the bins of each band of Re(X_k X_l^*), X the transforms of the columns.
std::vector<Matrix> products_in(const Bands& bands, const Matrix& columns, std::size_t size,
                                const std::function<double(std::size_t)>& weight,
                                const std::function<std::size_t(std::size_t)>& place) {
  std::vector<std::vector<std::complex<double>>> waves;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) waves.push_back(padded(columns.col(k), size));
  std::vector<Matrix> sums;
  for (const auto& band : bands.bins) {
    Matrix& sum = sums.emplace_back(Matrix::Zero(columns.cols(), columns.cols()));
    for (const std::size_t bin : band)
      for (Eigen::Index i = 0; i < sum.rows(); ++i)
        for (Eigen::Index j = 0; j < sum.cols(); ++j)
          sum(i, j) +=
              weight(bin) *
              (waves[as_index(i)][place(bin)] * std::conj(waves[as_index(j)][place(bin)])).real();
  }
  return sums;
}

// The covariance of the estimates under a spectrum S(f) = s (1 + (c/f)^a), the mean over the
// corners c and powers a of a grid, each by its likelihood.
struct Flicker {
  Matrix covariance;         // of the estimates
  double lowest = 0.0;       // S at one cycle in all rows
  double degrees = 0.0;      // of freedom of the variances
  double probability = 0.0;  // of this spectrum, against that of the first-order process
};

// Whittle's likelihood of the residuals' periodogram. The fit has taken its part of the low
// frequencies: with Q an orthonormal basis of the jacobian, the expected periodogram is
//   S(f) (1 - 2 |Q(f)|^2 / n) + Q(f)^* A Q(f) / n,  A = int S(g) Q(g) Q(g)^* dg.
//                                                                             docs/theory.md (118)
Flicker flicker_of(const Rows& rows, Eigen::Index p, const Matrix& inverse, double rho) {
  const auto n = static_cast<double>(rows.rows());
  std::size_t size = 1;
  while (size < 2 * as_index(rows.rows())) size *= 2;
  const auto spacing = 1.0 / static_cast<double>(size);
  const Matrix jacobian = rows.leftCols(p);
  const Matrix basis =
      Eigen::HouseholderQR<Matrix>(jacobian).householderQ() * Matrix::Identity(rows.rows(), p);
  Matrix all(rows.rows(), 2 * p);
  all << basis, jacobian * inverse;

  // Over all frequencies, of which the upper half mirrors the lower one.
  Bands whole(0, size / 2, spacing);
  whole.f.front() = 0.5 / n;
  const auto mirrored = [&](std::size_t bin) { return bin == 0 || 2 * bin == size ? 1.0 : 2.0; };
  const std::vector<Matrix> integrals =
      products_in(whole, all, size, mirrored, [](std::size_t bin) { return bin; });

  // At the frequencies of the periodogram, 1/n apart.
  const Bands bands(1, as_index((rows.rows() - 1) / 2), 1.0 / n);
  const auto place = [&](std::size_t bin) {
    return static_cast<std::size_t>(
        std::lround(static_cast<double>(bin) / n * static_cast<double>(size)));
  };
  const auto once = [](std::size_t) { return 1.0; };
  const std::vector<Matrix> taken = products_in(bands, basis, size, once, place);
  const std::vector<Matrix> powers = products_in(bands, rows.col(p), size, once, place);

  // -log L of a shape, with its level.
  const auto fitted = [&](const auto& shape_at) {
    Matrix inner = Matrix::Zero(p, p);
    for (std::size_t b = 0; b < whole.f.size(); ++b)
      inner += shape_at(whole.f[b]) * spacing * integrals[b].topLeftCorner(p, p);
    double level = 0.0;
    double logs = 0.0;
    double total = 0.0;
    for (std::size_t b = 0; b < bands.f.size(); ++b) {
      const auto count = static_cast<double>(bands.bins[b].size());
      const double shape = shape_at(bands.f[b]);
      const double expected = std::max(shape * (count - 2.0 * taken[b].trace() / n) +
                                           taken[b].cwiseProduct(inner).sum() / n,
                                       1e-3 * shape * count) /
                              count;
      level += powers[b](0, 0) / n / expected;
      logs += count * std::log(expected);
      total += count;
    }
    return std::pair{total * std::log(level / total) + logs, level / total};
  };
  const double first_order =
      fitted([&](double at) {
        return 1.0 / (1.0 - 2.0 * rho * std::cos(2.0 * std::numbers::pi * at) + rho * rho);
      }).first;
  struct Shape {
    double corner, power, minus_log, level;
    [[nodiscard]] double at(double f) const { return level * (1.0 + std::pow(corner / f, power)); }
  };
  std::vector<Shape> shapes;
  double least = std::numeric_limits<double>::infinity();
  for (const double power : {0.5, 0.75, 1.0, 1.25, 1.5, 2.0})
    for (int k = 0; k <= 30; ++k) {
      const double corner = std::pow(10.0, -4.0 + 0.2 * k);
      const auto [value, level] =
          fitted([&](double at) { return 1.0 + std::pow(corner / at, power); });
      shapes.push_back({corner, power, value, level});
      least = std::min(least, value);
    }
  Flicker found{.covariance = Matrix::Zero(p, p)};
  // Both have few parameters, so that their largest likelihoods decide.
  found.probability = 1.0 / (1.0 + std::exp(std::min(least - first_order, 700.0)));
  std::vector<double> mean(whole.f.size(), 0.0);  // S in the bands
  double sum = 0.0;
  for (const Shape& shape : shapes) {
    const double weight = std::exp(least - shape.minus_log);
    if (!(weight > 1e-4)) continue;
    sum += weight;
    found.lowest += weight * shape.at(1.0 / n);
    for (std::size_t b = 0; b < whole.f.size(); ++b) mean[b] += weight * shape.at(whole.f[b]);
  }
  found.lowest /= sum;
  // Degrees of freedom by Satterthwaite 1946: 2 (sum v)^2 / sum (v^2 / m), v the part of a variance
  // that comes from m ordinates of the periodogram, each a chi-squared number with two.
  std::vector<Eigen::VectorXd> parts;
  std::vector<double> ordinates;
  double filled = 1.0;
  for (std::size_t b = 0; b < whole.f.size(); ++b) {
    const Matrix part = mean[b] / sum * spacing * integrals[b].bottomRightCorner(p, p);
    found.covariance += part;
    const double width = static_cast<double>(whole.bins[b].size()) * spacing * n;
    if (filled >= 1.0) {  // the last group has an ordinate
      parts.emplace_back(Eigen::VectorXd::Zero(p));
      ordinates.push_back(0.0);
      filled = 0.0;
    }
    parts.back() += part.diagonal();
    ordinates.back() += width;
    filled += width;
  }
  Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(p);
  for (std::size_t k = 0; k < parts.size(); ++k)
    squares += parts[k].array().square() / std::max(ordinates[k], 1.0);
  found.degrees = (2.0 * found.covariance.diagonal().array().square() / squares).minCoeff();
  return found;
}

}  // namespace

std::vector<double> quantised_covariance(std::span<const double> values,
                                         std::span<const double> jacobian,
                                         std::span<const double> inverse) {
  const std::size_t n = values.size();
  const std::size_t p = n == 0 ? 0 : jacobian.size() / n;
  if (n < 20 || inverse.size() != p * p) return {};
  std::vector<double> levels(values.begin(), values.end());
  std::sort(levels.begin(), levels.end());
  const double slack = 1e-9 * std::max(std::abs(levels.front()), std::abs(levels.back()));
  double step = std::numeric_limits<double>::infinity();
  std::size_t count = 1;
  for (std::size_t i = 1; i < n; ++i)
    if (const double gap = levels[i] - levels[i - 1]; gap > slack) {
      step = std::min(step, gap);
      ++count;
    }
  if (count < 2 || 2 * count > n) return {};
  for (std::size_t i = 1; i < n; ++i) {
    const double steps = (levels[i] - levels[i - 1]) / step;
    if (std::abs(steps - std::round(steps)) > 0.05 * std::max(1.0, steps)) return {};
  }
  const Eigen::Map<const Rows> normal(inverse.data(), static_cast<Eigen::Index>(p),
                                      static_cast<Eigen::Index>(p));
  Matrix sum = Matrix::Zero(normal.rows(), normal.cols());
  for (std::size_t i = 0; i < n;) {
    Eigen::VectorXd run = Eigen::VectorXd::Zero(normal.rows());
    const std::size_t first = i;
    for (; i < n && std::abs(values[i] - values[first]) <= slack; ++i)
      for (std::size_t k = 0; k < p; ++k) run[static_cast<Eigen::Index>(k)] += jacobian[i * p + k];
    sum += run * run.transpose();
  }
  const Rows covariance = step * step / 12.0 * normal * sum * normal;
  return {covariance.data(), covariance.data() + covariance.size()};
}

std::optional<Autocorrelation> autocorrelation(std::span<const double> residuals,
                                               std::span<const double> jacobian,
                                               std::size_t unknowns) {
  const auto n = static_cast<Eigen::Index>(residuals.size());
  const auto p = static_cast<Eigen::Index>(unknowns);
  if (n < 20 || n <= 2 * p + 2 || jacobian.size() != residuals.size() * unknowns)
    return std::nullopt;
  Rows rows(n, p + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < p; ++k) rows(i, k) = jacobian[as_index(i * p + k)];
    rows(i, p) = residuals[as_index(i)];
  }
  const Eigen::RowVectorXd scale = rows.colwise().norm();
  if (!(scale.minCoeff() > 0.0) || !scale.allFinite()) return std::nullopt;
  rows.array().rowwise() /= scale.array();

  const Products products = products_of(rows);
  const auto degrees = static_cast<double>(n - p);
  Autocorrelation found;
  found.rho = best_rho(products, degrees);
  const Likelihood at = likelihood(products, found.rho, degrees);
  const Likelihood white = likelihood(products, 0.0, degrees);
  if (!(white.minus_two_log - at.minus_two_log > 2.71)) return std::nullopt;

  const Eigen::LDLT<Matrix> normal(products.all.topLeftCorner(p, p));
  if (normal.info() != Eigen::Success || !(normal.vectorD().minCoeff() > 0.0)) return std::nullopt;
  const Matrix inverse = normal.solve(Matrix::Identity(p, p));
  const double rho = found.rho;
  // Residuals of a law that does not fit look like a walk, whose variance has no limit: the scatter
  // that is there, with some allowance for what the fit takes away, is the most that is taken.
  const double scatter = rows.col(p).squaredNorm() / degrees;
  const double variance =
      std::min(at.variance / (1.0 - rho * rho), 2.0 * scatter) * scale[p] * scale[p];
  Matrix sandwich = variance * (inverse * correlated_product(rows, p, rho) * inverse);
  // The variance of a mean depends on s^2 / (1-rho)^2, whose relative variance is
  // 2/n + 4 var(rho) / (1-rho)^2 with var(rho) = (1-rho^2) / n.
  found.degrees = std::max(4.0, degrees * (1.0 - rho) / (3.0 + rho));
  found.effective_size = static_cast<double>(n) * (1.0 - rho) / (1.0 + rho);

  // Fewer than 100 rows do not tell such a spectrum from chance.
  if (n >= 100) {
    Flicker flicker = flicker_of(rows, p, inverse, rho);
    flicker.covariance *= scale[p] * scale[p];
    const double wider =
        (flicker.covariance.diagonal().array() / sandwich.diagonal().array()).log().mean();
    if (wider > 0.0 && flicker.covariance.allFinite()) {
      const double part = flicker.probability;
      sandwich = (1.0 - part) * sandwich + part * flicker.covariance;
      found.effective_size = std::min(
          found.effective_size, 1.0 / ((1.0 - part) / found.effective_size +
                                       part * flicker.lowest / (static_cast<double>(n) * scatter)));
      found.degrees =
          std::min(found.degrees, 1.0 / ((1.0 - part) / found.degrees + part / flicker.degrees));
    }
  }
  found.covariance.resize(unknowns * unknowns);
  for (Eigen::Index i = 0; i < p; ++i)
    for (Eigen::Index k = 0; k < p; ++k)
      found.covariance[as_index(i * p + k)] = sandwich(i, k) / (scale[i] * scale[k]);
  return found;
}

}  // namespace palpate::fit
