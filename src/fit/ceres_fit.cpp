// Least-squares problems for Ceres.
#include "fit/ceres_fit.h"

#include <ceres/ceres.h>
#include <glog/logging.h>
#include <pthread.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "base/index.h"

namespace palpate::fit {

namespace {

// Ceres logs through glog even if its options say otherwise. Without InitGoogleLogging a failing
// fit writes to stderr; with it, into files below /tmp unless both flags are set before.
void silence_glog() {
  static const bool done = [] {
    if (google::IsGoogleLoggingInitialized()) return true;
    FLAGS_logtostderr = true;
    FLAGS_minloglevel = google::GLOG_FATAL;
    google::InitGoogleLogging("palpate");
    return true;
  }();
  static_cast<void>(done);
}

// All residuals as functions of the unknowns u_i = p_i / scale_i, which are of order one.
class CurveCost final : public ceres::CostFunction {
 public:
  CurveCost(std::span<const double> y, const CurveAt& curve, std::vector<double> scale)
      : y_(y), curve_(curve), scale_(std::move(scale)) {
    set_num_residuals(static_cast<int>(y.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(scale_.size()));
  }

  // False if a value or slope is not finite; Ceres accepts this as a normal result.
  bool Evaluate(double const* const* unknowns, double* residuals,
                double** jacobians) const override {
    double* jacobian = jacobians == nullptr ? nullptr : jacobians[0];
    const std::size_t count = scale_.size();
    std::vector<double> parameters(count);
    for (std::size_t k = 0; k < count; ++k) parameters[k] = unknowns[0][k] * scale_[k];
    const std::span<double> values(residuals, y_.size());
    const std::span<double> slopes(jacobian, jacobian == nullptr ? 0 : y_.size() * count);
    if (!curve_(parameters, values, slopes)) return false;
    bool finite = true;
    for (std::size_t i = 0; i < y_.size(); ++i) {
      values[i] -= y_[i];
      finite = finite && std::isfinite(values[i]);
    }
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      slopes[i] *= scale_[i % count];
      finite = finite && std::isfinite(slopes[i]);
    }
    return finite;
  }

 private:
  std::span<const double> y_;
  const CurveAt& curve_;
  std::vector<double> scale_;
};

// CurveAt for a model over x.
void model_curve(std::span<const double> x, Model model, std::span<const double> parameters,
                 std::span<double> values, std::span<double> by_parameter) {
  const std::size_t count = parameters.size();
  const auto linear = as_index(term_count(model));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto phi = terms(model, x[i], parameters[count - 1]);
    values[i] = 0.0;
    for (std::size_t k = 0; k < linear; ++k) values[i] += parameters[k] * phi[k];
    if (by_parameter.empty()) continue;
    for (std::size_t k = 0; k < linear; ++k) by_parameter[i * count + k] = phi[k];
    if (linear == count) continue;
    const auto by_shape = slopes(model, x[i], parameters[count - 1]);
    double slope = 0.0;
    for (std::size_t k = 0; k < linear; ++k) slope += parameters[k] * by_shape[k];
    by_parameter[i * count + linear] = slope;
  }
}

// (J^T J)^-1 by the singular values of J with columns of length 1; empty if it lacks full rank.
dense::Matrix inverse_normal(const dense::Rows& jacobian) {
  constexpr double least = 1e-7;  // of the largest singular value
  if (jacobian.rows() < jacobian.cols()) return {};
  const Eigen::RowVectorXd unit = jacobian.colwise().norm().cwiseInverse();
  if (!unit.allFinite()) return {};
  const dense::Svd parts = dense::svd(dense::qr(jacobian * unit.asDiagonal()).r);
  const Eigen::VectorXd& values = parts.values;
  if (!(values[values.size() - 1] >= least * values[0])) return {};
  const Eigen::MatrixXd root = unit.asDiagonal() * parts.v * values.cwiseInverse().asDiagonal();
  return dense::product(root, root.transpose());
}

ceres::Solver::Options solver_options(std::size_t points, const Descent& search) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.max_num_iterations = search.max_iterations;
  options.logging_type = ceres::SILENT;
  options.minimizer_progress_to_stdout = false;
  options.gradient_tolerance = search.gradient_tolerance * static_cast<double>(points);
  options.parameter_tolerance = search.parameter_tolerance;
  options.function_tolerance = search.function_tolerance;
  return options;
}

}  // namespace

Minimum minimise(std::span<const double> y, const CurveAt& curve, std::span<const double> start,
                 const Descent& search) {
  silence_glog();
  std::vector<double> scale;
  std::vector<double> unknowns;
  for (const double guess : start) {
    scale.push_back(guess == 0.0 ? 1.0 : std::abs(guess));
    unknowns.push_back(guess / scale.back());
  }
  ceres::Problem problem;
  problem.AddResidualBlock(new CurveCost(y, curve, scale), nullptr, unknowns.data());
  for (std::size_t k = 0; k < scale.size(); ++k) {
    if (std::isfinite(search.low))
      problem.SetParameterLowerBound(unknowns.data(), static_cast<int>(k), search.low / scale[k]);
    if (std::isfinite(search.high))
      problem.SetParameterUpperBound(unknowns.data(), static_cast<int>(k), search.high / scale[k]);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(y.size(), search), &problem, &summary);

  Minimum minimum;
  if (!summary.IsSolutionUsable()) return minimum;
  minimum.status = summary.termination_type == ceres::CONVERGENCE
                       ? Minimum::Status::found
                       : Minimum::Status::out_of_iterations;
  minimum.squares = 2.0 * summary.final_cost;
  for (std::size_t i = 0; i < scale.size(); ++i)
    minimum.parameters.push_back(unknowns[i] * scale[i]);
  if (!search.errors) return minimum;
  minimum.residuals.resize(y.size());
  minimum.jacobian.resize(static_cast<Eigen::Index>(y.size()),
                          static_cast<Eigen::Index>(scale.size()));
  (void)curve(minimum.parameters, minimum.residuals,
              {minimum.jacobian.data(), as_index(minimum.jacobian.size())});
  for (std::size_t i = 0; i < y.size(); ++i) minimum.residuals[i] -= y[i];
  if (minimum.status == Minimum::Status::found)
    minimum.inverse_normal = inverse_normal(minimum.jacobian);
  return minimum;
}

Minimum minimise(std::span<const double> x, std::span<const double> y, Model model,
                 std::span<const double> start, int max_iterations) {
  const CurveAt curve = [&](std::span<const double> parameters, std::span<double> values,
                            std::span<double> slopes) {
    model_curve(x, model, parameters, values, slopes);
    return true;
  };
  return minimise(y, curve, start, {.max_iterations = max_iterations});
}

// Variable projection for the start, then all parameters by Levenberg-Marquardt.

namespace {

using dense::Rows;

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
  std::ranges::stable_sort(all, {}, &Start::squares);
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

void replace_parameter(Minimum& minimum, Eigen::Index i, double value, double slope) {
  minimum.parameters[as_index(i)] = value;
  minimum.jacobian.col(i) /= slope;
  if (minimum.inverse_normal.size() == 0) return;
  minimum.inverse_normal.row(i) *= slope;
  minimum.inverse_normal.col(i) *= slope;
}

void add_to_parameter(Minimum& minimum, Eigen::Index i, Eigen::Index j, double factor) {
  minimum.jacobian.col(j) -= factor * minimum.jacobian.col(i);
  if (minimum.inverse_normal.size() == 0) return;
  minimum.inverse_normal.row(i) += factor * minimum.inverse_normal.row(j);
  minimum.inverse_normal.col(i) += factor * minimum.inverse_normal.col(j);
}

void reorder_parameters(Minimum& minimum, std::span<const std::size_t> from) {
  const Minimum before = minimum;
  for (std::size_t i = 0; i < from.size(); ++i) minimum.parameters[i] = before.parameters[from[i]];
  minimum.jacobian = before.jacobian(Eigen::all, from);
  if (before.inverse_normal.size() > 0) minimum.inverse_normal = before.inverse_normal(from, from);
}

std::string ceres_version() { return CERES_VERSION_STRING; }

}  // namespace palpate::fit

// Stands for std::condition_variable::wait() (src/CMakeLists.txt). Ceres's archive asks for that of
// GCC 12, the only thing that would keep the program from running with the C++ library of GCC 11.
extern "C" void
__wrap__ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE(  // NOLINT: the linker's name
    std::condition_variable* signal, std::unique_lock<std::mutex>* lock) {
  pthread_cond_wait(signal->native_handle(), lock->mutex()->native_handle());
}
