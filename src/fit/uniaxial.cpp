// The stress is proportional to E; Ogden's exponent is searched on a grid first.
#include "fit/uniaxial.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"
#include "base/units.h"
#include "fit/ceres_fit.h"
#include "fit/contact_warnings.h"
#include "fit/settle.h"

namespace palpate::fit {
namespace {

// Nominal stress for E = 1 Pa at a stretch, and its derivative with respect to alpha.
struct UnitStress {
  double value, slope;
};

UnitStress neo_hookean(double stretch) {
  return {(stretch - 1.0 / (stretch * stretch)) / 3.0, 0.0};
}

// P = 2/(3 alpha) (L^(alpha-1) - L^(-alpha/2-1)) for E = 3 mu = 1, and for alpha -> 0 its limit
// ln L / L.
UnitStress ogden(double stretch, double alpha) {
  const double log = std::log(stretch);
  const double long_part = std::pow(stretch, alpha - 1.0);
  const double wide_part = std::pow(stretch, -0.5 * alpha - 1.0);
  if (std::abs(alpha) < 1e-4)  // series in alpha
    return {(log + 0.25 * alpha * log * log) / stretch, 0.25 * log * log / stretch};
  const double value = 2.0 / (3.0 * alpha) * (long_part - wide_part);
  return {value, 2.0 / (3.0 * alpha) * (long_part * log + 0.5 * wide_part * log) - value / alpha};
}

class UniaxialFit {
 public:
  UniaxialFit(std::span<const double> strain, std::span<const double> stress,
              const UniaxialTest& test)
      : test_(test), loading_(test.loading) {
    using Model = UniaxialTest::Model;
    fit_.name = test.model == Model::modulus       ? "modulus"
                : test.model == Model::neo_hookean ? "neo_hookean"
                                                   : "ogden";
    take(strain, stress);
    turn();
    keep_range();
  }

  Fit all() {
    fit_.n = static_cast<int>(strain_.size());
    fit_.range_low = *std::min_element(strain_.begin(), strain_.end());
    fit_.range_high = *std::max_element(strain_.begin(), strain_.end());
    if (test_.model == UniaxialTest::Model::modulus)
      line();
    else
      large_strain();
    if (fit_.termination == Termination::failed) return std::move(fit_);
    if (!(fit_.parameters[0].estimate > 0.0))
      throw InputError({},
                       "the stress does not grow with the strain in this range; name other "
                       "columns, or give another `--from` and `--to`");
    platens();
    warn_of_residuals(fit_);
    return std::move(fit_);
  }

 private:
  void leave_out(std::size_t count, const std::string& why) {
    if (count == 0) return;
    fit_.left_out += static_cast<int>(count);
    fit_.notes.push_back(std::to_string(count) + (count == 1 ? " point is" : " points are") +
                         " left out: " + why);
  }

  void refuse_few() const {
    if (strain_.size() >= 4) return;
    throw InputError({}, "the model `" + fit_.name + "` needs at least 4 points, and " +
                             std::to_string(strain_.size()) +
                             (strain_.size() == 1 ? " is" : " are") +
                             " usable; widen `--from` and `--to`, or record more points");
  }

  void take(std::span<const double> strain, std::span<const double> stress) {
    for (std::size_t i = 0; i < strain.size(); ++i) {
      if (!std::isfinite(strain[i]) || !std::isfinite(stress[i])) continue;
      strain_.push_back(strain[i]);
      stress_.push_back(stress[i]);
    }
    leave_out(strain.size() - strain_.size(), "a number is missing or not finite");
    refuse_few();
  }

  // The sign of the strain is that of its largest change from the first row.
  void turn() {
    std::size_t far = 0;
    for (std::size_t i = 0; i < strain_.size(); ++i)
      if (std::abs(strain_[i] - strain_[0]) > std::abs(strain_[far] - strain_[0])) far = i;
    if (far == 0) throw InputError({}, "all points have the same strain; give a curve over strain");
    if (strain_[far] < strain_[0]) {
      for (double& each : strain_) each = 0.0 - each;
      for (double& each : stress_) each = 0.0 - each;
      fit_.notes.emplace_back("strain and stress are negative in compression; both signs changed");
      if (loading_ == UniaxialTest::Loading::tension)
        throw InputError({},
                         "the strain is negative, as in compression; leave `--loading tension` "
                         "out, or name another `--x`");
      loading_ = UniaxialTest::Loading::compression;
    }
    if (stress_[far] < stress_[0])
      throw InputError({},
                       "the stress falls as the strain grows; give `--compression auto`, which "
                       "turns the sign of a load, or name other columns");
    const auto size = strain_.size();
    const double back = strain_[far] - 0.1 * (strain_[far] - strain_[0]);
    const auto rest = strain_.begin() + static_cast<std::ptrdiff_t>(far);
    if (std::none_of(rest, strain_.end(), [&](double each) { return each < back; })) return;
    strain_.resize(far + 1);
    stress_.resize(far + 1);
    leave_out(size - strain_.size(), "the way back from the largest strain");
    refuse_few();
  }

  void keep_range() {
    const double low = test_.from.value_or(-std::numeric_limits<double>::infinity());
    const double high = test_.to.value_or(std::numeric_limits<double>::infinity());
    std::vector<double> x, y;
    first_strain_ = strain_.front();
    first_stress_ = stress_.front();
    for (std::size_t i = 0; i < strain_.size(); ++i) {
      if (strain_[i] < low - 1e-12 || strain_[i] > high + 1e-12) continue;
      x.push_back(strain_[i]);
      y.push_back(stress_[i]);
    }
    leave_out(strain_.size() - x.size(), "outside `--from` and `--to`");
    strain_ = std::move(x);
    stress_ = std::move(y);
    refuse_few();
    for (const double each : stress_) scale_ = std::max(scale_, std::abs(each));
    if (!(scale_ > 0.0))
      throw InputError({}, "the stress is 0 at every point; name another column by `--y`");
    for (double& each : stress_) each /= scale_;
  }

  // sigma = sigma_0 + E_tangent epsilon
  void line() {
    fit_.law =
        "tangent: slope of the line through the points; secant: from the first row to the "
        "largest strain";
    fit_.parameters = {{.name = "E_tangent", .unit = "kPa"}, {.name = "sigma_0", .unit = "kPa"}};
    const CurveAt curve = [&](std::span<const double> p, std::span<double> values,
                              std::span<double> slopes) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = p[0] * strain_[i] + p[1];
        if (slopes.empty()) continue;
        slopes[2 * i] = strain_[i];
        slopes[2 * i + 1] = 1.0;
      }
      return true;
    };
    const double guess = 1.0 / std::max(fit_.range_high - fit_.range_low, 1e-300);
    const Minimum minimum = minimise(stress_, curve, std::array{guess, 0.0}, 200);
    const std::array scale{unit::kPa.from_si(scale_), unit::kPa.from_si(scale_)};
    settle(fit_, minimum, {stress_, scale_, scale, test_.residuals});
    if (fit_.termination == Termination::failed) return;
    fit_.rmse = unit::kPa.from_si(fit_.rmse);
    // E_secant = (sigma(epsilon_2) - sigma_1) / (epsilon_2 - epsilon_1), with sigma(epsilon_2) of
    // the parabola through the points of the range
    const double end = unit::kPa.from_si(scale_ * parabola_at_end());
    const double width = fit_.range_high - first_strain_;
    Estimate secant{.name = "E_secant", .unit = "kPa"};
    secant.estimate = (end - unit::kPa.from_si(first_stress_)) / width;
    secant.std_error = std::sqrt(2.0) * fit_.rmse / width;
    secant.ci95_low = secant.estimate - 1.96 * secant.std_error;
    secant.ci95_high = secant.estimate + 1.96 * secant.std_error;
    fit_.parameters.push_back(secant);
    fit_.covariance.clear();
  }

  [[nodiscard]] double parabola_at_end() const {
    Eigen::MatrixXd powers(static_cast<Eigen::Index>(strain_.size()), 3);
    for (std::size_t i = 0; i < strain_.size(); ++i) {
      const double from_end = strain_[i] - fit_.range_high;
      powers.row(static_cast<Eigen::Index>(i)) << 1.0, from_end, from_end * from_end;
    }
    const Eigen::Map<const Eigen::VectorXd> stress(stress_.data(), powers.rows());
    return powers.colPivHouseholderQr().solve(stress)[0];
  }

  void large_strain() {
    if (loading_ == UniaxialTest::Loading::unknown)
      throw InputError({}, "the model `" + fit_.name +
                               "` differs between compression and tension, and both columns are "
                               "positive; give `--loading compression` or `--loading tension`");
    const double sign = loading_ == UniaxialTest::Loading::compression ? -1.0 : 1.0;
    for (const double each : strain_) {
      stretch_.push_back(1.0 + sign * each);
      if (!(stretch_.back() > 0.0))
        throw InputError({}, "a strain of " + rounded_text(each) +
                                 " leaves no height in compression; give engineering strain, with "
                                 "`--x-unit %` where it is written in percent");
    }
    const bool neo = test_.model == UniaxialTest::Model::neo_hookean;
    fit_.law = neo ? "P = E/3 (L - L^-2), neo-Hookean, incompressible"
                   : "P = 2 E/(3 alpha) (L^(alpha-1) - L^(-alpha/2-1)), Ogden 1972, incompressible";
    fit_.law += sign < 0.0 ? ", compression" : ", tension";
    fit_.parameters = {{.name = "E", .unit = "kPa"}};
    if (!neo) fit_.parameters.push_back({.name = "alpha", .unit = ""});
    const auto unit = [&](std::size_t i, double alpha) {
      UnitStress at = neo ? neo_hookean(stretch_[i]) : ogden(stretch_[i], alpha);
      return UnitStress{sign * at.value, sign * at.slope};
    };
    const auto [guess, alpha] = start(unit, neo);
    const std::size_t count = fit_.parameters.size();
    const double first = guess;
    const CurveAt curve = [&](std::span<const double> p, std::span<double> values,
                              std::span<double> slopes) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        const UnitStress at = unit(i, count > 1 ? p[1] : 0.0);
        values[i] = p[0] * first * at.value;
        if (slopes.empty()) continue;
        slopes[i * count] = first * at.value;
        if (count > 1) slopes[i * count + 1] = p[0] * first * at.slope;
      }
      return true;
    };
    std::vector<double> unknowns{1.0, alpha};
    std::vector<double> scale{unit::kPa.from_si(first * scale_), 1.0};
    unknowns.resize(count);
    scale.resize(count);
    const Minimum minimum = minimise(stress_, curve, unknowns, 400);
    settle(fit_, minimum, {stress_, scale_, scale, test_.residuals});
    fit_.rmse = unit::kPa.from_si(fit_.rmse);
  }

  struct Start {
    double factor, alpha;
  };
  template <class Unit>
  Start start(const Unit& unit, bool neo) const {
    Start best{1.0, 2.0};
    double least = std::numeric_limits<double>::infinity();
    for (double alpha = -40.25; alpha <= 40.5; alpha += 0.5) {
      double product = 0.0;
      double norm = 0.0;
      double total = 0.0;
      for (std::size_t i = 0; i < stress_.size(); ++i) {
        const double value = unit(i, alpha).value;
        product += value * stress_[i];
        norm += value * value;
        total += stress_[i] * stress_[i];
      }
      const double squares = total - product * product / norm;
      if (!std::isfinite(squares) || !(squares < least)) continue;
      least = squares;
      best = {product / norm, alpha};
      if (neo) break;
    }
    return best;
  }

  // Gent and Lindley's factor divides every modulus.
  void platens() {
    if (!test_.shape_factor) return;
    const double factor = gent_lindley(*test_.shape_factor);
    for (Estimate& one : fit_.parameters) {
      if (one.name == "alpha" || one.name == "sigma_0") continue;
      for (double* value : {&one.estimate, &one.std_error, &one.ci95_low, &one.ci95_high})
        *value /= factor;
    }
    fit_.law += ", divided by 1 + 2 S^2 = " + rounded_text(factor) +
                " of bonded platens, Gent and Lindley 1959, for nu = 1/2";
    if (fit_.range_high > 0.1 && factor > 1.05)
      fit_.warnings.push_back(
          "the factor of bonded platens is one of small strain, and the curve "
          "reaches a strain of " +
          rounded_text(fit_.range_high, 2) + "; give a smaller `--to`");
  }

  const UniaxialTest& test_;
  UniaxialTest::Loading loading_;
  Fit fit_;
  std::vector<double> strain_;
  std::vector<double> stress_;  // divided by scale_ once the range is chosen
  std::vector<double> stretch_;
  double first_strain_ = 0.0;
  double first_stress_ = 0.0;  // Pa
  double scale_ = 0.0;         // Pa
};

}  // namespace

double gent_lindley(double shape_factor) { return 1.0 + 2.0 * shape_factor * shape_factor; }

Fit fit_uniaxial(std::span<const double> strain, std::span<const double> stress,
                 const UniaxialTest& test) {
  assert(strain.size() == stress.size());
  return UniaxialFit(strain, stress, test).all();
}

}  // namespace palpate::fit
