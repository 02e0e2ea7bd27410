// The rows are first reduced to as many as there are columns by a QR decomposition.
#include "fit/nnls.h"

#include <limits>
#include <vector>

#include "base/dense.h"

namespace palpate::fit {
namespace {

// Least squares over the columns that are free; the others are 0.
Eigen::VectorXd over_free(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                          const std::vector<char>& free) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    if (free[static_cast<std::size_t>(i)] != 0) columns.push_back(i);
  Eigen::MatrixXd some(a.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k)
    some.col(static_cast<Eigen::Index>(k)) = a.col(columns[k]);
  const Eigen::VectorXd solved = dense::least_squares(some, b);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(a.cols());
  for (std::size_t k = 0; k < columns.size(); ++k)
    all[columns[k]] = solved[static_cast<Eigen::Index>(k)];
  return all;
}

}  // namespace

std::optional<Eigen::VectorXd> nonnegative_least_squares(const Eigen::MatrixXd& given,
                                                         const Eigen::VectorXd& target) {
  const Eigen::Index n = given.cols();
  const auto [q, a] = dense::qr(given);
  const Eigen::VectorXd b = q.transpose() * target;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  std::vector<char> free(static_cast<std::size_t>(n), 0);
  const double small = 1e-13 * a.colwise().norm().maxCoeff() * target.norm();
  for (Eigen::Index change = 0; change <= 3 * n; ++change) {
    // The gradient's largest component among the columns held at 0.
    const Eigen::VectorXd gradient = a.transpose() * (b - a * x);
    Eigen::Index next = -1;
    for (Eigen::Index i = 0; i < n; ++i)
      if (free[static_cast<std::size_t>(i)] == 0 && gradient[i] > small &&
          (next < 0 || gradient[i] > gradient[next]))
        next = i;
    if (next < 0) return x;
    free[static_cast<std::size_t>(next)] = 1;
    // Back to the border as long as a free coefficient would become negative.
    for (Eigen::Index inner = 0; inner <= n; ++inner) {
      const Eigen::VectorXd wanted = over_free(a, b, free);
      double step = 1.0;
      for (Eigen::Index i = 0; i < n; ++i)
        if (free[static_cast<std::size_t>(i)] != 0 && wanted[i] <= 0.0)
          step = std::min(step, x[i] / (x[i] - wanted[i]));
      x += step * (wanted - x);
      if (step >= 1.0) break;
      for (Eigen::Index i = 0; i < n; ++i)
        if (free[static_cast<std::size_t>(i)] != 0 && x[i] <= 1e-15 * x.cwiseAbs().maxCoeff()) {
          free[static_cast<std::size_t>(i)] = 0;
          x[i] = 0.0;
        }
    }
  }
  return std::nullopt;
}

}  // namespace palpate::fit
