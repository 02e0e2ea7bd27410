// The likelihood needs three products of the data with themselves, whatever the correlation.
#include "fit/residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/index.h"
#include "base/numerics.h"
#include "base/text.h"

namespace palpate::fit {
namespace {

using dense::Matrix;
using dense::Rows;

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
  made.all = dense::inner_product(rows, rows);
  const Matrix cross = dense::inner_product(rows.bottomRows(n - 1), rows.topRows(n - 1));
  made.next = cross + cross.transpose();
  made.inner = dense::inner_product(rows.middleRows(1, n - 2), rows.middleRows(1, n - 2));
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
  const auto normal = dense::symmetric_factors(whitened.topLeftCorner(p, p));
  if (!normal) return {};
  const Eigen::VectorXd product = whitened.topRightCorner(p, 1);
  const double squares = whitened(p, p) - product.dot(normal->inverse * product);
  if (!(squares > 0.0)) return {};
  return {degrees * std::log(squares / degrees) + normal->pivots.array().log().sum() -
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

// What matters of the residuals are frequencies that the curve has, so that means of neighbours are
// judged: a law for all frequencies would be chosen by the fastest ones, which are the most.
constexpr Eigen::Index fewest_blocks = 100;
constexpr Eigen::Index most_blocks = 400;

// The autocovariances of the means, of m rows each, of a process whose rows correlate by
// exp(-lag / time).
Eigen::VectorXd decaying(Eigen::Index blocks, Eigen::Index m, double time) {
  const double rho = std::exp(-1.0 / time);
  Eigen::VectorXd powers(blocks * m + 1);
  for (Eigen::Index k = 0; k < powers.size(); ++k) powers[k] = k == 0 ? 1.0 : rho * powers[k - 1];
  Eigen::VectorXd found = Eigen::VectorXd::Zero(blocks);
  const auto rows = static_cast<double>(m);
  for (Eigen::Index k = 0; k < blocks; ++k)
    for (Eigen::Index l = 1 - m; l < m; ++l)
      found[k] +=
          (1.0 - static_cast<double>(std::abs(l)) / rows) / rows * powers[std::abs(k * m + l)];
  return found;
}

// The autocovariances of noise with the spectrum f^-power, which goes on for four octaves below the
// lowest frequency of the record.
Eigen::VectorXd flicker(Eigen::Index blocks, double power) {
  const Eigen::Index circle = 32 * blocks;  // lags repeat after so many
  const auto turn = [&](Eigen::Index i) {
    return 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(circle);
  };
  Eigen::VectorXd cosines(circle);
  for (Eigen::Index i = 0; i < circle; ++i) cosines[i] = std::cos(turn(i));
  Eigen::VectorXd found = Eigen::VectorXd::Zero(blocks);
  for (Eigen::Index j = 0; j <= circle / 2; ++j) {
    const double times = j == 0 || 2 * j == circle ? 1.0 : 2.0;
    const double spectrum =
        times * std::pow(static_cast<double>(std::max<Eigen::Index>(j, 2)), -power);
    for (Eigen::Index k = 0; k < blocks; ++k) found[k] += spectrum * cosines[j * k % circle];
  }
  return found;
}

// What the blocks say under one covariance of theirs.
struct Judged {
  double minus_two_log = 0.0;  // of the restricted likelihood
  double variance = 0.0;       // the factor of the covariance
};

// By Durbin's recursion for the predictions of each block from those before.   Durbin 1960
Judged judge(const Rows& rows, const Eigen::VectorXd& covariance) {
  const Eigen::Index n = rows.rows();
  const Eigen::Index p = rows.cols() - 1;
  Rows white(n, p + 1);
  white.row(0) = rows.row(0) / std::sqrt(covariance[0]);
  Eigen::VectorXd weights(0);  // of the blocks before, the first one first
  double left = covariance[0];
  double logs = std::log(left);
  for (Eigen::Index k = 1; k < n; ++k) {
    const double partial =
        (covariance[k] - (k > 1 ? weights.dot(covariance.segment(1, k - 1)) : 0.0)) / left;
    Eigen::VectorXd next(k);
    next[0] = partial;
    if (k > 1) next.tail(k - 1) = weights - partial * weights.reverse();
    weights = std::move(next);
    left *= 1.0 - partial * partial;
    logs += std::log(left);
    white.row(k) = (rows.row(k) - weights.transpose() * rows.topRows(k)) / std::sqrt(left);
  }
  const Matrix normal = dense::inner_product(white, white);
  const auto split = dense::symmetric_factors(normal.topLeftCorner(p, p));
  if (!split) return {};
  const Eigen::VectorXd product = normal.topRightCorner(p, 1);
  const auto degrees = static_cast<double>(n - p);
  const double variance =
      std::max(normal(p, p) - product.dot(split->inverse * product), 0.0) / degrees;
  return {degrees * std::log(variance) + logs + split->pivots.array().log().sum(), variance};
}

// The rows in blocks of as many neighbours each, give or take one: means, and sums of the first p
// columns.
struct Blocks {
  Rows means;
  Matrix sums;
  double kept = 0.0;  // the least share of the variance of an estimate under white noise

  Blocks(const Rows& rows, const Matrix& inverse, Eigen::Index count)
      : means(count, rows.cols()), sums(count, inverse.rows()) {
    for (Eigen::Index b = 0; b < count; ++b) {
      const Eigen::Index from = b * rows.rows() / count;
      const Eigen::Index to = (b + 1) * rows.rows() / count;
      means.row(b) = rows.middleRows(from, to - from).colwise().mean();
      sums.row(b) = means.row(b).head(sums.cols()) * static_cast<double>(to - from);
    }
    const Matrix variance =
        dense::product(dense::product(inverse, dense::inner_product(sums, sums)), inverse);
    kept = (variance.diagonal().array() / inverse.diagonal().array()).minCoeff() *
           static_cast<double>(count) / static_cast<double>(rows.rows());
  }
};

// As few blocks as keep what the estimates take from the rows.
Blocks blocks_of(const Rows& rows, const Matrix& inverse) {
  constexpr double enough = 0.95;
  Eigen::Index count = fewest_blocks;
  while (true) {
    Blocks blocks(rows, inverse, std::min(count, rows.rows()));
    if (blocks.kept >= enough || count >= std::min(most_blocks, rows.rows())) return blocks;
    count *= 2;
  }
}

// Shares of slow noise, and the logarithms of their weights before any residual is seen: Jeffreys's
// prior, the root of Fisher's information about the share, on the part of [0, 1] that is nearest to
// each. An even weight for each would count what cannot be told from white noise five times.
//                            I(g) = sum_j (u_j - mean u)^2 / 2,  u = d ln S / d g,  Whittle 1953
constexpr std::array shares{0.001, 0.003, 0.01, 0.03, 0.1, 0.25, 0.5, 0.75, 0.9, 0.97, 1.0};
std::array<double, shares.size()> share_weights(const Eigen::VectorXd& slow) {
  const Eigen::Index n = slow.size();
  Eigen::VectorXd spectrum(n / 2);  // of the slow noise, of variance 1, over that of white noise
  for (Eigen::Index j = 1; j <= n / 2; ++j) {
    double sum = 1.0;
    for (Eigen::Index k = 1; k < n; ++k)
      sum += 2.0 * (1.0 - static_cast<double>(k) / static_cast<double>(n)) * slow[k] / slow[0] *
             std::cos(2.0 * std::numbers::pi * static_cast<double>(j * k % n) /
                      static_cast<double>(n));
    spectrum[j - 1] = sum;
  }
  std::array<double, shares.size()> weights{};
  double all = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double low = i == 0 ? 0.0 : 0.5 * (shares[i - 1] + shares[i]);
    const double high = i + 1 == shares.size() ? 1.0 : 0.5 * (shares[i] + shares[i + 1]);
    const Eigen::ArrayXd slope =
        (spectrum.array() - 1.0) / (1.0 - shares[i] + shares[i] * spectrum.array());
    weights[i] = (high - low) * (slope - slope.mean()).matrix().norm();
    all += weights[i];
  }
  for (double& each : weights) each = std::log(each / all);
  return weights;
}

// A process that the residuals may be, with its weight among all.
struct Process {
  double weight = 0.0;
  Matrix covariance;  // of the estimates
};

// White noise plus noise that decays or flickers, in shares and times on logarithmic grids.
std::vector<Process> processes(const Blocks& blocks, const Matrix& inverse, Eigen::Index rows) {
  const Eigen::Index n = blocks.means.rows();
  std::vector<std::vector<Eigen::VectorXd>> families(2);
  const Eigen::Index each = (rows + n / 2) / n;
  for (double time = 0.5 * static_cast<double>(each); time <= static_cast<double>(rows);
       time *= 2.0)
    families[0].push_back(decaying(n, each, time));
  for (const double power : {0.5, 1.0, 1.5}) families[1].push_back(flicker(n, power));

  // sum over rows of one lag of J_i J_(i+lag)^T, and the same turned
  std::vector<Matrix> lagged;
  for (Eigen::Index lag = 0; lag < n; ++lag) {
    const Matrix product =
        dense::inner_product(blocks.sums.topRows(n - lag), blocks.sums.bottomRows(n - lag));
    lagged.push_back(lag == 0 ? product : Matrix(product + product.transpose()));
  }
  std::vector<Process> all;
  for (const auto& family : families)
    for (const Eigen::VectorXd& slow : family) {
      const auto weights = share_weights(slow);
      for (std::size_t i = 0; i < shares.size(); ++i) {
        Eigen::VectorXd covariance = shares[i] / slow[0] * slow;
        covariance[0] = 1.0;
        const Judged judged = judge(blocks.means, covariance);
        if (!std::isfinite(judged.minus_two_log)) continue;
        Process& one = all.emplace_back();
        // A family counts as much as the other.
        one.weight =
            weights[i] - 0.5 * judged.minus_two_log - std::log(static_cast<double>(family.size()));
        Matrix product = Matrix::Zero(inverse.rows(), inverse.cols());
        for (Eigen::Index lag = 0; lag < n; ++lag)
          product += covariance[lag] * lagged[as_index(lag)];
        one.covariance = judged.variance / blocks.kept *
                         dense::product(dense::product(inverse, product), inverse);
      }
    }
  double most = -std::numeric_limits<double>::infinity();
  for (const Process& one : all) most = std::max(most, one.weight);
  double sum = 0.0;
  for (Process& one : all) sum += one.weight = std::exp(one.weight - most);
  for (Process& one : all) one.weight /= sum;
  return all;
}

// The half width q that a Student variable of a variance drawn by the weights exceeds once in
// twenty: sum w P(|t| sqrt(v) > q) = 0.05.
double half_width(const std::vector<Process>& all, Eigen::Index i,
                  std::span<const double> students) {
  double most = 0.0;
  for (const Process& one : all) most = std::max(most, one.covariance(i, i));
  const auto exceeded = [&](double width) {
    double share = 0.0;
    for (const Process& one : all) {
      const double at = width / std::sqrt(one.covariance(i, i));
      const auto beyond = students.end() - std::ranges::upper_bound(students, at);
      share += one.weight * static_cast<double>(beyond) / static_cast<double>(students.size());
    }
    return share > 0.05;
  };
  return numerics::change({0.0, std::sqrt(most) * students.back()}, 1e-6, exceeded).middle();
}

// The covariance that rounding to steps adds: rows of one step in a row share one error, uniform
// over the step. Empty where the values are not multiples of a step, or differ from row to row.
//                                                                       docs/theory.md [rounding]
Matrix quantised_covariance(std::span<const double> values, const Rows& jacobian,
                            const Matrix& inverse) {
  const std::size_t n = values.size();
  if (n < 20) return {};
  std::vector<double> levels(values.begin(), values.end());
  std::ranges::sort(levels);
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
  Matrix sum = Matrix::Zero(inverse.rows(), inverse.cols());
  for (std::size_t i = 0; i < n;) {
    Eigen::VectorXd run = Eigen::VectorXd::Zero(inverse.rows());
    const std::size_t first = i;
    for (; i < n && std::abs(values[i] - values[first]) <= slack; ++i)
      run += jacobian.row(static_cast<Eigen::Index>(i)).transpose();
    sum += run * run.transpose();
  }
  return step * step / 12.0 * dense::product(dense::product(inverse, sum), inverse);
}

}  // namespace

std::optional<ResidualErrors> autocorrelation(std::span<const double> residuals,
                                              const Rows& jacobian) {
  const auto n = static_cast<Eigen::Index>(residuals.size());
  const Eigen::Index p = jacobian.cols();
  if (n < 20 || n <= 2 * p + 2) return std::nullopt;
  Rows rows(n, p + 1);
  rows << jacobian, Eigen::Map<const Eigen::VectorXd>(residuals.data(), n);
  const Eigen::RowVectorXd scale = rows.colwise().norm();
  if (!(scale.minCoeff() > 0.0) || !scale.allFinite()) return std::nullopt;
  rows.array().rowwise() /= scale.array();

  const Products products = products_of(rows);
  const auto degrees = static_cast<double>(n - p);
  ResidualErrors found;
  found.rho = best_rho(products, degrees);
  const Likelihood at = likelihood(products, found.rho, degrees);
  const Likelihood white = likelihood(products, 0.0, degrees);
  if (!(white.minus_two_log - at.minus_two_log > 2.71)) return std::nullopt;

  const auto normal = dense::symmetric_factors(products.all.topLeftCorner(p, p));
  if (!normal) return std::nullopt;
  const Matrix& inverse = normal->inverse;
  const Blocks blocks = blocks_of(rows, inverse);
  const std::vector<Process> all = processes(blocks, inverse, n);
  if (all.empty()) return std::nullopt;
  Matrix sandwich = Matrix::Zero(p, p);
  for (const Process& one : all) sandwich += one.weight * one.covariance;
  found.degrees = static_cast<double>(blocks.means.rows() - p);
  constexpr int levels = 400;
  std::vector<double> students;  // |t| at even probabilities
  for (int k = 0; k < levels; ++k)
    students.push_back(numerics::student_t_quantile(0.5 + (k + 0.5) / (2 * levels), found.degrees));
  const double t = numerics::student_t_quantile(0.975, found.degrees);
  Eigen::VectorXd wider(p);
  for (Eigen::Index i = 0; i < p; ++i)
    wider[i] = half_width(all, i, students) / (t * std::sqrt(sandwich(i, i))) * scale[p];
  sandwich = wider.asDiagonal() * sandwich * wider.asDiagonal();
  const Eigen::RowVectorXd own = scale.head(p);
  found.covariance = sandwich.array() / (own.transpose() * own).array();
  return found;
}

ResidualErrors errors_of(std::span<const double> residuals, const Rows& jacobian,
                         const Matrix& inverse, std::span<const std::span<const double>> records) {
  const Eigen::Index p = jacobian.cols();
  const double squares =
      Eigen::Map<const Eigen::VectorXd>(residuals.data(), jacobian.rows()).squaredNorm();
  const auto degrees = static_cast<double>(jacobian.rows() - p);
  const ResidualErrors white{.degrees = degrees, .covariance = inverse * squares / degrees};
  ResidualErrors found = white;
  if (squares > 1e-18 * static_cast<double>(residuals.size()))
    if (auto correlated = autocorrelation(residuals, jacobian)) found = std::move(*correlated);
  Eigen::Index from = 0;
  for (const std::span<const double> values : records) {
    const auto count = static_cast<Eigen::Index>(values.size());
    const Matrix rounded = quantised_covariance(values, jacobian.middleRows(from, count), inverse);
    if (rounded.size() > 0) found.covariance += rounded;
    from += count;
  }
  double log_sum = 0.0;
  for (Eigen::Index i = 0; i < p && squares > 0.0; ++i)
    log_sum += std::log(found.covariance(i, i) / white.covariance(i, i));
  found.factor = std::exp(log_sum / static_cast<double>(p));
  return found;
}

// Durbin-Watson statistic and runs test.

double durbin_watson(std::span<const double> residuals) {
  const Eigen::Map<const Eigen::VectorXd> all(residuals.data(),
                                              static_cast<Eigen::Index>(residuals.size()));
  const double squares = all.squaredNorm();
  const Eigen::Index steps = all.size() - 1;
  return squares > 0.0 ? (all.tail(steps) - all.head(steps)).squaredNorm() / squares : 2.0;
}

double runs_z(std::span<const double> residuals) {
  double above = 0.0;
  double below = 0.0;
  double runs = 0.0;
  int last = 0;
  for (const double each : residuals) {
    const int sign = each > 0.0 ? 1 : each < 0.0 ? -1 : 0;
    if (sign == 0) continue;
    (sign > 0 ? above : below) += 1.0;
    if (sign != last) runs += 1.0;
    last = sign;
  }
  // mean 2 n m / (n + m) + 1, variance (mean - 1) (mean - 2) / (n + m - 1)
  const double all = above + below;
  if (all < 2.0) return 0.0;
  if (above == 0.0 || below == 0.0) return -std::numeric_limits<double>::infinity();
  const double mean = 2.0 * above * below / all + 1.0;
  const double variance = (mean - 1.0) * (mean - 2.0) / (all - 1.0);
  return variance > 0.0 ? (runs - mean) / std::sqrt(variance) : 0.0;
}

bool systematic(std::span<const double> residuals) {
  constexpr double quantile = 3.09;  // of the normal distribution, 1 in 1000
  const auto n = static_cast<double>(residuals.size());
  // The variance of the Durbin-Watson statistic of independent residuals is about 4 / n.
  return n >= 10.0 && durbin_watson(residuals) < 2.0 - quantile * 2.0 / std::sqrt(n) &&
         runs_z(residuals) < -quantile;
}

std::string correlation_sentence(double durbin_watson, std::size_t points, double effective) {
  return "neighbouring residuals are correlated (Durbin-Watson " + rounded_text(durbin_watson, 3) +
         ", independent noise gives 2), by slow noise or by a law that does not fit. The intervals "
         "count the " +
         std::to_string(points) + " points as " + rounded_text(std::max(1.0, effective), 3) +
         " independent ones, as slow noise wants; the bias of a wrong law is not in them" +
         (effective < 10.0 ? ", and an effective sample size below 10 cannot tell the two apart: "
                             "record a longer curve"
                           : "");
}

void warn_of_residuals(Fit& fit) {
  const auto warn = [&](const std::string& sentence) { fit.warnings.push_back(sentence); };
  if (fit.r2 < 0.9)
    warn("R^2 is " + rounded_text(fit.r2, 3) +
         ", so that the law describes the curve poorly, and the estimates mean little");
  if (fit.rho > 0.0)
    warn(correlation_sentence(fit.durbin_watson, static_cast<std::size_t>(fit.n),
                              fit.effective_size));
}

}  // namespace palpate::fit
