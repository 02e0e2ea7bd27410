// The directions are those of the singular values, which are independent of each other.
#include "identify/widening.h"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "base/index.h"
#include "fit/correlated.h"

namespace palpate::identify {

std::optional<Widening> widening(std::span<const double> residuals,
                                 std::span<const double> jacobian, std::size_t unknowns) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto n = static_cast<Eigen::Index>(residuals.size());
  const auto p = static_cast<Eigen::Index>(unknowns);
  if (jacobian.size() != residuals.size() * unknowns || n <= p) return std::nullopt;
  const Eigen::Map<const Rows> slopes(jacobian.data(), n, p);
  if (!slopes.allFinite()) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(slopes, Eigen::ComputeThinU | Eigen::ComputeThinV);
  Eigen::Index determined = 0;
  while (determined < p && svd.singularValues()[determined] > 1e-6 * svd.singularValues()[0])
    ++determined;
  if (determined == 0) return std::nullopt;
  const Rows directions = svd.matrixU().leftCols(determined);
  const auto found = fit::autocorrelation(
      residuals, {directions.data(), as_index(directions.size())}, as_index(determined));
  if (!found) return std::nullopt;
  double squares = 0.0;
  for (const double each : residuals) squares += each * each;
  const double variance = squares / static_cast<double>(n - p);
  double log_sum = 0.0;
  for (Eigen::Index i = 0; i < determined; ++i)  // directions of length 1: J^T J = 1
    log_sum += std::log(found->covariance[as_index(i * determined + i)] / variance);
  return Widening{found->rho, found->effective_size, found->degrees,
                  std::max(1.0, std::exp(log_sum / static_cast<double>(determined)))};
}

}  // namespace palpate::identify
