// Least squares by Ceres: automatic differentiation of formulas, numeric differentiation of scenes.
#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "fit/ceres_fit.h"
#include "identify/box_search.h"

namespace palpate::identify {
namespace {

// Ceres's difference steps are proportional to the parameter, at least 1e-8: near u = 0 too small
// for scenes that are solved to tolerances. The parameter is 1 + u, so that steps fit the box.
constexpr double shift = 1.0;
constexpr double central_step = 1e-4;  // error of order step^2 / 6, far below the noise
constexpr double ridders_step = 4e-3;

// The unknowns that the search may change.
struct Free {
  std::vector<double> u;            // of all unknowns
  std::vector<std::size_t> places;  // of the free ones in u
};

// Continues y(u) beyond the box by y = 2 y(bound) - y(mirrored), so that a central difference at a
// bound equals the one-sided difference inside the box.
class Continued {
 public:
  Continued(const BoxProblem& problem, int& evaluations)
      : problem_(&problem), evaluations_(&evaluations) {}

  bool operator()(std::span<const double> u, std::span<double> values) const {
    std::vector<double> bound(u.begin(), u.end());
    std::vector<double> mirrored(u.begin(), u.end());
    bool outside = false;
    for (std::size_t i = 0; i < u.size(); ++i) {
      bound[i] = std::clamp(u[i], 0.0, 1.0);
      mirrored[i] = 2.0 * bound[i] - u[i];
      outside = outside || bound[i] != u[i];
    }
    if (!outside) return curve(u, values);
    std::vector<double> at_bound(values.size());
    if (!curve(bound, at_bound) || !curve(mirrored, values)) return false;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 2.0 * at_bound[i] - values[i];
    return true;
  }

 private:
  bool curve(std::span<const double> u, std::span<double> values) const {
    ++*evaluations_;
    if (!problem_->curve(u, values)) return false;
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  }

  const BoxProblem* problem_;
  int* evaluations_;
};

// Weighted residuals of a scene, for numeric differentiation.
struct SceneResiduals {
  const BoxProblem* problem;
  const Free* free;
  Continued curve;

  bool operator()(double const* const* moved, double* residuals) const {
    std::vector<double> u = free->u;
    for (std::size_t k = 0; k < free->places.size(); ++k) u[free->places[k]] = moved[0][k] - shift;
    const std::size_t points = problem->measured.size();
    if (!curve(u, {residuals, points})) return false;
    for (std::size_t i = 0; i < points; ++i)
      residuals[i] = (residuals[i] - problem->measured[i]) * problem->weights[i];
    return true;
  }
};

// Weighted residuals of a formula, for numbers and for dual numbers.
struct FormulaResiduals {
  const BoxProblem* problem;
  const Free* free;
  int* evaluations;

  template <class T>
  bool operator()(T const* const* moved, T* residuals) const {
    ++*evaluations;
    std::vector<T> u;
    for (const double each : free->u) u.push_back(T(each));
    for (std::size_t k = 0; k < free->places.size(); ++k) u[free->places[k]] = moved[0][k] - shift;
    closed::values(*problem->closed, u.data(), residuals);
    for (std::size_t i = 0; i < problem->measured.size(); ++i)
      residuals[i] = (residuals[i] - problem->measured[i]) * problem->weights[i];
    return true;
  }
};

template <class Cost>
std::unique_ptr<ceres::CostFunction> sized(std::unique_ptr<Cost> cost, std::size_t unknowns,
                                           std::size_t points) {
  cost->AddParameterBlock(static_cast<int>(unknowns));
  cost->SetNumResiduals(static_cast<int>(points));
  return cost;
}

std::unique_ptr<ceres::CostFunction> make_cost(const BoxProblem& problem, const Free& free,
                                               int& evaluations) {
  const std::size_t unknowns = free.places.size();
  const std::size_t points = problem.measured.size();
  if (problem.slopes == Slopes::automatic && problem.closed != nullptr)
    return sized(std::make_unique<ceres::DynamicAutoDiffCostFunction<FormulaResiduals, 4>>(
                     new FormulaResiduals{&problem, &free, &evaluations}),
                 unknowns, points);
  ceres::NumericDiffOptions options;
  options.relative_step_size = central_step;
  options.ridders_relative_initial_step_size = ridders_step;
  auto* residuals = new SceneResiduals{&problem, &free, {problem, evaluations}};
  if (problem.slopes == Slopes::ridders)
    return sized(
        std::make_unique<ceres::DynamicNumericDiffCostFunction<SceneResiduals, ceres::RIDDERS>>(
            residuals, ceres::TAKE_OWNERSHIP, options),
        unknowns, points);
  return sized(
      std::make_unique<ceres::DynamicNumericDiffCostFunction<SceneResiduals, ceres::CENTRAL>>(
          residuals, ceres::TAKE_OWNERSHIP, options),
      unknowns, points);
}

ceres::Solver::Options solver_options(bool formula) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.max_num_iterations = 60;
  options.logging_type = ceres::SILENT;
  options.minimizer_progress_to_stdout = false;
  // A relative error e of the squares means an error of sqrt(e n) standard errors for n points with
  // noise: about 1e-3 for a scene, where further digits would cost more runs than they are worth.
  options.function_tolerance = formula ? 1e-14 : 1e-9;
  options.parameter_tolerance = formula ? 1e-12 : 1e-8;
  options.gradient_tolerance = 0.0;
  return options;
}

Free free_of(std::span<const double> u, std::span<const char> held) {
  Free free;
  free.u.assign(u.begin(), u.end());
  for (std::size_t i = 0; i < u.size(); ++i)
    if (held.empty() || held[i] == 0) free.places.push_back(i);
  return free;
}

}  // namespace

BoxMinimum evaluate_in_box(const BoxProblem& problem, std::span<const double> u, Want want) {
  fit::silence_glog();
  BoxMinimum at;
  at.u.assign(u.begin(), u.end());
  const Free free = free_of(u, {});
  const auto cost = make_cost(problem, free, at.evaluations);
  std::vector<double> moved;
  for (const double each : u) moved.push_back(each + shift);
  const double* block = moved.data();
  const std::size_t points = problem.measured.size();
  std::vector<double> residuals(points);
  if (want == Want::slopes) at.jacobian.resize(points * u.size());
  double* jacobian = at.jacobian.data();
  if (!cost->Evaluate(&block, residuals.data(), want == Want::slopes ? &jacobian : nullptr))
    return at;
  for (const double each : residuals) at.squares += each * each;
  at.found = std::all_of(at.jacobian.begin(), at.jacobian.end(),
                         [](double slope) { return std::isfinite(slope); });
  return at;
}

BoxMinimum minimise_in_box(const BoxProblem& problem, std::span<const double> start,
                           std::span<const char> held, Want want) {
  fit::silence_glog();
  const Free free = free_of(start, held);
  int evaluations = 0;
  std::vector<double> u(start.begin(), start.end());
  if (!free.places.empty()) {
    std::vector<double> moved;
    for (const std::size_t place : free.places)
      moved.push_back(std::clamp(start[place], 0.0, 1.0) + shift);
    ceres::Problem search;
    search.AddResidualBlock(make_cost(problem, free, evaluations).release(), nullptr, moved.data());
    for (std::size_t k = 0; k < moved.size(); ++k) {
      search.SetParameterLowerBound(moved.data(), static_cast<int>(k), shift);
      search.SetParameterUpperBound(moved.data(), static_cast<int>(k), shift + 1.0);
    }
    ceres::Solver::Summary summary;
    const bool formula = problem.closed != nullptr && problem.slopes == Slopes::automatic;
    ceres::Solve(solver_options(formula), &search, &summary);
    if (!summary.IsSolutionUsable()) {
      BoxMinimum none;
      none.evaluations = evaluations;
      return none;
    }
    for (std::size_t k = 0; k < moved.size(); ++k)
      u[free.places[k]] = std::clamp(moved[k] - shift, 0.0, 1.0);
  }
  BoxMinimum minimum = evaluate_in_box(problem, u, want);
  minimum.evaluations += evaluations;
  return minimum;
}

}  // namespace palpate::identify
