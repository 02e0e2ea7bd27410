// Rows in contact and free rows are told apart by the pull-off; then all unknowns by Ceres.
#include "fit/contact_model.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "fit/ceres_fit.h"
#include "fit/parts.h"
#include "fit/residuals.h"

namespace palpate::fit {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double low_tabor = 0.1;   // DMT below, JKR above the other: Johnson and Greenwood 1997,
constexpr double high_tabor = 5.0;  // J. Colloid Interface Sci. 192, their map
const Unit adhesion_unit{"mJ/m^2", "work of adhesion", {1, 1e3, {0, 1, -2}}};

// x = a / a_c >= 1 of JKR: x^2 - 4 sqrt(x) = d, h = d a_c^2 / R, a_c^3 = pi w R^2 / (8 E*). The
// left side is convex, and Newton's steps from the right of the root do not pass it.
double contact_over_least(double d) {
  if (!(d > -3.0)) return 1.0;
  double x = 2.6 + std::sqrt(std::max(d, 0.0));
  for (int i = 0; i < 60; ++i) {
    const double root = std::sqrt(x);
    const double next = std::max(1.0, x - (x * x - 4.0 * root - d) / (2.0 * x - 2.0 / root));
    if (!(x - next > 1e-15 * x)) break;
    x = next;
  }
  return x;
}

double contact_scale(double radius, double modulus, double work) {
  return std::cbrt(pi * work * radius * radius / (8.0 * modulus));
}

AdhesiveForce jkr(double radius, double modulus, double work, double depth) {
  const double a = contact_scale(radius, modulus, work);
  const double d = depth * radius / (a * a);
  const double x = contact_over_least(d);
  const double cubed = x * std::sqrt(x);
  const double unit = pi * radius / 6.0;  // F = pi w R / 6 (x^3 - 6 x^(3/2))
  const double g = cubed * cubed - 6.0 * cubed;
  const bool open = !(d > -3.0);
  const double by_d =
      open ? 0.0 : (3.0 * x * x - 9.0 * std::sqrt(x)) / (2.0 * x - 2.0 / std::sqrt(x));
  // d depends on E* and w as (E*/w)^(2/3).
  return {unit * work * g, unit * work * by_d * d * 2.0 / 3.0 / modulus,
          unit * (g - by_d * d * 2.0 / 3.0), unit * work * by_d * radius / (a * a)};
}

AdhesiveForce dmt(double radius, double modulus, double work, double depth) {
  const double root = std::sqrt(radius * std::max(depth, 0.0));
  const double hertz = 4.0 / 3.0 * root * std::max(depth, 0.0);
  const double unit = -2.0 * pi * radius;
  return {modulus * hertz + unit * work, hertz, unit, 2.0 * modulus * root};
}

struct PulledCurve {
  std::vector<double> depth, force;
  std::size_t attached = 0;  // the first rows are in contact, the others are free
};

class AdhesiveFit {
 public:
  AdhesiveFit(std::span<const double> depth, std::span<const double> force, const ContactTest& test,
              Adhesion law)
      : test_(test), law_(law) {
    fit_.name = law == Adhesion::jkr ? "jkr" : "dmt";
    fit_.law = law == Adhesion::jkr
                   ? "h-h_0 = a^2/R - sqrt(2 pi a w/E*), F = 4 E* a^3/(3 R) - sqrt(8 pi w E* a^3), "
                     "E* = E/(1-nu^2), Johnson, Kendall and Roberts 1971"
                   : "F = 4/3 E/(1-nu^2) sqrt(R) (h-h_0)^(3/2) - 2 pi R w, Derjaguin, Muller and "
                     "Toporov 1975";
    take(depth, force);
    divide();
  }

  // Also returns E* in Pa and w in J/m^2, for Tabor's number.
  Fit all(double& modulus, double& work) {
    const bool tilt = test_.baseline == ContactTest::BaselineChoice::tilt;
    const bool none = test_.baseline == ContactTest::BaselineChoice::none;
    const std::size_t count = none ? 3 : tilt ? 4 + 1 : 4;
    const auto [low, high] = std::ranges::minmax_element(curve_.depth);
    const double range = *high - *low;
    const std::array guess = guessed();
    std::vector<double> start{1.0, 1.0, guess[2] / range, none ? 0.0 : level_, 0.0};
    start.resize(count);
    const double lowest = *low;
    const CurveAt at = [&](std::span<const double> p, std::span<double> values,
                           std::span<double> slopes) {
      if (!(p[0] > 0.0) || !(p[1] > 0.0)) return false;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double along = (curve_.depth[i] - lowest) / range;
        AdhesiveForce force;
        if (i < curve_.attached)
          force = adhesive_force(law_, test_.radius, p[0] * guess[0], p[1] * guess[1],
                                 curve_.depth[i] - p[2] * range);
        values[i] = force.force / scale_;
        if (count > 3) values[i] += p[3];
        if (count > 4) values[i] += p[4] * along;
        if (slopes.empty()) continue;
        double* row = &slopes[i * count];
        row[0] = force.by_modulus * guess[0] / scale_;
        row[1] = force.by_work * guess[1] / scale_;
        row[2] = -force.by_depth * range / scale_;
        if (count > 3) row[3] = 1.0;
        if (count > 4) row[4] = along;
      }
      return true;
    };
    const Minimum minimum = minimise(curve_.force, at, start, {.max_iterations = 400});
    const double share = 1.0 - test_.poisson_ratio * test_.poisson_ratio;
    std::vector<double> scale{unit::kPa.from_si(guess[0] * share), adhesion_unit.from_si(guess[1]),
                              unit::mm.from_si(range), scale_, scale_ / unit::mm.from_si(range)};
    scale.resize(count);
    fit_.parameters = {{.name = "E", .unit = "kPa"},
                       {.name = "w", .unit = adhesion_unit.symbol},
                       {.name = "h_0", .unit = "mm"},
                       {.name = "F_0", .unit = "N"},
                       {.name = "tilt", .unit = "N/mm"}};
    fit_.parameters.resize(count);
    fit_.n = static_cast<int>(curve_.depth.size());
    fit_.range_low = unit::mm.from_si(*low);
    fit_.range_high = unit::mm.from_si(*high);
    settle(fit_, minimum, {curve_.force, scale_, scale, test_.residuals});
    if (fit_.termination == Termination::failed) return std::move(fit_);
    modulus = minimum.parameters[0] * guess[0];
    work = minimum.parameters[1] * guess[1];
    fit_.law += with_baseline(none ? Baseline::none : tilt ? Baseline::tilt : Baseline::offset);
    fit_.notes.push_back(
        std::to_string(curve_.attached) + " points are in contact and " +
        std::to_string(curve_.depth.size() - curve_.attached) +
        " are free; the pull-off force is " +
        rounded_text((law_ == Adhesion::jkr ? 1.5 : 2.0) * pi * work * test_.radius) + " N");
    warn_of_residuals(fit_);
    return std::move(fit_);
  }

 private:
  void take(std::span<const double> depth, std::span<const double> force) {
    for (std::size_t i = 0; i < depth.size(); ++i) {
      if (!std::isfinite(depth[i]) || !std::isfinite(force[i])) continue;
      curve_.depth.push_back(depth[i]);
      curve_.force.push_back(force[i]);
    }
    const std::size_t finite = curve_.depth.size();
    need_points(fit_.name, 8, finite);
    const auto part = one_way(curve_.depth, test_.way);
    for (std::vector<double>* each : {&curve_.depth, &curve_.force})
      *each = {each->begin() + static_cast<std::ptrdiff_t>(part.from),
               each->begin() + static_cast<std::ptrdiff_t>(part.to)};
    // From the deepest row to the free ones, as the tip withdraws.
    if (curve_.depth.front() < curve_.depth.back())
      for (std::vector<double>* each : {&curve_.depth, &curve_.force}) std::ranges::reverse(*each);
    fit_.excluded = static_cast<int>(depth.size() - finite);
    leave_out(fit_, finite - curve_.depth.size(),
              test_.way == ContactTest::Way::approach
                  ? "the way back from the deepest row"
                  : "the way to the deepest row; `--segment approach` fits it");
    scale_ = scale_to_one(curve_.force, no_force);
  }

  // The rows after the pull-off: from the first row behind the least force that has come back by
  // more than 70 % of it. (JKR's contact opens at 5/9 of the pull-off force.)
  void divide() {
    const std::vector<double>& force = curve_.force;
    const auto least = std::ranges::min_element(force);
    const auto at = static_cast<std::size_t>(least - force.begin());
    const bool zeroed = test_.baseline == ContactTest::BaselineChoice::none;
    const auto some = static_cast<std::ptrdiff_t>(std::max<std::size_t>(3, force.size() / 10));
    level_ = zeroed ? 0.0 : median({force.end() - some, force.end()});
    pull_ = level_ - *least;
    std::size_t end = at;
    while (end < force.size() && force[end] < level_ - 0.3 * pull_) ++end;
    curve_.attached = end;
    const std::size_t free = force.size() - end;
    const double noise = noise_of(force);
    if (!(pull_ > 5.0 * noise) || !(pull_ > 1e-6))
      throw InputError({}, "the force shows no pull-off: its least value is " +
                               rounded_text(pull_ * scale_) +
                               " N below the rows at the end, and the scatter of the rows is " +
                               rounded_text(noise * scale_) +
                               " N; give the way back of the curve, or fit `hertz`");
    if (!zeroed && (free < 3 || (!jumps(at, end) && drifts(end))))
      throw InputError(
          {},
          "the curve ends before the contact opens, so that the zero of the force is not known; "
          "record rows after the pull-off, or give `--baseline none` if the force is zeroed");
    if (end < 5)
      throw InputError(
          {},
          "only " + std::to_string(end) +
              " points are in contact, too few for E, w and the contact point; record more points");
  }

  // Whether the force comes back from one row to the next, as where a contact opens.
  [[nodiscard]] bool jumps(std::size_t least, std::size_t end) const {
    for (std::size_t i = least; i < end; ++i)
      if (curve_.force[i + 1] - curve_.force[i] > 0.3 * pull_) return true;
    return false;
  }

  // Whether the rows behind the pull-off go on to change, so that they are not free.
  [[nodiscard]] bool drifts(std::size_t end) const {
    const std::size_t middle = (end + curve_.force.size()) / 2;
    std::array<double, 2> mean{};
    for (std::size_t i = end; i < curve_.force.size(); ++i)
      (i < middle ? mean[0] : mean[1]) += curve_.force[i];
    mean[0] /= static_cast<double>(middle - end);
    mean[1] /= static_cast<double>(curve_.force.size() - middle);
    return std::abs(mean[1] - mean[0]) > 0.15 * pull_;
  }

  // E* (Pa), w (J/m^2) and h_0 (m), from the deepest row, the least force and its depth.
  [[nodiscard]] std::array<double, 3> guessed() const {
    const auto at =
        static_cast<std::size_t>(std::ranges::min_element(curve_.force) - curve_.force.begin());
    const double pull = pull_ * scale_;
    const double most = std::max((curve_.force.front() - level_) * scale_, 0.1 * pull);
    const double way = std::max(curve_.depth.front() - curve_.depth[at],
                                1e-3 * std::abs(curve_.depth.front() - curve_.depth.back()));
    if (law_ == Adhesion::dmt) {
      const double work = pull / (2.0 * pi * test_.radius);
      return {(most + pull) / (4.0 / 3.0 * std::sqrt(test_.radius) * way * std::sqrt(way)), work,
              curve_.depth.front() - way};
    }
    const double work = pull / (1.5 * pi * test_.radius);
    // (x^3 - 6 x^(3/2)) pi w R / 6 = F, solved for x^(3/2); at the least force x^(3/2) = 3.
    const double cubed = 3.0 + std::sqrt(9.0 + 6.0 * most / (pi * work * test_.radius));
    const auto depth_at = [](double power) {
      const double x = std::cbrt(power * power);
      return x * x - 4.0 * std::sqrt(x);
    };
    const double scale = way / (depth_at(cubed) - depth_at(3.0));  // a_c^2 / R
    const double a = std::sqrt(scale * test_.radius);
    return {pi * work * test_.radius * test_.radius / (8.0 * a * a * a), work,
            curve_.depth.front() - depth_at(cubed) * scale};
  }

  const ContactTest& test_;
  Adhesion law_;
  Fit fit_;
  PulledCurve curve_;  // forces divided by scale_
  double scale_ = 0.0;
  double level_ = 0.0;  // of the free rows
  double pull_ = 0.0;   // the least force below that level
};

}  // namespace

AdhesiveForce adhesive_force(Adhesion law, double radius, double modulus, double work,
                             double depth) {
  return law == Adhesion::dmt ? dmt(radius, modulus, work, depth)
                              : jkr(radius, modulus, work, depth);
}

double tabor_number(double radius, double modulus, double work, double distance) {
  return std::cbrt(radius * work * work / (modulus * modulus)) / distance;
}

Fit fit_adhesive(std::span<const double> depth, std::span<const double> force,
                 const ContactTest& test, const AdhesiveTest& adhesion) {
  assert(depth.size() == force.size());
  double modulus = 0.0;
  double work = 0.0;
  const bool asked = adhesion.law != Adhesion::by_tabor;
  Fit fit =
      AdhesiveFit(depth, force, test, asked ? adhesion.law : Adhesion::jkr).all(modulus, work);
  if (fit.termination == Termination::failed || !(modulus > 0.0)) return fit;
  const double middle = std::sqrt(low_tabor * high_tabor);
  const double tabor = tabor_number(test.radius, modulus, work, adhesion.distance);
  const bool soft = tabor >= middle;
  if (!asked && !soft) fit = AdhesiveFit(depth, force, test, Adhesion::dmt).all(modulus, work);
  const std::string number = "Tabor's number is " + rounded_text(tabor, 3) + " (atoms " +
                             rounded_text(1e9 * adhesion.distance) + " nm apart at rest)";
  const char* fitting = soft ? "`jkr` of soft, large, sticky contacts"
                             : "`dmt` of stiff, small, weakly sticking contacts";
  if (!asked)
    fit.notes.push_back(number + ", which chooses " + fitting);
  else if (soft == (adhesion.law == Adhesion::jkr))
    fit.notes.push_back(number + ", for which this is the law");
  else
    fit.warnings.push_back(number + ", which asks for " + fitting);
  if (tabor > low_tabor && tabor < high_tabor)
    fit.warnings.push_back(
        number + ": between " + rounded_text(low_tabor) + " and " + rounded_text(high_tabor) +
        " neither law holds, and w is wrong by up to a third, which its interval does not contain");
  return fit;
}

}  // namespace palpate::fit
