// Least squares over the box: derivatives of formulas by dual numbers, of scenes by differences.
#include "identify/box_search.h"

#include <ceres/jet.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "fit/ceres_fit.h"

namespace palpate::identify {
namespace {

// The search goes over 1 + u, so that its tolerances, which are relative, fit the box.
constexpr double shift = 1.0;
constexpr double step = 1e-4;  // of 1 + u: an error of order step^2 / 6, far below the noise

// The weighted curve over the unknowns that the search may change.
class Weighted {
 public:
  Weighted(const BoxProblem& problem, std::span<const double> u, std::span<const char> held)
      : problem_(&problem), u_(u.begin(), u.end()) {
    for (std::size_t i = 0; i < u.size(); ++i)
      if (held.empty() || held[i] == 0) places_.push_back(i);
    for (std::size_t i = 0; i < problem.measured.size(); ++i)
      measured_.push_back(problem.measured[i] * problem.weights[i]);
  }

  [[nodiscard]] const std::vector<std::size_t>& places() const { return places_; }
  [[nodiscard]] const std::vector<double>& measured() const { return measured_; }
  [[nodiscard]] int evaluations() const { return evaluations_; }

  // As fit::CurveAt wants it.
  bool operator()(std::span<const double> moved, std::span<double> values,
                  std::span<double> slopes) {
    std::vector<double> u = u_;
    for (std::size_t k = 0; k < places_.size(); ++k) u[places_[k]] = moved[k] - shift;
    if (!continued(u, values)) return false;
    if (!slopes.empty() &&
        !(problem_->closed != nullptr ? by_dual_numbers(u, slopes) : by_differences(u, slopes)))
      return false;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] *= problem_->weights[i];
      for (std::size_t k = 0; k < slopes.size() / values.size(); ++k)
        slopes[i * places_.size() + k] *= problem_->weights[i];
    }
    return true;
  }

 private:
  bool curve(std::span<const double> u, std::span<double> values) {
    ++evaluations_;
    if (problem_->closed != nullptr)
      closed::values(*problem_->closed, u.data(), values.data());
    else if (!problem_->curve(u, values))
      return false;
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  }

  // Beyond the box y(u) = 2 y(bound) - y(mirrored), so that a central difference at a bound equals
  // the one-sided difference inside the box.
  bool continued(std::span<const double> u, std::span<double> values) {
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

  bool by_differences(std::vector<double> u, std::span<double> slopes) {
    const std::size_t points = measured_.size();
    std::vector<double> above(points), below(points);
    for (std::size_t k = 0; k < places_.size(); ++k) {
      double& at = u[places_[k]];
      const double middle = at;
      const double change = step * std::abs(middle + shift);
      at = middle + change;
      if (!continued(u, above)) return false;
      at = middle - change;
      if (!continued(u, below)) return false;
      at = middle;
      for (std::size_t i = 0; i < points; ++i)
        slopes[i * places_.size() + k] = (above[i] - below[i]) / (2.0 * change);
    }
    return true;
  }

  bool by_dual_numbers(const std::vector<double>& u, std::span<double> slopes) {
    using Dual = ceres::Jet<double, 1>;
    std::vector<Dual> duals(u.begin(), u.end());
    std::vector<Dual> values(measured_.size());
    for (std::size_t k = 0; k < places_.size(); ++k) {
      duals[places_[k]].v[0] = 1.0;
      closed::values(*problem_->closed, duals.data(), values.data());
      duals[places_[k]].v[0] = 0.0;
      for (std::size_t i = 0; i < values.size(); ++i)
        slopes[i * places_.size() + k] = values[i].v[0];
    }
    return true;
  }

  const BoxProblem* problem_;
  std::vector<double> u_;
  std::vector<std::size_t> places_;
  std::vector<double> measured_;
  int evaluations_ = 0;
};

}  // namespace

BoxMinimum evaluate_in_box(const BoxProblem& problem, std::span<const double> u, Want want) {
  BoxMinimum at;
  at.u.assign(u.begin(), u.end());
  Weighted curve(problem, u, {});
  std::vector<double> moved;
  for (const double each : u) moved.push_back(each + shift);
  std::vector<double> values(problem.measured.size());
  if (want == Want::slopes) at.jacobian.resize(values.size() * u.size());
  at.found = curve(moved, values, at.jacobian);
  at.evaluations = curve.evaluations();
  if (!at.found) return at;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double residual = values[i] - curve.measured()[i];
    at.squares += residual * residual;
  }
  at.found = std::all_of(at.jacobian.begin(), at.jacobian.end(),
                         [](double slope) { return std::isfinite(slope); });
  return at;
}

BoxMinimum minimise_in_box(const BoxProblem& problem, std::span<const double> start,
                           std::span<const char> held, Want want) {
  Weighted curve(problem, start, held);
  std::vector<double> u(start.begin(), start.end());
  if (!curve.places().empty()) {
    std::vector<double> moved;
    for (const std::size_t place : curve.places())
      moved.push_back(std::clamp(start[place], 0.0, 1.0) + shift);
    // A relative error e of the squares means an error of sqrt(e n) standard errors for n points
    // with noise: about 1e-3 for a scene, where further digits would cost more runs than they are
    // worth.
    const bool formula = problem.closed != nullptr;
    const fit::Minimum minimum = fit::minimise(curve.measured(), std::ref(curve), moved,
                                               {.max_iterations = 60,
                                                .low = shift,
                                                .high = shift + 1.0,
                                                .gradient_tolerance = 0.0,
                                                .parameter_tolerance = formula ? 1e-12 : 1e-8,
                                                .function_tolerance = formula ? 1e-14 : 1e-9,
                                                .errors = false});
    if (minimum.status == fit::Minimum::Status::failed) {
      BoxMinimum none;
      none.evaluations = curve.evaluations();
      return none;
    }
    for (std::size_t k = 0; k < moved.size(); ++k)
      u[curve.places()[k]] = std::clamp(minimum.parameters[k] - shift, 0.0, 1.0);
  }
  BoxMinimum minimum = evaluate_in_box(problem, u, want);
  minimum.evaluations += curve.evaluations();
  return minimum;
}

}  // namespace palpate::identify
