// The likelihood needs three products of the data with themselves, whatever the correlation.
#include "fit/correlated.h"

#include <Eigen/Dense>
#include <cmath>
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

}  // namespace

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
  const Matrix sandwich = variance * (inverse * correlated_product(rows, p, rho) * inverse);
  // The variance of a mean depends on s^2 / (1-rho)^2, whose relative variance is
  // 2/n + 4 var(rho) / (1-rho)^2 with var(rho) = (1-rho^2) / n.
  found.degrees = std::max(4.0, degrees * (1.0 - rho) / (3.0 + rho));
  found.effective_size = static_cast<double>(n) * (1.0 - rho) / (1.0 + rho);
  found.covariance.resize(unknowns * unknowns);
  for (Eigen::Index i = 0; i < p; ++i)
    for (Eigen::Index k = 0; k < p; ++k)
      found.covariance[as_index(i * p + k)] = sandwich(i, k) / (scale[i] * scale[k]);
  return found;
}

}  // namespace palpate::fit
