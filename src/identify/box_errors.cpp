// Errors from the singular values of the jacobian, and the combination of not separately
// identifiable unknowns.
#include "identify/box_errors.h"

#include <algorithm>
#include <cmath>

#include "base/dense.h"
#include "base/text.h"

namespace palpate::identify {
namespace {

constexpr double loose_half_width = 0.5;  // of the box, at 95 %
// Interpolation and differentiation of scenes have relative errors of about 1e-5 and 1e-7: smaller
// noise and smaller slopes have no meaning.
constexpr double least_sigma = 1e-5;
constexpr double least_slope = 1e-6;  // of the steepest direction

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
dense::Svd svd_of(std::span<const double> jacobian, std::size_t unknowns) {
  const auto rows = static_cast<Eigen::Index>(jacobian.size() / unknowns);
  const Eigen::Map<const Matrix> slopes(jacobian.data(), rows, static_cast<Eigen::Index>(unknowns));
  return dense::svd(slopes);
}

bool has(const std::string& key, const char* ending) { return key.ends_with(ending); }

// d ln p / du, and dp / du with p in the unknown's unit.
double log_slope(const Unknown& unknown, double u) { return unknown.slope(u) / unknown.value(u); }
double shown_slope(const Unknown& unknown, double u) { return unknown.shown(unknown.slope(u)); }

std::string with_exponent(const std::string& text, double exponent) {
  if (text.empty() || exponent == 1.0) return text;
  return text + "^" + rounded_text(exponent, 3);
}

}  // namespace

std::vector<double> determined_directions(std::span<const double> jacobian, std::size_t unknowns) {
  const dense::Svd svd = svd_of(jacobian, unknowns);
  const Eigen::VectorXd& sizes = svd.values;
  const auto count = (sizes.array() > least_slope * sizes[0]).count();
  const Matrix directions = svd.u.leftCols(count);
  return {directions.data(), directions.data() + directions.size()};
}

BoxErrors box_errors(std::span<const double> jacobian, std::size_t unknowns,
                     std::span<const double> noise, double t, int weakest) {
  const auto n = static_cast<Eigen::Index>(unknowns);
  const dense::Svd svd = svd_of(jacobian, unknowns);
  const auto count = static_cast<Eigen::Index>(std::lround(std::sqrt(noise.size())));
  const Eigen::Map<const Matrix> along(noise.data(), count, count);
  BoxErrors errors;
  errors.inseparable.assign(unknowns, 0);
  Eigen::MatrixXd response = Eigen::MatrixXd::Zero(n, count);  // of u to the directions
  std::vector<Eigen::VectorXd> loose;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double slope = svd.values[k];
    if (k >= n - weakest || k >= count ||
        t * std::max(std::sqrt(along(k, k)), least_sigma) > loose_half_width * slope) {
      loose.emplace_back(svd.v.col(k));
      continue;
    }
    ++errors.determined;
    response.col(k) = svd.v.col(k) / slope;
  }
  const Eigen::MatrixXd back = response.transpose();
  const Eigen::MatrixXd covariance = dense::product(dense::product(response, along), back);
  const Eigen::MatrixXd of_one = dense::product(response, back);
  for (const Eigen::VectorXd& direction : loose) {
    errors.loose.emplace_back(direction.data(), direction.data() + n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double own = t * std::sqrt(covariance(i, i));
      const double moved = loose_half_width * std::abs(direction[i]);
      if (moved > std::max(own, 1e-3)) errors.inseparable[as_index(i)] = 1;
    }
  }
  errors.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  errors.of_one.assign(of_one.data(), of_one.data() + of_one.size());
  return errors;
}

std::optional<Combination> combination(const BoxErrors& errors, std::span<const Unknown> unknowns,
                                       std::span<const double> u, double t) {
  Combination found;
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    if (errors.inseparable[i] != 0) found.of.push_back(i);
  const std::size_t m = found.of.size();
  if (m < 2 || errors.loose.size() + 1 != m) return std::nullopt;

  // The direction within the inseparable unknowns that is orthogonal to all loose
  // directions.
  Eigen::MatrixXd loose(static_cast<Eigen::Index>(m - 1), static_cast<Eigen::Index>(m));
  for (std::size_t k = 0; k + 1 < m; ++k)
    for (std::size_t i = 0; i < m; ++i)
      loose(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          errors.loose[k][found.of[i]];
  const dense::Svd svd = dense::svd(loose);
  const Eigen::VectorXd kept = svd.v.col(static_cast<Eigen::Index>(m) - 1);

  std::vector<double> gradient(unknowns.size(), 0.0);  // d (combination or its logarithm) / du
  const auto error = [&] {
    double variance = 0.0;
    for (std::size_t i = 0; i < gradient.size(); ++i)
      for (std::size_t j = 0; j < gradient.size(); ++j)
        variance += gradient[i] * gradient[j] * errors.variance(i, j);
    return std::sqrt(std::max(0.0, variance));
  };
  const auto finish_by_logarithm = [&](double value) {
    found.gradient = gradient;
    found.product = true;
    const double log_error = error();
    found.estimate = value;
    found.std_error = value * log_error;
    found.ci95_low = value * std::exp(-t * log_error);
    found.ci95_high = value * std::exp(t * log_error);
    return found;
  };

  // E / (1 - nu^2): Hertz's law depends on E and nu through this modulus only.
  const std::size_t a = found.of[0];
  const std::size_t b = found.of[1];
  const bool elastic =
      m == 2 && (has(unknowns[a].key, ".young_modulus") || has(unknowns[b].key, ".young_modulus"));
  if (elastic) {
    const std::size_t e = has(unknowns[a].key, ".young_modulus") ? a : b;
    const std::size_t r = e == a ? b : a;
    const double nu = unknowns[r].value(u[r]);
    gradient[e] = log_slope(unknowns[e], u[e]);
    gradient[r] = 2.0 * nu / (1.0 - nu * nu) * unknowns[r].slope(u[r]);
    const double along_e = gradient[e] * errors.loose[0][e];
    const double along_r = gradient[r] * errors.loose[0][r];
    if (has(unknowns[r].key, ".poisson_ratio") &&
        std::abs(along_e + along_r) <= 0.05 * std::abs(along_e)) {
      found.text = unknowns[e].name() + " / (1 - " + unknowns[r].name() + "^2)";
      found.unit = unknowns[e].unit_text();
      return finish_by_logarithm(unknowns[e].shown(unknowns[e].value(u[e])) / (1.0 - nu * nu));
    }
  }

  const bool powers = std::all_of(found.of.begin(), found.of.end(),
                                  [&](std::size_t i) { return unknowns[i].low > 0.0; });
  const auto slope = [&](std::size_t i) {
    return powers ? log_slope(unknowns[i], u[i]) : shown_slope(unknowns[i], u[i]);
  };
  // The first unknown has the exponent or factor 1.
  const double first = kept[0] / slope(a);
  double value = powers ? 1.0 : 0.0;
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t i = found.of[k];
    const double factor = k == 0 ? 1.0 : kept[static_cast<Eigen::Index>(k)] / slope(i) / first;
    gradient[i] = factor * slope(i);
    const Unknown& unknown = unknowns[i];
    const double shown = unknown.shown(unknown.value(u[i]));
    if (powers) {
      found.exponents.push_back(factor);
      value *= std::pow(shown, factor);
      found.text += (k == 0 ? "" : " * ") + with_exponent(unknown.name(), factor);
      const std::string unit = with_exponent(unknown.unit_text(), factor);
      found.unit += (found.unit.empty() || unit.empty() ? "" : " ") + unit;
    } else {
      value += factor * shown;
      found.text +=
          k == 0 ? unknown.name() : " + " + rounded_text(factor, 3) + " * " + unknown.name();
      if (k == 0) found.unit = unknown.unit_text();
    }
  }
  if (powers) return finish_by_logarithm(value);
  found.gradient = gradient;
  found.estimate = value;
  found.std_error = error();
  found.ci95_low = value - t * found.std_error;
  found.ci95_high = value + t * found.std_error;
  return found;
}

}  // namespace palpate::identify
