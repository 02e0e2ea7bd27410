// Variable projection for the start, then all parameters by Levenberg-Marquardt.
#include "fit/separable.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/dense.h"
#include "base/index.h"

namespace palpate::fit {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The columns of a curve at some shapes, and the derivatives of the curve.
class Columns {
 public:
  Columns(const Separable& curve, std::size_t points)
      : curve_(curve),
        phi_(static_cast<Eigen::Index>(points), static_cast<Eigen::Index>(curve.linear)),
        above_(phi_),
        below_(phi_) {}

  [[nodiscard]] const Rows& at() const { return phi_; }

  bool set(std::span<const double> shapes) { return computed(shapes, phi_); }

  // d y / d s_k for these factors, by central differences; false where they cannot be computed.
  bool slope(std::span<const double> shapes, std::size_t k, const Eigen::VectorXd& factors,
             Eigen::VectorXd& slope) {
    std::vector<double> moved(shapes.begin(), shapes.end());
    const double step = 1e-5 * std::max(1.0, std::abs(shapes[k]));  // error of order step^2
    moved[k] = shapes[k] + step;
    if (!computed(moved, above_)) return false;
    moved[k] = shapes[k] - step;
    if (!computed(moved, below_)) return false;
    slope = (above_ - below_) * factors / (2.0 * step);
    return true;
  }

 private:
  bool computed(std::span<const double> shapes, Rows& phi) const {
    return curve_.columns(shapes, {phi.data(), as_index(phi.size())});
  }

  const Separable& curve_;
  Rows phi_, above_, below_;
};

// Shapes with the factors that are best for them.
struct Start {
  double squares = std::numeric_limits<double>::infinity();
  std::vector<double> shapes, factors;
};

std::optional<Start> start_at(std::span<const double> y, Columns& columns,
                              const std::vector<double>& shapes) {
  if (!columns.set(shapes) || !columns.at().allFinite()) return std::nullopt;
  const Eigen::Map<const Eigen::VectorXd> target(y.data(), columns.at().rows());
  const Eigen::VectorXd factors = dense::least_squares(columns.at(), target);
  if (!factors.allFinite()) return std::nullopt;
  return Start{
      (columns.at() * factors - target).squaredNorm(), shapes, {factors.begin(), factors.end()}};
}

// The nearest minimum over the shapes alone, the factors being always the best ones: the slopes are
// those of the curve without what the columns can describe.       Kaufman 1975, BIT 15, 49
std::optional<Start> projected(std::span<const double> y, const Separable& curve,
                               const Start& start) {
  Columns columns(curve, y.size());
  const CurveAt at = [&](std::span<const double> p, std::span<double> values,
                         std::span<double> slopes) {
    const std::vector<double> shapes(p.begin(), p.end());
    const auto now = start_at(y, columns, shapes);
    if (!now) return false;
    const Eigen::Map<const Eigen::VectorXd> factors(now->factors.data(), columns.at().cols());
    Eigen::Map<Eigen::VectorXd>(values.data(), columns.at().rows()) = columns.at() * factors;
    if (slopes.empty()) return true;
    const Eigen::MatrixXd basis = dense::qr(columns.at()).q;
    Eigen::VectorXd slope;
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      if (!columns.slope(shapes, k, factors, slope)) return false;
      slope -= basis * (basis.transpose() * slope);
      for (std::size_t i = 0; i < values.size(); ++i)
        slopes[i * shapes.size() + k] = slope[static_cast<Eigen::Index>(i)];
    }
    return true;
  };
  const Minimum minimum = minimise(y, at, start.shapes, {});
  if (minimum.status == Minimum::Status::failed) return std::nullopt;
  return start_at(y, columns, minimum.parameters);
}

// The best of the starts, or of the minima next to the first of them.
std::optional<Start> start_of(std::span<const double> y, const Separable& curve) {
  Columns columns(curve, y.size());
  std::vector<Start> all;
  for (const std::vector<double>& shapes : curve.starts)
    if (auto start = start_at(y, columns, shapes)) all.push_back(*std::move(start));
  if (all.empty()) return std::nullopt;
  std::stable_sort(all.begin(), all.end(),
                   [](const Start& a, const Start& b) { return a.squares < b.squares; });
  Start best = all.front();
  const double rounding = 1e-26 * static_cast<double>(y.size());
  for (std::size_t i = 0; i < std::min(curve.minima, all.size()) && best.squares > rounding; ++i)
    if (const auto found = projected(y, curve, all[i]); found && found->squares < best.squares)
      best = *found;
  return best;
}

}  // namespace

Minimum minimise(std::span<const double> y, const Separable& curve, int max_iterations) {
  const auto found = start_of(y, curve);
  if (!found) return {};
  std::vector<double> start = found->factors;
  start.insert(start.end(), found->shapes.begin(), found->shapes.end());
  const std::size_t linear = curve.linear;
  const std::size_t count = start.size();
  Columns columns(curve, y.size());
  const CurveAt at = [&](std::span<const double> p, std::span<double> values,
                         std::span<double> slopes) {
    const Eigen::Map<const Eigen::VectorXd> factors(p.data(), columns.at().cols());
    const std::span<const double> shapes = p.subspan(linear);
    if (!columns.set(shapes)) return false;
    Eigen::Map<Eigen::VectorXd>(values.data(), columns.at().rows()) = columns.at() * factors;
    if (slopes.empty()) return true;
    Eigen::Map<Rows> table(slopes.data(), columns.at().rows(), static_cast<Eigen::Index>(count));
    table.leftCols(columns.at().cols()) = columns.at();
    Eigen::VectorXd slope;
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      if (!columns.slope(shapes, k, factors, slope)) return false;
      table.col(static_cast<Eigen::Index>(linear + k)) = slope;
    }
    return true;
  };
  return minimise(y, at, start, {.max_iterations = max_iterations});
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
