// The stress is proportional to E; Ogden's exponent is searched on a grid first.
#include "fit/uniaxial.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/dense.h"
#include "base/error.h"
#include "base/index.h"
#include "base/text.h"
#include "base/units.h"
#include "contact/platens.h"
#include "fit/ceres_fit.h"
#include "fit/parts.h"
#include "fit/residuals.h"

namespace palpate::fit {
namespace {

// Nominal stress for E = 1 Pa at a stretch.
double neo_hookean(double stretch) { return (stretch - 1.0 / (stretch * stretch)) / 3.0; }

// P = 2/(3 alpha) (L^(alpha-1) - L^(-alpha/2-1)) for E = 3 mu = 1, and for alpha -> 0 its limit
// ln L / L.
double ogden(double stretch, double alpha) {
  const double log = std::log(stretch);
  if (std::abs(alpha) < 1e-4) return (log + 0.25 * alpha * log * log) / stretch;
  return 2.0 / (3.0 * alpha) *
         (std::pow(stretch, alpha - 1.0) - std::pow(stretch, -0.5 * alpha - 1.0));
}

// phi_k of a sum of terms.
//   yeoh    P = 2 (L - L^-2) (C1 + 2 C2 (I1-3) + 3 C3 (I1-3)^2), I1 = L^2 + 2/L, E = 6 C1
//   ogden3  P = sum mu_k (L^(alpha_k-1) - L^(-alpha_k/2-1))
double term(UniaxialTest::Model model, double stretch, std::size_t k, double alpha) {
  using Model = UniaxialTest::Model;
  if (model == Model::ogden) return ogden(stretch, alpha);
  if (model == Model::ogden3)
    return std::pow(stretch, alpha - 1.0) - std::pow(stretch, -0.5 * alpha - 1.0);
  const double base = neo_hookean(stretch);
  if (k == 0) return base;
  const double over = stretch * stretch + 2.0 / stretch - 3.0;
  return k == 1 ? 12.0 * base * over : 18.0 * base * over * over;
}

const char* word(UniaxialTest::Model model) {
  static constexpr std::array words{"modulus", "neo_hookean", "ogden", "yeoh", "ogden3"};
  return words[as_index(model)];
}

const char* law(UniaxialTest::Model model) {
  static constexpr std::array laws{
      "", "P = E/3 (L - L^-2), neo-Hookean, incompressible",
      "P = 2 E/(3 alpha) (L^(alpha-1) - L^(-alpha/2-1)), Ogden 1972, incompressible",
      "P = (L - L^-2) (E/3 + 4 C2 (I1-3) + 6 C3 (I1-3)^2), Yeoh 1993, incompressible",
      "P = sum mu_k (L^(alpha_k-1) - L^(-alpha_k/2-1)), E = 3/2 sum mu_k alpha_k, Ogden 1972, "
      "incompressible"};
  return laws[as_index(model)];
}

constexpr double fall_share = 0.1;  // of the rise of the stress: the end of the loading part

class UniaxialFit {
 public:
  UniaxialFit(std::span<const double> strain, std::span<const double> stress,
              const UniaxialTest& test)
      : test_(test), loading_(test.loading) {
    fit_.name = word(test.model);
    take(strain, stress);
    turn();
    cut();
    take_loading();
    end_at_fall();
    if (test_.toe)
      take_off_toe();
    else if (const auto found = toe())
      end_of_toe_ = found->strain;
    keep_range();
  }

  // m/m, where there is one and it stays.
  [[nodiscard]] std::optional<double> end_of_toe() const { return end_of_toe_; }

  Fit all() {
    fit_.n = static_cast<int>(strain_.size());
    fit_.range_low = *std::ranges::min_element(strain_);
    fit_.range_high = *std::ranges::max_element(strain_);
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
  void refuse_few() const {
    need_points(fit_.name, 4, strain_.size(), "",
                "; widen `--from` and `--to`, or record more points");
  }

  void take(std::span<const double> strain, std::span<const double> stress) {
    for (std::size_t i = 0; i < strain.size(); ++i) {
      if (!std::isfinite(strain[i]) || !std::isfinite(stress[i])) continue;
      strain_.push_back(strain[i]);
      stress_.push_back(stress[i]);
    }
    leave_out(fit_, strain.size() - strain_.size(), "a number is missing or not finite");
    refuse_few();
  }

  // The sign of the strain is that of its largest change from the first row, unless the rows lie on
  // both sides of zero: compression and tension are one law.
  void turn() {
    const auto [least, most] = std::ranges::minmax_element(strain_);
    if (*least == *most)
      throw InputError({}, "all points have the same strain; give a curve over strain");
    both_ = std::min(-*least, *most) > 0.1 * std::max(-*least, *most) && grows_through_zero();
    if (both_) {
      if (test_.model == UniaxialTest::Model::modulus) {
        both_ = false;
        const std::size_t size = strain_.size();
        const bool tension = loading_ != UniaxialTest::Loading::compression;
        keep([&](std::size_t i) { return tension ? strain_[i] >= 0.0 : strain_[i] <= 0.0; });
        leave_out(fit_, size - strain_.size(),
                  tension ? "in compression; `--loading compression` fits it" : "in tension");
        refuse_few();
        return turn_to_positive();
      }
      if (loading_ == UniaxialTest::Loading::unknown) loading_ = UniaxialTest::Loading::tension;
      fit_.notes.emplace_back(std::string("the curve has tension and compression, which are fitted "
                                          "together; positive strains are ") +
                              (loading_ == UniaxialTest::Loading::tension
                                   ? "tension; `--loading compression` turns them"
                                   : "compression"));
      return;
    }
    turn_to_positive();
  }

  // Whether the stress has the sign of the strain on both sides, as that of one law through zero.
  [[nodiscard]] bool grows_through_zero() const {
    double above = 0.0;
    double below = 0.0;
    for (std::size_t i = 0; i < strain_.size(); ++i)
      (strain_[i] > 0.0 ? above : below) += strain_[i] * stress_[i];
    return above > 0.0 && below > 0.0;
  }

  void turn_to_positive() {
    std::size_t far = 0;
    for (std::size_t i = 0; i < strain_.size(); ++i)
      if (std::abs(strain_[i] - strain_[0]) > std::abs(strain_[far] - strain_[0])) far = i;
    if (strain_[far] > strain_[0]) return;
    for (double& each : strain_) each = 0.0 - each;
    for (double& each : stress_) each = 0.0 - each;
    fit_.notes.emplace_back("strain and stress are negative in compression; both signs changed");
    if (loading_ == UniaxialTest::Loading::tension)
      throw InputError({},
                       "the strain is negative, as in compression; leave `--loading tension` out, "
                       "or name another `--x`");
    loading_ = UniaxialTest::Loading::compression;
  }

  template <class Wanted>
  void keep(const Wanted& wanted) {
    std::vector<double> x, y;
    for (std::size_t i = 0; i < strain_.size(); ++i) {
      if (!wanted(i)) continue;
      x.push_back(strain_[i]);
      y.push_back(stress_[i]);
    }
    strain_ = std::move(x);
    stress_ = std::move(y);
  }

  // Rows beyond `to` are cut before anything is judged: what follows there is no part of the test.
  void cut() {
    const double high = test_.to.value_or(std::numeric_limits<double>::infinity()) + 1e-12;
    const std::size_t size = strain_.size();
    keep([&](std::size_t i) { return std::abs(strain_[i]) <= high; });
    outside_ += size - strain_.size();
    refuse_few();
  }

  // The loading of one cycle; of a curve through zero, the branches that lead away from it.
  void take_loading() {
    const std::vector<Branch> branches = branches_of(strain_);
    if (both_) return take_both(branches);
    std::vector<Branch> loadings;
    for (const Branch& branch : branches)
      if (branch.up) loadings.push_back(branch);
    const std::size_t size = strain_.size();
    const auto cycles = static_cast<int>(loadings.size());
    if (cycles > 1 && test_.cycle == 0) {
      std::string ends;
      for (int k = 0; k < std::min(cycles, 5); ++k)
        ends += (k > 0 ? ", " : "") + rounded_text(strain_[loadings[as_index(k)].to - 1]);
      throw InputError({}, "the curve has " + std::to_string(cycles) +
                               " loadings, up to strains of " + ends + (cycles > 5 ? ", ..." : "") +
                               ", which differ by what the ones before did to the specimen; choose "
                               "one by `--cycle 1` to `--cycle " +
                               std::to_string(cycles) + "`");
    }
    if (test_.cycle > cycles)
      throw InputError({}, "the curve has " + std::to_string(cycles) +
                               (cycles == 1 ? " loading" : " loadings") + ", and `--cycle " +
                               std::to_string(test_.cycle) +
                               "` is not among them; give one of 1 to " + std::to_string(cycles));
    if (cycles == 0) return;
    const Branch part = loadings[as_index(std::max(test_.cycle, 1) - 1)];
    if (part.from == 0 && part.to == size) return;
    keep([&](std::size_t i) { return i >= part.from && i < part.to; });
    if (cycles > 1)
      fit_.notes.push_back("loading " + std::to_string(std::max(test_.cycle, 1)) + " of " +
                           std::to_string(cycles) + " is fitted");
    leave_out(fit_, size - strain_.size(),
              cycles > 1 ? "in other loadings and on the way back"
                         : "the way back from the largest strain");
    refuse_few();
  }

  void take_both(const std::vector<Branch>& branches) {
    // A side is excluded on its way back to zero where it has a way out.
    std::vector<char> away(strain_.size(), 0);
    std::array<bool, 2> out{};  // below and above zero
    for (const Branch& branch : branches)
      for (std::size_t i = branch.from; i < branch.to; ++i)
        if ((strain_[i] > 0.0) == branch.up) {
          away[i] = 1;
          if (i > branch.from) out[strain_[i] > 0.0 ? 1 : 0] = true;
        }
    const std::size_t size = strain_.size();
    keep([&](std::size_t i) { return away[i] != 0 || !out[strain_[i] > 0.0 ? 1 : 0]; });
    leave_out(fit_, size - strain_.size(), "on the way back to zero strain");
    refuse_few();
  }

  // Up to the largest stress before the specimen gives way.
  void end_at_fall() {
    if (both_) return;
    double up = 0.0;
    double down = 0.0;
    for (const double each : stress_) {
      up = std::max(up, each - stress_[0]);
      down = std::max(down, stress_[0] - each);
    }
    if (const Limit limit = limit_of(stress_); limit.from < limit.to) {
      const std::size_t size = stress_.size();
      keep([&](std::size_t i) { return i < limit.from; });
      leave_out(fit_, size - limit.from,
                "the stress stays at its largest value, as at the limit of a sensor");
      refuse_few();
    }
    const std::size_t rows = rows_before_fall(stress_, fall_share);
    const bool falls = rows == stress_.size() ? stress_.back() < stress_.front() : down > 3.0 * up;
    if (falls)
      throw InputError({},
                       "the stress falls as the strain grows; give `--compression auto`, which "
                       "turns the sign of a load, or name other columns");
    if (rows == stress_.size()) return;
    fit_.notes.push_back("the loading part ends at the largest stress, at a strain of " +
                         rounded_text(strain_[rows - 1]) + ", before the first fall by more than " +
                         percent_text(fall_share));
    const std::size_t size = strain_.size();
    keep([&](std::size_t i) { return i < rows; });
    leave_out(fit_, size - strain_.size(), "after the largest stress");
    refuse_few();
  }

  void keep_range() {
    const double low = test_.from.value_or(-std::numeric_limits<double>::infinity());
    first_strain_ = strain_.front();
    first_stress_ = stress_.front();
    const std::size_t size = strain_.size();
    keep([&](std::size_t i) { return (both_ ? std::abs(strain_[i]) : strain_[i]) >= low - 1e-12; });
    leave_out(fit_, outside_ + size - strain_.size(), "outside `--from` and `--to`");
    refuse_few();
    scale_ = scale_to_one(stress_, "the stress is 0 at every point; name another column by `--y`");
  }

  // The toe of a specimen that settles between the platens: no stress up to a strain, then a line.
  struct Toe {
    double strain, stress, slope;  // Pa
  };
  [[nodiscard]] std::optional<Toe> toe() const {
    if (both_ || strain_.size() < 20) return std::nullopt;
    const double width = strain_.back() - strain_.front();
    const double mean =
        std::accumulate(stress_.begin(), stress_.end(), 0.0) / static_cast<double>(stress_.size());
    double total = 0.0;
    for (const double each : stress_) total += (each - mean) * (each - mean);
    Toe best{};
    std::array<double, 2> least{std::numeric_limits<double>::infinity(), 0.0};
    const auto n = static_cast<double>(strain_.size());
    for (int k = 0; k <= 100; ++k) {
      const double knee = strain_.front() + 0.006 * k * width;
      double sx = 0.0, sxx = 0.0, sy = 0.0, sxy = 0.0, syy = 0.0;
      for (std::size_t i = 0; i < strain_.size(); ++i) {
        const double x = std::max(strain_[i] - knee, 0.0);
        sx += x;
        sxx += x * x;
        sy += stress_[i];
        sxy += x * stress_[i];
        syy += stress_[i] * stress_[i];
      }
      const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
      const double offset = (sy - slope * sx) / n;
      const double squares = syy - offset * sy - slope * sxy;
      if (k == 0) least[1] = squares;
      if (!(squares < least[0])) continue;
      least[0] = squares;
      best = {knee, offset, slope};
    }
    const auto before = std::ranges::count_if(strain_, [&](double x) { return x < best.strain; });
    const bool line = least[0] < 0.005 * total;
    const bool better = n * std::log(least[1] / std::max(least[0], 1e-300)) > 20.0;
    if (before < 5 || !line || !better) return std::nullopt;
    return best;
  }

  // Counts strain and stress from the end of the toe; the height stays as given, as in
  // the toe compensation of ASTM D638 and D695.
  void take_off_toe() {
    const auto found = toe();
    if (!found) {
      fit_.notes.emplace_back("the curve shows no toe, so that none is taken off");
      return;
    }
    const std::size_t size = strain_.size();
    keep([&](std::size_t i) { return strain_[i] >= found->strain; });
    for (double& each : strain_) each -= found->strain;
    for (double& each : stress_) each -= found->stress;
    fit_.notes.push_back("a toe up to a strain of " + rounded_text(found->strain) +
                         " is taken off: strain and stress count from there");
    leave_out(fit_, size - strain_.size(), "in the toe");
    refuse_few();
  }

  // sigma = sigma_0 + E_tangent epsilon
  void line() {
    fit_.law =
        "tangent: slope of the line through the points; secant: from the first row to the largest "
        "strain";
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
    const Minimum minimum = minimise(stress_, curve, std::array{guess, 0.0}, {});
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
    fit_.covariance = {};
  }

  [[nodiscard]] double parabola_at_end() const {
    Eigen::MatrixXd powers(static_cast<Eigen::Index>(strain_.size()), 3);
    for (std::size_t i = 0; i < strain_.size(); ++i) {
      const double from_end = strain_[i] - fit_.range_high;
      powers.row(static_cast<Eigen::Index>(i)) << 1.0, from_end, from_end * from_end;
    }
    const Eigen::Map<const Eigen::VectorXd> stress(stress_.data(), powers.rows());
    return dense::least_squares(powers, stress)[0];
  }

  // A sum of terms c_k phi_k(L, alpha_k). Parameters of the search: c_k, then alpha_k.
  void large_strain() {
    using Model = UniaxialTest::Model;
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
    fit_.law = std::string(law(test_.model)) + (both_        ? ", compression and tension"
                                                : sign < 0.0 ? ", compression"
                                                             : ", tension");
    const bool three = test_.model == Model::yeoh || test_.model == Model::ogden3;
    const bool powers = test_.model == Model::ogden || test_.model == Model::ogden3;
    const std::size_t terms = three ? 3 : 1;
    const std::size_t count = powers ? 2 * terms : terms;
    need_points(fit_.name, count + 2, strain_.size());
    Separable curve;
    curve.linear = terms;
    curve.starts = starts(terms, powers);
    if (test_.model == Model::ogden3) curve.minima = 24;  // its squares have several minima
    curve.columns = [&](std::span<const double> alpha, std::span<double> phi) {
      for (std::size_t k = 0; k < terms; ++k) {
        const double size = test_.model == Model::ogden3 ? size_of_power(alpha[k]) : 1.0;
        for (std::size_t i = 0; i < stretch_.size(); ++i)
          phi[i * terms + k] =
              sign * term(test_.model, stretch_[i], k, powers ? alpha[k] : 0.0) / size;
      }
      return true;
    };
    const char* first = test_.model == Model::ogden3 ? "mu_1" : "E";
    fit_.parameters = {{.name = first, .unit = "kPa"}};
    if (test_.model == Model::yeoh)
      for (const char* name : {"C2", "C3"})
        fit_.parameters.push_back({.name = name, .unit = "kPa"});
    if (test_.model == Model::ogden3)
      for (const char* name : {"mu_2", "mu_3"})
        fit_.parameters.push_back({.name = name, .unit = "kPa"});
    if (powers && !three) fit_.parameters.push_back({.name = "alpha", .unit = ""});
    if (powers && three)
      for (const char* name : {"alpha_1", "alpha_2", "alpha_3"})
        fit_.parameters.push_back({.name = name, .unit = ""});
    std::vector<double> scale(count, 1.0);
    for (std::size_t k = 0; k < terms; ++k) scale[k] = unit::kPa.from_si(scale_);
    const Minimum minimum = minimise(stress_, curve, 1000);
    settle(fit_, minimum, {stress_, scale_, scale, test_.residuals});
    fit_.rmse = unit::kPa.from_si(fit_.rmse);
    if (test_.model == Model::ogden3 && fit_.termination != Termination::failed) add_modulus();
  }

  // The norm of one of Ogden's powers over the rows, with the sign of its exponent. The search
  // takes each power divided by it: mu_k itself changes by decades where alpha_k changes a little.
  [[nodiscard]] double size_of_power(double alpha) const {
    Eigen::VectorXd power(static_cast<Eigen::Index>(stretch_.size()));
    for (std::size_t i = 0; i < stretch_.size(); ++i)
      power[static_cast<Eigen::Index>(i)] = term(test_.model, stretch_[i], 0, alpha);
    return std::copysign(power.stableNorm(), alpha);
  }

  // From the factors c_k of the search mu_k = c_k / size, and E = 3/2 sum mu_k alpha_k, before the
  // terms, which determine it better than each other. d mu_k = (d c_k - c_k d ln size) / size.
  void add_modulus() {
    const Estimate& one = fit_.parameters[0];
    const double t = (one.ci95_high - one.estimate) / one.std_error;
    const auto finish = [&](Estimate& made, const std::array<double, 6>& slope, double factor) {
      double variance = fit_.covariance.size() == 0 ? Estimate::unknown : 0.0;
      for (Eigen::Index i = 0; i < fit_.covariance.rows(); ++i)
        for (Eigen::Index j = 0; j < fit_.covariance.cols(); ++j)
          variance += slope[as_index(i)] * slope[as_index(j)] * fit_.covariance(i, j);
      made.std_error = factor * std::sqrt(variance < 0.0 ? 0.0 : variance);
      made.ci95_low = made.estimate - t * made.std_error;
      made.ci95_high = made.estimate + t * made.std_error;
    };
    Estimate young{.name = "E", .unit = "kPa", .estimate = 0.0};
    std::array<double, 6> of_young{};
    for (std::size_t k = 0; k < 3; ++k) {
      Estimate& mu = fit_.parameters[k];
      const double alpha = fit_.parameters[3 + k].estimate;
      const double size = size_of_power(alpha);
      const double step = 1e-5 * std::max(1.0, std::abs(alpha));  // error of order step^2
      const double log_slope =
          std::log(std::abs(size_of_power(alpha + step) / size_of_power(alpha - step))) /
          (2.0 * step);
      std::array<double, 6> slope{};
      slope[k] = 1.0;
      slope[3 + k] = -mu.estimate * log_slope;
      mu.estimate /= size;
      for (const std::size_t i : {k, 3 + k}) of_young[i] = 1.5 * alpha / size * slope[i];
      of_young[3 + k] += 1.5 * mu.estimate;
      young.estimate += 1.5 * mu.estimate * alpha;
      finish(mu, slope, 1.0 / std::abs(size));
    }
    finish(young, of_young, 1.0);
    fit_.parameters.insert(fit_.parameters.begin(), young);
    fit_.covariance = {};
  }

  // Exponents to begin with.
  static std::vector<std::vector<double>> starts(std::size_t terms, bool powers) {
    std::vector<std::vector<double>> all;
    if (!powers) return {{}};
    if (terms == 1) {
      for (double alpha = -40.25; alpha <= 40.5; alpha += 0.5) all.push_back({alpha});
      return all;
    }
    const std::array grid{-9.0, -5.0, -2.0, 1.5, 2.5, 4.0, 6.0, 9.0, 14.0};
    for (std::size_t i = 0; i < grid.size(); ++i)
      for (std::size_t j = i + 1; j < grid.size(); ++j)
        for (std::size_t k = j + 1; k < grid.size(); ++k)
          all.push_back({grid[i], grid[j], grid[k]});
    return all;
  }

  // The stiffening by bonded platens divides every modulus.
  void platens() {
    if (!test_.shape_factor) return;
    const double factor =
        contact::bonded_stiffening(*test_.shape_factor, test_.poisson_ratio.value_or(0.5));
    for (Estimate& one : fit_.parameters) {
      if (one.name.starts_with("alpha") || one.name == "sigma_0") continue;
      for (double* value : {&one.estimate, &one.std_error, &one.ci95_low, &one.ci95_high})
        *value /= factor;
    }
    fit_.law += test_.poisson_ratio ? ", divided by " + rounded_text(factor) +
                                          " of bonded platens, Gent and Lindley's 1 + 2 S^2 in "
                                          "series with the modulus of uniaxial strain, for nu = " +
                                          rounded_text(*test_.poisson_ratio)
                                    : ", divided by 1 + 2 S^2 = " + rounded_text(factor) +
                                          " of bonded platens, Gent and Lindley 1959, for nu = 1/2";
    const auto higher = [&](double nu) {
      return factor / contact::bonded_stiffening(*test_.shape_factor, nu) - 1.0;
    };
    if (!test_.poisson_ratio && higher(0.45) > 0.02)
      fit_.warnings.push_back(
          "the factor of bonded platens is that of incompressible tissue: at nu = 0.45 the modulus "
          "would be " +
          percent_text(higher(0.45)) + " higher, at nu = 0.3 " + percent_text(higher(0.3)) +
          "; give `--poisson`");
    if (fit_.range_high > 0.1 && factor > 1.05)
      fit_.warnings.push_back(
          "the factor of bonded platens is one of small strain, and the curve reaches a strain "
          "of " +
          rounded_text(fit_.range_high, 2) + "; give a smaller `--to`");
  }

  const UniaxialTest& test_;
  UniaxialTest::Loading loading_;
  Fit fit_;
  std::vector<double> strain_;
  std::vector<double> stress_;  // divided by scale_ once the range is chosen
  std::vector<double> stretch_;
  bool both_ = false;        // compression and tension in one curve
  std::size_t outside_ = 0;  // rows beyond `to`
  std::optional<double> end_of_toe_;
  double first_strain_ = 0.0;
  double first_stress_ = 0.0;  // Pa
  double scale_ = 0.0;         // Pa
};

}  // namespace

Fit fit_uniaxial(std::span<const double> strain, std::span<const double> stress,
                 const UniaxialTest& test) {
  assert(strain.size() == stress.size());
  UniaxialFit whole(strain, stress, test);
  const auto toe = whole.end_of_toe();
  Fit fit = whole.all();
  if (!toe || fit.termination == Termination::failed) return fit;
  UniaxialTest without = test;
  without.toe = true;
  try {
    const Fit other = UniaxialFit(strain, stress, without).all();
    const double change = other.parameters[0].estimate / fit.parameters[0].estimate - 1.0;
    if (std::abs(change) >= 0.02)
      fit.warnings.insert(fit.warnings.begin(),
                          "the curve has a toe up to a strain of " + rounded_text(*toe) +
                              "; to take it off, by `--toe`, would change the modulus by " +
                              percent_text(change));
  } catch (const InputError&) {  // too few rows are left
  }
  return fit;
}

}  // namespace palpate::fit
