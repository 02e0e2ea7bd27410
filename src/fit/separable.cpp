// Variable projection for the start, then all parameters by Levenberg-Marquardt.
#include "fit/separable.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::fit {
namespace {

// The factors and the best of the starts; empty if none can be computed.
std::vector<double> start_of(std::span<const double> y, const Separable& curve) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto points = static_cast<Eigen::Index>(y.size());
  const auto linear = static_cast<Eigen::Index>(curve.linear);
  const Eigen::Map<const Eigen::VectorXd> target(y.data(), points);
  std::vector<double> phi(y.size() * curve.linear);
  const Eigen::Map<const Rows> matrix(phi.data(), points, linear);
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& shapes : curve.starts) {
    if (!curve.columns(shapes, phi) || !matrix.allFinite()) continue;
    const Eigen::VectorXd factors = matrix.colPivHouseholderQr().solve(target);
    const double squares = (matrix * factors - target).squaredNorm();
    if (!(squares < least) || !factors.allFinite()) continue;
    least = squares;
    best.assign(factors.begin(), factors.end());
    best.insert(best.end(), shapes.begin(), shapes.end());
  }
  return best;
}

}  // namespace

Minimum minimise(std::span<const double> y, const Separable& curve, int max_iterations) {
  const std::vector<double> start = start_of(y, curve);
  if (start.empty()) return {};
  const std::size_t linear = curve.linear;
  const std::size_t count = start.size();
  std::vector<double> phi(y.size() * linear);
  std::vector<double> above(phi.size());
  std::vector<double> below(phi.size());
  const CurveAt at = [&](std::span<const double> p, std::span<double> values,
                         std::span<double> slopes) {
    const std::span<const double> factors = p.first(linear);
    const auto sum = [&](const std::vector<double>& columns, std::size_t i) {
      double value = 0.0;
      for (std::size_t j = 0; j < linear; ++j) value += factors[j] * columns[i * linear + j];
      return value;
    };
    if (!curve.columns(p.subspan(linear), phi)) return false;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = sum(phi, i);
    if (slopes.empty()) return true;
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t j = 0; j < linear; ++j) slopes[i * count + j] = phi[i * linear + j];
    std::vector<double> shapes(p.begin() + static_cast<std::ptrdiff_t>(linear), p.end());
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const double shape = shapes[k];
      const double step = 1e-5 * std::max(1.0, std::abs(shape));  // error of order step^2
      shapes[k] = shape + step;
      if (!curve.columns(shapes, above)) return false;
      shapes[k] = shape - step;
      if (!curve.columns(shapes, below)) return false;
      shapes[k] = shape;
      for (std::size_t i = 0; i < values.size(); ++i)
        slopes[i * count + linear + k] = (sum(above, i) - sum(below, i)) / (2.0 * step);
    }
    return true;
  };
  return minimise(y, at, start, max_iterations);
}

void replace_parameter(Minimum& minimum, std::size_t i, double value, double slope) {
  const std::size_t count = minimum.parameters.size();
  minimum.parameters[i] = value;
  for (std::size_t j = 0; j < count && !minimum.inverse_normal.empty(); ++j) {
    minimum.inverse_normal[i * count + j] *= slope;
    minimum.inverse_normal[j * count + i] *= slope;
  }
  for (std::size_t at = i; at < minimum.jacobian.size(); at += count) minimum.jacobian[at] /= slope;
}

void add_to_parameter(Minimum& minimum, std::size_t i, std::size_t j, double factor) {
  const std::size_t count = minimum.parameters.size();
  for (std::size_t at = 0; at < minimum.jacobian.size(); at += count)
    minimum.jacobian[at + j] -= factor * minimum.jacobian[at + i];
  if (minimum.inverse_normal.empty()) return;
  std::vector<double>& v = minimum.inverse_normal;
  for (std::size_t k = 0; k < count; ++k) v[i * count + k] += factor * v[j * count + k];
  for (std::size_t k = 0; k < count; ++k) v[k * count + i] += factor * v[k * count + j];
}

void reorder_parameters(Minimum& minimum, std::span<const std::size_t> from) {
  const std::size_t count = from.size();
  const Minimum before = minimum;
  for (std::size_t i = 0; i < count; ++i) {
    minimum.parameters[i] = before.parameters[from[i]];
    if (before.inverse_normal.empty()) continue;
    for (std::size_t j = 0; j < count; ++j)
      minimum.inverse_normal[i * count + j] = before.inverse_normal[from[i] * count + from[j]];
  }
  for (std::size_t row = 0; row < before.jacobian.size(); row += count)
    for (std::size_t i = 0; i < count; ++i)
      minimum.jacobian[row + i] = before.jacobian[row + from[i]];
}

}  // namespace palpate::fit
