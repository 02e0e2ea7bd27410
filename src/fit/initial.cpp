// Variable projection on a grid: linear least squares for each value of the shape parameter.
#include "fit/initial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/dense.h"
#include "base/index.h"

namespace palpate::fit {
namespace {

std::vector<double> shapes(Model model, double scale) {
  std::vector<double> grid;
  switch (model) {
    case Model::logarithmic: return {0.0};
    case Model::power:
      for (int i = -16; i <= 40; ++i) grid.push_back(0.25 * i);
      break;
    case Model::exponential:  // |m| from 1e-3 to 1e2 divided by the largest |x|, both signs
      for (int i = -24; i <= 16; ++i)
        for (const double sign : {1.0, -1.0})
          grid.push_back(sign * std::pow(10.0, i / 8.0) / scale);
      break;
    case Model::kelvin_voigt:
    case Model::kelvin_voigt_recovery:
    case Model::standard_linear_solid:  // tau from 1e-3 to 1e3 times the largest |x|
      for (int i = -24; i <= 24; ++i) grid.push_back(std::pow(10.0, i / 8.0) * scale);
      break;
  }
  return grid;
}

// The terms of a model at all points for one value of its shape parameter.
struct Trial {
  double shape;
  Eigen::MatrixXd terms;
};

// Those of the last points on this thread: the cases of a sweep have the same ones.
const std::vector<Trial>& trials(std::span<const double> x, Model model) {
  struct Known {
    std::vector<double> x;
    std::vector<Trial> trials;
  };
  thread_local std::map<Model, Known> all;
  Known& known = all[model];
  if (!known.trials.empty() && std::equal(x.begin(), x.end(), known.x.begin(), known.x.end()))
    return known.trials;
  known = {{x.begin(), x.end()}, {}};
  double scale = 0.0;
  for (const double each : x) scale = std::max(scale, std::abs(each));
  const auto n = static_cast<Eigen::Index>(x.size());
  const int count = term_count(model);
  for (const double shape : shapes(model, scale == 0.0 ? 1.0 : scale)) {
    Trial trial{shape, Eigen::MatrixXd(n, count)};
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto phi = terms(model, x[as_index(i)], shape);
      for (int k = 0; k < count; ++k) trial.terms(i, k) = phi[as_index(k)];
    }
    if (trial.terms.allFinite()) known.trials.push_back(std::move(trial));
  }
  return known.trials;
}

}  // namespace

std::optional<std::vector<double>> initial_guess(std::span<const double> x,
                                                 std::span<const double> y, Model model) {
  const Eigen::Map<const Eigen::VectorXd> target(y.data(), static_cast<Eigen::Index>(x.size()));
  std::optional<std::vector<double>> best;
  double least = std::numeric_limits<double>::infinity();
  Eigen::VectorXd linear(term_count(model));
  for (const auto& [shape, matrix] : trials(x, model)) {
    double sum = 0.0;
    if (linear.size() == 1) {
      const double along = matrix.col(0).dot(target);
      linear[0] = along / matrix.col(0).squaredNorm();
      sum = target.squaredNorm() - along * linear[0];
    } else {
      linear = dense::least_squares(matrix, target);
      sum = (matrix.lazyProduct(linear) - target).squaredNorm();
    }
    if (!(sum < least) || !linear.allFinite()) continue;
    least = sum;
    best.emplace(linear.begin(), linear.end());
    if (has_shape(model)) best->push_back(shape);
  }
  return best;
}

}  // namespace palpate::fit
