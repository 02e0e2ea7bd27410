// The history is linear between its knots, and the integrals of E(t) over each are in closed form.
#include "fit/contact_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"
#include "base/units.h"
#include "fit/ceres_fit.h"
#include "fit/residuals.h"

namespace palpate::fit {
namespace {

constexpr std::size_t most_knots = 400;

// int_0^t E(s) / amplitude ds; times in units of the record's length.
struct Kernel {
  Viscous model = Viscous::power_law;
  double beta = 0.0;              // of the power law
  double tau = 1.0, ratio = 1.0;  // of the solid: E_0 / E_inf

  [[nodiscard]] double integral(double t) const {
    if (model == Viscous::power_law) return std::pow(t, 1.0 - beta) / (1.0 - beta);
    return t - (ratio - 1.0) * tau * std::expm1(-t / tau);
  }
};

struct Knots {
  std::vector<double> time, depth;  // in units of the record's length and of the depth's range
  std::size_t deepest = 0;
};

// The force at the knots for E of amplitude 1 and a factor 4/3 sqrt(R) of 1.
class History {
 public:
  History(const Knots& knots, double contact) : knots_(knots) {
    const std::size_t n = knots.time.size();
    for (const double each : knots.depth) {
      const double depth = std::max(each - contact, 0.0);
      powers_.push_back(depth * std::sqrt(depth));
    }
    // The last knot before contact on the way in.
    while (first_ + 1 < n && knots.depth[first_ + 1] <= contact) ++first_;
    for (std::size_t i = first_; i <= knots.deepest; ++i)
      if (knots.depth[i] <= contact) first_ = i;
    start_ = knots.time[first_];
    if (first_ + 1 < n && knots.depth[first_] < contact) {
      const double part =
          (contact - knots.depth[first_]) / (knots.depth[first_ + 1] - knots.depth[first_]);
      start_ += part * (knots.time[first_ + 1] - start_);
    }
    contact_ = contact;
  }

  void force(const Kernel& kernel, std::vector<double>& out) const {
    const std::size_t n = knots_.time.size();
    out.assign(n, 0.0);
    std::vector<double> lag(n);
    for (std::size_t i = first_ + 1; i < n; ++i) {
      const double t = knots_.time[i];
      for (std::size_t j = first_; j <= i; ++j)
        lag[j] = kernel.integral(t - (j == first_ ? start_ : knots_.time[j]));
      // On the way back, t1: the piece, and the part of it that has been loaded by then.
      std::size_t piece = i;
      double left = 0.0;  // int of E dh over the pieces from t1 on
      if (i > knots_.deepest) {
        double before = 0.0;
        while (piece > first_) {
          const double more = rate(knots_.depth, piece) * (lag[piece - 1] - lag[piece]);
          if (piece <= knots_.deepest && before + more >= 0.0) break;
          before += more;
          --piece;
        }
        if (piece == first_) continue;  // the contact has opened
        left = -before;
      }
      double sum = 0.0;
      for (std::size_t j = first_ + 1; j < piece; ++j)
        sum += rate(powers_, j) * (lag[j - 1] - lag[j]);
      if (i <= knots_.deepest)
        sum += rate(powers_, piece) * (lag[piece - 1] - lag[piece]);
      else  // from the piece's beginning to t1
        sum +=
            rate(powers_, piece) * (lag[piece - 1] - lag[piece] - left / rate(knots_.depth, piece));
      out[i] = sum;
    }
  }

 private:
  // The slope of `values` in piece j, from knot j - 1 to knot j.
  [[nodiscard]] double rate(const std::vector<double>& values, std::size_t j) const {
    const bool begins = j == first_ + 1;
    const double from = begins ? start_ : knots_.time[j - 1];
    const double value = begins
                             ? (&values == &knots_.depth ? std::max(contact_, values[j - 1]) : 0.0)
                             : values[j - 1];
    return (values[j] - value) / std::max(knots_.time[j] - from, 1e-12);
  }

  const Knots& knots_;
  std::vector<double> powers_;  // h^(3/2)
  std::size_t first_ = 0;       // the last knot before contact
  double start_ = 0.0;          // time of contact
  double contact_ = 0.0;
};

class ViscousFit {
 public:
  ViscousFit(const ContactTest& test, Viscous model) : test_(test), model_(model) {
    fit_.name = model == Viscous::power_law ? "hertz_power_law" : "hertz_solid";
  }

  Fit all(std::span<const double> time, std::span<const double> depth,
          std::span<const double> force) {
    take(time, depth, force);
    const PressRows rows{depth_, force_, 0.0, 1.0};
    const UnitLaw law = [](double h) {
      return TipForce{h > 0.0 ? h * std::sqrt(h) : 0.0, h > 0.0 ? 1.5 * std::sqrt(h) : 0.0};
    };
    const auto guess =
        search_contact(law,
                       {{depth_.begin(), depth_.begin() + static_cast<std::ptrdiff_t>(in_)},
                        {force_.begin(), force_.begin() + static_cast<std::ptrdiff_t>(in_)},
                        0.0,
                        1.0},
                       Baseline::offset, {2.0});
    if (!guess || !(guess->factor > 0.0))
      throw InputError({},
                       "the load does not grow with depth, so that the curve shows no contact; "
                       "name other columns, or give `--compression auto`");
    using Asked = ContactTest::BaselineChoice;
    const bool offset = test_.baseline == Asked::offset ||
                        (test_.baseline == Asked::automatic && guess->before >= 3);
    Separable curve;
    curve.linear = offset ? 2 : 1;
    for (const double away : {-0.1, -0.05, -0.02, 0.0, 0.02, 0.05})
      if (model_ == Viscous::power_law) {
        for (const double logit : {-3.5, -1.5, -0.5, 0.5})
          curve.starts.push_back({guess->contact + away, logit});
      } else {
        for (const double tau : {-4.0, -2.5, -1.0, 0.5})
          for (const double ratio : {-1.0, 0.7, 2.0})
            curve.starts.push_back({guess->contact + away, tau, ratio});
      }
    std::vector<double> at_knots;
    curve.columns = [&](std::span<const double> s, std::span<double> phi) {
      if (!(s[0] < 0.95) || !(s[0] > -1.0)) return false;
      History(knots_, s[0]).force(kernel_of(s), at_knots);
      for (std::size_t i = 0; i < time_.size(); ++i) {
        const double value = between(at_knots, i);
        phi[i * curve.linear] = value;
        if (offset) phi[i * curve.linear + 1] = 1.0;
      }
      return true;
    };
    Minimum minimum = minimise(force_, curve, 200);
    finish(std::move(minimum), offset);
    return std::move(fit_);
  }

 private:
  // `to`, or the end of a hold that begins there, whose force tells most of the law: three times as
  // many rows near the deepest one as before it. A finger that turns back has as many.
  [[nodiscard]] std::size_t with_hold(std::size_t to) const {
    constexpr double near = 0.98;  // of the range: what a stand may wander while it holds
    const auto [low, high] = std::ranges::minmax_element(depth_);
    const double deep = *low + near * (*high - *low);
    std::size_t begin = to, end = to;
    while (begin > 0 && depth_[begin - 1] >= deep) --begin;
    while (end < depth_.size() && depth_[end] >= deep) ++end;
    return end - to > 3 * (to - begin) ? end : to;
  }
  [[nodiscard]] Kernel kernel_of(std::span<const double> s) const {
    Kernel kernel;
    kernel.model = model_;
    if (model_ == Viscous::power_law) {
      kernel.beta = 1.0 / (1.0 + std::exp(-s[1]));
    } else {
      kernel.tau = std::exp(s[1]);
      kernel.ratio = 1.0 + std::exp(s[2]);
    }
    return kernel;
  }

  void take(std::span<const double> time, std::span<const double> depth,
            std::span<const double> force) {
    for (std::size_t i = 0; i < time.size(); ++i) {
      if (!std::isfinite(time[i]) || !std::isfinite(depth[i]) || !std::isfinite(force[i])) continue;
      if (!time_.empty() && !(time[i] > time_.back()))
        throw InputError({}, "the times do not ascend; give one test by `--rows` or `--segment`");
      time_.push_back(time[i]);
      depth_.push_back(depth[i]);
      force_.push_back(force[i]);
    }
    need_points(fit_.name, 10, time_.size());
    OneWay part = one_way(depth_, test_.way);
    if (test_.way == Way::approach) part.to = with_hold(part.to);
    fit_.excluded = static_cast<int>(time.size() - time_.size());
    leave_out(
        fit_, time_.size() - part.to,
        "the way back from the deepest rows; `--segment all` fits both ways, by Ting's contact");
    for (std::vector<double>* each : {&time_, &depth_, &force_}) each->resize(part.to);
    const auto [low, high] = std::ranges::minmax_element(depth_);
    low_ = *low;
    range_ = *high - *low;
    if (!(range_ > 0.0))
      throw InputError({}, "all points have the same depth; give a curve over depth");
    fit_.range_low = unit::mm.from_si(*low);
    fit_.range_high = unit::mm.from_si(*high);
    in_ = as_index(high - depth_.begin()) + 1;
    begin_ = time_.front();
    length_ = time_.back() - begin_;
    scale_ = scale_to_one(force_, no_force);
    for (std::size_t i = 0; i < time_.size(); ++i) {
      time_[i] = (time_[i] - begin_) / length_;
      depth_[i] = (depth_[i] - low_) / range_;
    }
    const std::size_t count = std::min(time_.size(), most_knots);
    knots_.time = block_means(time_, count);
    knots_.depth = block_means(depth_, count);
    knots_.deepest = as_index(std::ranges::max_element(knots_.depth) - knots_.depth.begin());
    for (const double t : time_) {
      const auto right = std::clamp(std::ranges::upper_bound(knots_.time, t),
                                    knots_.time.begin() + 1, knots_.time.end() - 1);
      right_.push_back(as_index(right - knots_.time.begin()));
    }
  }

  [[nodiscard]] double between(const std::vector<double>& values, std::size_t i) const {
    const std::size_t k = right_[i];
    const double part = (time_[i] - knots_.time[k - 1]) / (knots_.time[k] - knots_.time[k - 1]);
    return values[k - 1] + part * (values[k] - values[k - 1]);
  }

  // Search: factor, [offset], contact, shapes. Result: moduli and shapes, contact, [offset].
  void finish(Minimum minimum, bool offset) {
    const bool power = model_ == Viscous::power_law;
    fit_.law = std::string("F = 4 sqrt(R)/(3 (1-nu^2)) int E(t-s) d(h-h_0)^(3/2), E(t) = ") +
               (power ? "E_1 (t/1 s)^-beta" : "E_inf + (E_0 - E_inf) e^(-t/tau)") +
               (in_ < time_.size() ? ", Lee and Radok 1960, Ting 1966" : ", Lee and Radok 1960") +
               with_baseline(offset ? Baseline::offset : Baseline::none);
    if (power)
      fit_.parameters = {{.name = "E_1", .unit = "kPa"}, {.name = "beta"}};
    else
      fit_.parameters = {{.name = "E_inf", .unit = "kPa"},
                         {.name = "E_0", .unit = "kPa"},
                         {.name = "tau", .unit = "s"}};
    const std::size_t moduli = fit_.parameters.size();
    fit_.parameters.push_back({.name = "h_0", .unit = "mm"});
    if (offset) fit_.parameters.push_back({.name = "F_0", .unit = "N"});
    const std::size_t count = fit_.parameters.size();
    fit_.n = static_cast<int>(time_.size());
    std::vector<double> scale(count, 1.0);
    std::vector<double> add(count, 0.0);
    if (minimum.status != Minimum::Status::failed) {
      // E amplitude: F / scale = c int ..., lengths in ranges and times in record lengths.
      const double young = unit::kPa.from_si(scale_ * 3.0 / 4.0 / std::sqrt(test_.radius) /
                                             (range_ * std::sqrt(range_)) *
                                             (1.0 - test_.poisson_ratio * test_.poisson_ratio));
      reorder(minimum, offset);
      scale[0] = young;
      if (power) {
        const double beta = 1.0 / (1.0 + std::exp(-minimum.parameters[1]));
        replace_parameter(minimum, 1, beta, beta * (1.0 - beta));
        // E_1 = c L^beta for times in units of L.
        add_to_parameter(minimum, 0, 1, std::log(length_) * minimum.parameters[0]);
        scale[0] *= std::pow(length_, beta);
      } else {
        // E_0 = E_inf (1 + e^s) takes the place of s, then tau that of its logarithm.
        const double inf = minimum.parameters[0];
        const double over = std::exp(minimum.parameters[1]);
        replace_parameter(minimum, 1, inf * (1.0 + over), inf * over);
        add_to_parameter(minimum, 1, 0, 1.0 + over);
        const double tau = std::exp(minimum.parameters[2]);
        replace_parameter(minimum, 2, tau, tau);
        scale[1] = young;
        scale[2] = length_;
      }
      scale[moduli] = unit::mm.from_si(range_);
      add[moduli] = unit::mm.from_si(low_);
      if (offset) scale[moduli + 1] = scale_;
    }
    settle(fit_, minimum, {force_, scale_, scale, test_.residuals});
    if (fit_.termination == Termination::failed) return;
    for (std::size_t i = 0; i < count; ++i)
      for (double* each : {&fit_.parameters[i].estimate, &fit_.parameters[i].ci95_low,
                           &fit_.parameters[i].ci95_high})
        *each += add[i];
    if (!(fit_.parameters[0].estimate > 0.0))
      throw InputError({},
                       "the load does not grow with depth, so that the curve shows no contact; "
                       "name other columns, or give `--compression auto`");
    const double contact = (minimum.parameters[moduli] * range_);
    const double deepest = range_ - contact;
    const double error = error_of_hertz(deepest, test_.radius);
    if (error > 0.02)
      fit_.warnings.push_back("at the largest depth Hertz's law of a paraboloid is " +
                              percent_text(error) +
                              " stiffer than the exact law of a sphere; give the rows up to a "
                              "smaller depth by `--rows`");
    warn_of_residuals(fit_);
  }

  // From factor, [offset], contact, shapes to factor, shapes (the solid's ratio first), contact,
  // [offset].
  void reorder(Minimum& minimum, bool offset) const {
    const std::size_t at = offset ? 2 : 1;  // of the contact
    std::vector<std::size_t> from{0};
    if (model_ == Viscous::power_law)
      from.push_back(at + 1);
    else
      from.insert(from.end(), {at + 2, at + 1});
    from.push_back(at);
    if (offset) from.push_back(1);
    reorder_parameters(minimum, from);
  }

  const ContactTest& test_;
  Viscous model_;
  Fit fit_;
  std::vector<double> time_, depth_, force_;  // scaled to order one
  std::size_t in_ = 0;                        // rows up to the deepest one
  double low_ = 0.0, range_ = 0.0;            // m
  double begin_ = 0.0, length_ = 1.0;         // s
  double scale_ = 0.0;                        // N
  Knots knots_;
  std::vector<std::size_t> right_;  // the knot at or after each row
};

}  // namespace

Fit fit_viscous(std::span<const double> time, std::span<const double> depth,
                std::span<const double> force, const ContactTest& test, Viscous model) {
  assert(time.size() == depth.size() && depth.size() == force.size());
  return ViscousFit(test, model).all(time, depth, force);
}

}  // namespace palpate::fit
