// Search, errors, profiles and warnings for a prepared measurement.
#include "identify/identify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/doing.h"
#include "base/error.h"
#include "base/numerics.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "fit/parts.h"
#include "fit/residuals.h"
#include "identify/box_search.h"
#include "identify/prepare_curve.h"
#include "identify/tables.h"
#include "scenario/integrators.h"

namespace palpate::identify {
namespace {

constexpr double edge = 1e-6;  // of the box; a best fit this close to a bound counts as on it
constexpr double high_correlation = 0.95;
constexpr double disagreement = 0.2;  // of an interval's half width

Eigen::Index as_signed(std::size_t i) { return static_cast<Eigen::Index>(i); }

double median_spacing(std::vector<double> x) {
  std::ranges::sort(x);
  std::vector<double> steps;
  for (std::size_t i = 1; i < x.size(); ++i)
    if (x[i] > x[i - 1]) steps.push_back(x[i] - x[i - 1]);
  return steps.empty() ? 0.0 : fit::median(std::move(steps));
}

// One pair of data and scenario within a search; `found` is of this pair alone.
struct Part : PreparedCurve {
  const scenario::Family* family = nullptr;
  std::vector<Unknown> unknowns;   // those of this pair
  std::vector<std::size_t> index;  // of each, among all unknowns
  std::size_t from = 0, to = 0;    // its points among all
  DefaultBody body;

  template <class T>
  [[nodiscard]] std::vector<T> own(std::span<const T> all) const {
    std::vector<T> some;
    for (const std::size_t i : index) some.push_back(all[i]);
    return some;
  }
  bool values(std::span<const double> all, std::span<double> out) {
    return curve->evaluate(own(all), out);
  }
};

class Search {
 public:
  Search(const std::vector<Pair>& pairs, const std::vector<Unknown>& unknowns,
         const IdentifyOptions& options)
      : pairs_(pairs), unknowns_(unknowns), options_(options) {
    parts_.reserve(pairs.size());  // curves keep references to the unknowns of their parts
    for (const Pair& pair : pairs) add(pair);
  }

  Identification all() {
    begin("search of the best fit", 0);
    make_problem();
    refuse_what_changes_nothing();
    find_best();
    judge();
    if (options_.profiles) {
      profiles();
      begin("starts of the contact", unknowns_.size() + 1);
      sensitivity();
      widen_by_start();
    }
    conclude();
    return std::move(found_);
  }

 private:
  // One of the parts of the work for the line of progress: the search, an interval of each unknown,
  // and the starts of the contact.
  void begin(const std::string& name, std::size_t part) {
    doing_ = name;
    part_ = part;
    tried_ = 0;
    tell();
  }

  // How many curves a part takes is not known; half of it is said to be done after as many as the
  // intervals of a smooth curve take.
  void tell() const {
    constexpr std::size_t percent = 100;
    const std::size_t usual = 10 * (unknowns_.size() + 1);
    const std::size_t within = percent * tried_ / (tried_ + usual);
    set_doing({doing_ + (tried_ == 0 ? "" : ", " + std::to_string(tried_) + " curves"),
               (percent * part_ + within) / (unknowns_.size() + 2), percent});
  }

  void add(const Pair& pair) {
    Part& part = parts_.emplace_back();
    part.family = pair.family;
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      const auto& in = unknowns_[i].pairs;
      if (std::ranges::find(in, parts_.size() - 1) == in.end()) continue;
      part.unknowns.push_back(unknowns_[i]);
      part.index.push_back(i);
    }
    static_cast<PreparedCurve&>(part) =
        prepare_curve(*pair.measured, *pair.family, part.unknowns, options_.noise);
    const Identification& found = part.found;
    part.from = found_.x.size();
    found_.x.insert(found_.x.end(), found.x.begin(), found.x.end());
    found_.measured.insert(found_.measured.end(), found.measured.begin(), found.measured.end());
    part.to = found_.x.size();
    found_.excluded += found.excluded;
    weights_.insert(weights_.end(), part.weights.begin(), part.weights.end());
  }

  [[nodiscard]] bool joint() const { return parts_.size() > 1; }

  // Residuals of several pairs are divided by the scatter of their own rows.
  void weigh_pairs() {
    for (const Part& part : parts_) {
      std::vector<double> scaled;
      for (std::size_t i = part.from; i < part.to; ++i)
        scaled.push_back(found_.measured[i] * weights_[i]);
      const double scatter = std::max(fit::noise_of(scaled), 1e-3);
      for (std::size_t i = part.from; i < part.to; ++i) weights_[i] /= scatter;
    }
  }

  void take_first() { static_cast<CurveFit&>(found_) = parts_.front().found; }

  void make_problem() {
    take_first();
    if (joint()) weigh_pairs();
    for (const Part& part : parts_)
      for (const std::string& text : part.found.notes) note(part, text);
    problem_.unknowns = unknowns_.size();
    problem_.curve = [this](std::span<const double> u, std::span<double> values) {
      ++tried_;
      tell();
      return std::ranges::all_of(parts_, [&](Part& part) {
        return !StopScope::stopped() &&
               part.values(u, values.subspan(part.from, part.to - part.from));
      });
    };
    problem_.exact = !joint() && found_.closed_form;
    problem_.measured = found_.measured;
    problem_.weights = weights_;
  }

  bool values_at(std::span<const double> u, std::vector<double>& values) {
    values.resize(found_.x.size());
    ++found_.evaluations;
    return problem_.curve(u, values);
  }

  void refuse_what_changes_nothing() {
    std::vector<double> low, high;
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      bool tried = false;
      bool changes = false;
      for (const double from : {0.5, 0.25, 0.75, 0.05}) {
        std::vector<double> u(unknowns_.size(), from);
        u[i] = 0.1;
        if (!values_at(u, low)) continue;
        u[i] = 0.9;
        if (!values_at(u, high)) continue;
        double most = 0.0;
        for (std::size_t k = 0; k < low.size(); ++k)
          most = std::max(most, std::abs(high[k] - low[k]) * weights_[k]);
        tried = true;
        changes = most > 1e-9;  // in contact, at this place of the box
        if (changes) break;
      }
      if (tried && !changes)
        refuse("`--unknown " + unknowns_[i].name() + "` changes nothing in what " +
               computed_by(found_) + " computes of " + words_of(found_.kind).sentence +
               "; leave it out, or set what makes it count (`palpate explain " + unknowns_[i].key +
               "`)");
    }
  }

  [[nodiscard]] std::string failure() const {
    for (const Part& part : parts_)
      if (!part.curve->failure().empty()) return part.curve->failure();
    return "the curve cannot be evaluated in the ranges";
  }

  void find_best() {
    const SearchResult result = search_from_several(problem_, options_.searches);
    found_.evaluations += result.evaluations;
    // After an interrupt the curve cannot be evaluated, and what was computed since is wrong.
    StopScope::end_if_stopped();
    if (!result.best.found) refuse("the search found no fit: " + failure());
    best_ = result.best;
    found_.model.resize(found_.x.size());
    (void)values_at(best_.u, found_.model);
    StopScope::end_if_stopped();
  }

  void judge() {
    const std::size_t n = unknowns_.size();
    const double degrees = static_cast<double>(found_.x.size() - n);
    noise_ = std::max(std::sqrt(best_.squares / degrees), 1e-12);
    judge_residuals();
    errors_ = box_errors(best_.jacobian, along_, t_);
    std::vector<char> moving(n, 1);
    for (std::size_t i = 0; i < n; ++i) {
      Identified one;
      one.unknown = unknowns_[i];
      one.u = best_.u[i];
      one.estimate = unknowns_[i].value(best_.u[i]);
      const bool on_edge = best_.u[i] < edge || best_.u[i] > 1.0 - edge;
      one.inseparable = errors_.inseparable[i] != 0 && !(n == 1 && on_edge);
      one.at_bound = !one.inseparable && on_edge;
      moving[i] = one.at_bound ? 0 : 1;
      found_.unknowns.push_back(one);
    }
    // Unknowns at a bound are held there for the errors of the others.
    if (std::ranges::count(moving, 0) > 0) errors_ = errors_of(moving);
    for (std::size_t i = 0; i < n; ++i) set_interval(i);
    predict_errors();
    tie_what_correlates();
    if (const auto combined = combination(errors_, unknowns_, best_.u, t_))
      found_.combinations.push_back(*combined);
    set_correlation();
    refuse_the_undetermined();
  }

  // Two properties of the scenario that correlate by more than 0.95, or any two keys that do
  // where the effective sample size is below ten, have no numbers of their own: what
  // tells them apart is as small as the model's own error. The weakest direction counts as not
  // determined.                                                       docs/theory.md [correlation]
  void tie_what_correlates() {
    const std::size_t n = unknowns_.size();
    const bool few = found_.effective_size < 10.0 && noise_ > 1e-3 && systematic_;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const double product = errors_.variance(i, i) * errors_.variance(j, j);
        const bool keys =
            unknowns_[i].what == Unknown::What::key && unknowns_[j].what == Unknown::What::key;
        if (!(product > 0.0) || !keys) continue;
        const double with = errors_.variance(i, j) / std::sqrt(product);
        const bool elastic = is_elastic(i) && is_elastic(j) && !told_apart(i, j);
        if (std::abs(with) <= high_correlation || !(few || elastic)) continue;
        found_.notes.push_back("`" + unknowns_[j].name() + "` and `" + unknowns_[i].name() +
                               "` correlate by " + rounded_text(with, 4) +
                               (few ? ", and the effective sample size is " +
                                          rounded_text(std::max(1.0, found_.effective_size), 3)
                                    : std::string()) +
                               ": they have no numbers of their own");
        errors_ = box_errors(best_.jacobian, along_, t_, 1);
        for (std::size_t k = 0; k < n; ++k) {
          Identified& one = found_.unknowns[k];
          one.inseparable = errors_.inseparable[k] != 0;
          one.std_error = one.ci95_low = one.ci95_high = std::nullopt;
          set_interval(k);
        }
        return;
      }
  }

  void predict_errors() {
    for (Part& part : parts_) {
      const scenario::Case at = part.curve->at(estimates_of(part));
      if (!part.found.closed_form || !part.family->cases.front().scenario.uniform())
        part.found.predicted_error = predicted_error(at);
      part.body = default_body(*part.curve, *part.family, estimates_of(part));
    }
    take_first();
  }

  [[nodiscard]] std::vector<double> estimates_of(const Part& part) const {
    std::vector<double> values;
    for (const std::size_t i : part.index) values.push_back(unknowns_[i].value(best_.u[i]));
    return values;
  }

  // J^T (F w) of the rows of a pair, and sum (F w)^2, where F is its curve and w the weights.
  [[nodiscard]] std::pair<Eigen::VectorXd, double> changes_of(const Part& part) const {
    Eigen::VectorXd along = Eigen::VectorXd::Zero(as_signed(unknowns_.size()));
    double size = 1e-300;
    for (std::size_t row = part.from; row < part.to; ++row) {
      const double weighted = found_.model[row] * weights_[row];
      along += weighted * best_.jacobian.row(as_signed(row)).transpose();
      size += weighted * weighted;
    }
    return {along, size};
  }

  // Whether the pairs change by more than the stated errors of their models along the direction of
  // unknowns i and j that changes them least: a_k = sum J F w / sum (F w)^2, the relative change of
  // the curve of pair k as a whole. One pair has such a direction always.
  //                                                                     docs/theory.md [told_apart]
  [[nodiscard]] bool told_apart(std::size_t i, std::size_t j) const {
    double ii = 0.0, ij = 0.0, jj = 0.0;
    std::vector<std::array<double, 2>> changes;
    for (const Part& part : parts_) {
      const auto [along, size] = changes_of(part);
      const std::array change{along[as_signed(i)] / size, along[as_signed(j)] / size};
      ii += change[0] * change[0];
      ij += change[0] * change[1];
      jj += change[1] * change[1];
      changes.push_back(change);
    }
    // The eigenvector of the smaller eigenvalue.
    const double angle = 0.5 * std::atan2(2.0 * ij, ii - jj) + 0.5 * std::numbers::pi;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const double moved =
          std::abs(std::cos(angle) * changes[k][0] + std::sin(angle) * changes[k][1]);
      const double error = std::max(parts_[k].found.predicted_error.value_or(0.0), 1e-3);
      if (0.5 * moved > error) return true;  // over half the box
    }
    return false;
  }

  // A property of an elastic body, which a single press knows through one stiffness.
  [[nodiscard]] bool is_elastic(std::size_t i) const {
    const std::string& key = unknowns_[i].key;
    return key.ends_with(".young_modulus") || key.ends_with(".poisson_ratio");
  }

  // What the residuals say of the errors along the directions of the box that a jacobian
  // determines, and of values rounded to steps.
  //                       docs/theory.md [correlated], [covariance], [sample_size], [rounding]
  [[nodiscard]] fit::ResidualErrors errors_along(const dense::Rows& jacobian) const {
    std::vector<double> scaled;
    for (std::size_t i = 0; i < weights_.size(); ++i)
      scaled.push_back(found_.measured[i] * weights_[i]);
    std::vector<std::span<const double>> records;
    for (const Part& part : parts_)
      records.emplace_back(scaled.data() + part.from, part.to - part.from);
    const dense::Rows directions = determined_directions(jacobian);  // of length 1
    const Eigen::Index count = directions.cols();
    return fit::errors_of(residuals_, directions, dense::Matrix::Identity(count, count), records);
  }

  void judge_residuals() {
    for (std::size_t i = 0; i < found_.x.size(); ++i)
      residuals_.push_back((found_.model[i] - found_.measured[i]) * weights_[i]);
    systematic_ = fit::systematic(residuals_);  // not by chance
    fit::ResidualErrors errors = errors_along(best_.jacobian);
    along_ = std::move(errors.covariance);
    factor_ = std::max(errors.factor, 1.0);
    found_.rho = errors.rho;
    found_.effective_size =
        static_cast<double>(found_.x.size()) / (errors.rho > 0.0 ? factor_ : 1.0);
    t_ = numerics::student_t_quantile(0.975, errors.degrees);
  }

  // Errors of the `moving` unknowns alone; the others get no variance.
  [[nodiscard]] BoxErrors errors_of(const std::vector<char>& moving) const {
    const std::size_t n = moving.size();
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < n; ++i)
      if (moving[i] != 0) places.push_back(i);
    BoxErrors all;
    all.covariance = all.of_one = dense::Matrix::Zero(as_signed(n), as_signed(n));
    all.inseparable.assign(n, 0);
    if (places.empty()) return all;
    const dense::Rows slopes = best_.jacobian(Eigen::all, places);
    const BoxErrors some = box_errors(slopes, errors_along(slopes).covariance, t_);
    all.covariance(places, places) = some.covariance;
    all.of_one(places, places) = some.of_one;
    for (std::size_t a = 0; a < places.size(); ++a)
      all.inseparable[places[a]] = some.inseparable[a];
    for (const std::vector<double>& direction : some.loose) {
      all.loose.emplace_back(n, 0.0);
      for (std::size_t a = 0; a < places.size(); ++a) all.loose.back()[places[a]] = direction[a];
    }
    all.determined = some.determined;
    return all;
  }

  void set_interval(std::size_t i) {
    Identified& one = found_.unknowns[i];
    one.inseparable = one.inseparable || errors_.inseparable[i] != 0;
    if (one.inseparable || one.at_bound) return;
    const double error = std::sqrt(errors_.variance(i, i));
    one.std_error = error * unknowns_[i].slope(one.u);
    // The interval is symmetric in u: on a logarithmic scale it is a factor up and down.
    one.ci95_low = unknowns_[i].value(one.u - t_ * error);
    one.ci95_high = unknowns_[i].value(one.u + t_ * error);
  }

  void set_correlation() {
    const std::size_t n = unknowns_.size();
    found_.correlation.assign(n * n, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        const double product = errors_.variance(i, i) * errors_.variance(j, j);
        if (!found_.unknowns[i].inseparable && !found_.unknowns[j].inseparable && product > 0.0)
          found_.correlation[i * n + j] = errors_.variance(i, j) / std::sqrt(product);
      }
  }

  void refuse_the_undetermined() const {
    const auto& all = found_.unknowns;
    if (std::ranges::all_of(all, [](const auto& one) { return one.at_bound; }))
      refuse(
          "the best fit lies at the edge of the range of " +
          std::string(all.size() == 1 ? ticked(all.front().unknown.name()) : "every `--unknown`") +
          ", so that the value lies outside; widen the range, or mend the scenario");
    const bool some =
        std::ranges::any_of(all, [](const auto& one) { return !one.inseparable && !one.at_bound; });
    if (!some && found_.combinations.empty())
      refuse("these data cannot tell " +
             std::string(all.size() == 1 ? ticked(all.front().unknown.name())
                                         : "any of the unknowns") +
             " to better than half of the range; record a longer or less noisy curve, or exclude "
             "an `--unknown`");
  }

  void profiles() {
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      Identified& one = found_.unknowns[i];
      begin("interval of " + one.unknown.name(), i + 1);
      // The standard deviation of independent residuals that would give this unknown its error.
      const double sigma = one.inseparable || one.at_bound
                               ? noise_ * std::sqrt(factor_)
                               : std::max(std::sqrt(errors_.variance(i, i) /
                                                    errors_.of_one.diagonal()[as_signed(i)]),
                                          1e-12);
      const Profile got = one.inseparable
                              ? profile_over_box(problem_, best_, i)
                              : profile(problem_, best_, i, errors_.covariance, sigma, t_);
      StopScope::end_if_stopped();
      found_.evaluations += got.evaluations;
      for (const Profile::Point& point : got.points)
        found_.profile.push_back({i, unknowns_[i].value(point.u), point.squares,
                                  (point.squares - best_.squares) / (sigma * sigma)});
      if (one.inseparable) valley_.insert(valley_.end(), got.points.begin(), got.points.end());
      if (one.inseparable) continue;
      if (got.low) one.profile_low = unknowns_[i].value(*got.low);
      if (got.high) one.profile_high = unknowns_[i].value(*got.high);
      one.by_profile = trusts_profile(i, got);
      if (!got.low && !got.high) {
        one.inseparable = true;  // every value in its range fits
        one.std_error = one.ci95_low = one.ci95_high = std::nullopt;
      }
    }
    set_correlation();
    refuse_the_undetermined();
  }

  [[nodiscard]] bool trusts_profile(std::size_t i, const Profile& got) const {
    const Identified& one = found_.unknowns[i];
    if (one.at_bound || !got.low || !got.high) return true;
    const double half = t_ * std::sqrt(errors_.variance(i, i));
    const bool differ = std::abs(one.u - *got.low - half) > disagreement * half ||
                        std::abs(*got.high - one.u - half) > disagreement * half;
    for (std::size_t j = 0; j < unknowns_.size(); ++j) {
      const double with = found_.correlation[i * unknowns_.size() + j];
      if (j != i && std::abs(with) > high_correlation) return true;
    }
    return differ;
  }

  // Repeats the fit with the contact point moved a little earlier and later.
  void sensitivity() {
    if (joint()) return;
    const std::size_t n = unknowns_.size();
    std::vector<char> held(n, 0);
    std::size_t contact = n;
    for (std::size_t i = 0; i < n; ++i)
      if (unknowns_[i].what == Unknown::What::contact_point) contact = i;
    found_.contact_shift = median_spacing(found_.x);
    if (contact < n) {
      if (!found_.unknowns[contact].std_error || n == 1) return;
      held[contact] = 1;
      found_.contact_shift = *found_.unknowns[contact].std_error;
    }
    for (const double sign : {-1.0, 1.0}) {
      std::vector<double> start = best_.u;
      const double shift = sign * found_.contact_shift;
      if (contact < n)
        start[contact] = std::clamp(
            unknowns_[contact].inverse(found_.unknowns[contact].estimate + shift), 0.0, 1.0);
      else
        parts_.front().curve->set_shift(shift);
      const BoxMinimum moved = minimise_in_box(problem_, start, held, Want::squares);
      StopScope::end_if_stopped();
      if (contact == n) parts_.front().curve->set_shift(0.0);
      found_.evaluations += moved.evaluations;
      if (!moved.found) continue;
      for (std::size_t i = 0; i < n; ++i) {
        Identified& one = found_.unknowns[i];
        if (one.inseparable || i == contact) continue;
        (sign < 0.0 ? one.moved_down : one.moved_up) =
            unknowns_[i].value(moved.u[i]) - one.estimate;
      }
    }
  }

  // The best fit from all starts of a record whose step lies between two rows: each end of an
  // interval moves as far as the best fit does in its direction, for each of several tests.
  void widen_by_start() {
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      std::vector<double> least(unknowns_.size(), 0.0);
      std::vector<double> most = least;
      for (const double start : pairs_[k].measured->starts) {
        parts_[k].curve->set_shift(start);
        const BoxMinimum moved = minimise_in_box(problem_, best_.u, {}, Want::squares);
        parts_[k].curve->set_shift(0.0);
        StopScope::end_if_stopped();
        found_.evaluations += moved.evaluations;
        for (std::size_t i = 0; i < least.size() && moved.found; ++i) {
          least[i] = std::min(least[i], moved.u[i] - best_.u[i]);
          most[i] = std::max(most[i], moved.u[i] - best_.u[i]);
        }
      }
      for (std::size_t i = 0; i < least.size(); ++i)
        move_ends(found_.unknowns[i], least[i], most[i]);
    }
  }

  // Moves the ends of an interval by steps in u.
  static void move_ends(Identified& one, double by_low, double by_high) {
    if (one.inseparable || one.at_bound) return;
    const auto move = [&](std::optional<double>& end, double by) {
      if (end) end = one.unknown.value(one.unknown.inverse(*end) + by);
    };
    for (auto* low : {&one.ci95_low, &one.profile_low}) move(*low, by_low);
    for (auto* high : {&one.ci95_high, &one.profile_high}) move(*high, by_high);
  }

  void conclude() {
    std::vector<double> weighted;
    for (std::size_t i = 0; i < found_.x.size(); ++i)
      weighted.push_back((found_.measured[i] - found_.model[i]) * weights_[i]);
    const Part& first = parts_.front();
    const double range = 1.0 / *std::ranges::max_element(weights_);
    found_.noise = noise_ * std::sqrt(first.rows_each) *
                   (options_.noise == Noise::constant && !joint() ? range : 1.0);
    found_.threshold = t_ * t_;
    found_.durbin_watson = fit::durbin_watson(weighted);
    if (options_.model_error) widen_by_model();
    widen_along_the_valley();
    for (Part& part : parts_) conclude_part(part);
    take_first();
    for (const Part& part : parts_) found_.r2 = std::min(found_.r2, part.found.r2);
    if (joint())
      for (const Part& part : parts_) found_.pairs.push_back(part.found);
    found_.warnings =
        warnings_of(found_, {weighted, noise_},
                    scenario::resolve(first.curve->at(estimates_of(first)), found_.taken));
  }

  void note(const Part& part, const std::string& text) {
    const std::string pair = std::to_string(&part - parts_.data() + 1);
    found_.notes.push_back((joint() ? "pair " + pair + ": " : "") + text);
  }

  // The curve, the fit and the scenario of one pair.
  void conclude_part(Part& part) {
    Identification& found = part.found;
    const auto slice = [&](const std::vector<double>& all) {
      return std::vector<double>(all.begin() + static_cast<std::ptrdiff_t>(part.from),
                                 all.begin() + static_cast<std::ptrdiff_t>(part.to));
    };
    found.model = slice(found_.model);
    double squares = 0.0;
    for (std::size_t i = 0; i < found.x.size(); ++i)
      squares += (found.measured[i] - found.model[i]) * (found.measured[i] - found.model[i]);
    found.rmse = std::sqrt(squares / static_cast<double>(found.x.size()));
    found.r2 = fit::r_squared(found.measured, squares);
    found.unknowns = part.own(std::span<const Identified>(found_.unknowns));
    const std::vector<double> values = estimates_of(part);
    if (!part.body.text.empty()) note(part, part.body.text);
    const bool press = found.kind == CurveKind::force_travel || found.kind == CurveKind::force_time;
    if (press) found.deep_effect = deep_effect(part.curve->at(values));
    found.scenario = scenario::answered(part.family->cases.front(), part.curve->fixed());
    double end = *std::ranges::max_element(found.x);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (part.unknowns[i].what == Unknown::What::contact_point) end -= values[i];
    (void)lengthen(found.kind, found.scenario, end);
    set_unknowns(found.scenario, part.unknowns, values);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (part.unknowns[i].what == Unknown::What::force_offset)
        found.scenario.contact.ambient_force += values[i];
  }

  // The stated error of the model is a bound on a bias: a force that is wrong by so much everywhere
  // moves u by (J^T J)^-1 J^T (error F w), which is added to each side of the intervals.
  //                                                                  docs/theory.md [model_error]
  void widen_by_model() {
    const std::size_t n = unknowns_.size();
    std::vector<double> moved(n, 0.0);  // by every pair, whose errors may differ in sign
    std::vector<double> combined(found_.combinations.size(), 0.0);
    for (const Part& part : parts_) {
      const double error = part.found.predicted_error.value_or(0.0) + std::abs(part.body.change);
      const Eigen::VectorXd change = error * errors_.of_one * changes_of(part).first;
      for (std::size_t i = 0; i < n; ++i) moved[i] += std::abs(change[as_signed(i)]);
      for (std::size_t k = 0; k < combined.size(); ++k) {
        const Eigen::Map<const Eigen::VectorXd> gradient(found_.combinations[k].gradient.data(),
                                                         as_signed(n));
        combined[k] += std::abs(gradient.dot(change));
      }
    }
    for (std::size_t k = 0; k < combined.size(); ++k) {
      Combination& one = found_.combinations[k];
      one.ci95_low =
          one.product ? one.ci95_low * std::exp(-combined[k]) : one.ci95_low - combined[k];
      one.ci95_high =
          one.product ? one.ci95_high * std::exp(combined[k]) : one.ci95_high + combined[k];
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Unknown::What what = unknowns_[i].what;
      if (what != Unknown::What::force_offset && what != Unknown::What::force_tilt)
        move_ends(found_.unknowns[i], -moved[i], moved[i]);
    }
  }

  // The exponents of a product are those near the best fit. Where not separately identifiable
  // unknowns may be elsewhere in their ranges, because the curve there differs by no more than
  // noise and the model's error, its value there is part of the interval.
  void widen_along_the_valley() {
    double allowed = t_ * t_ * noise_ * noise_ * factor_;
    for (const Part& part : parts_)
      for (std::size_t row = part.from; row < part.to; ++row) {
        const double of_model =
            part.found.predicted_error.value_or(0.0) * found_.model[row] * weights_[row];
        allowed += of_model * of_model;
      }
    for (Combination& one : found_.combinations) {
      if (one.exponents.empty()) continue;
      const double down = one.ci95_low / one.estimate;
      const double up = one.ci95_high / one.estimate;
      for (const Profile::Point& point : valley_) {
        if (point.squares - best_.squares > allowed) continue;
        double there = one.estimate;
        for (std::size_t k = 0; k < one.of.size(); ++k) {
          const Unknown& unknown = unknowns_[one.of[k]];
          there *= std::pow(unknown.value(point.all[one.of[k]]) / unknown.value(best_.u[one.of[k]]),
                            one.exponents[k]);
        }
        one.ci95_low = std::min(one.ci95_low, there * down);
        one.ci95_high = std::max(one.ci95_high, there * up);
      }
    }
  }

  const std::vector<Pair>& pairs_;
  const std::vector<Unknown>& unknowns_;
  const IdentifyOptions& options_;
  std::vector<Profile::Point> valley_;  // of the inseparable unknowns, over their ranges
  std::vector<Part> parts_;
  std::vector<double> weights_;
  BoxProblem problem_;
  BoxMinimum best_;
  BoxErrors errors_;
  std::vector<double> residuals_;  // weighted
  dense::Matrix along_;            // their covariance along the determined directions
  double noise_ = 0.0;             // their standard deviation
  double factor_ = 1.0;            // mean ratio of the variances to those of independent residuals
  bool systematic_ = false;        // the residuals are correlated by both tests
  double t_ = 0.0;
  Identification found_;
  std::string doing_;      // for the line of progress: the part of the work,
  std::size_t part_ = 0;   // its number,
  std::size_t tried_ = 0;  // and the curves that it took so far
};

}  // namespace

Identification identify(const Measurement& measured, const scenario::Family& family,
                        const std::vector<Unknown>& unknowns, const IdentifyOptions& options) {
  return identify({{&measured, &family}}, unknowns, options);
}

std::vector<const Identification*> views(const Identification& found) {
  if (found.pairs.empty()) return {&found};
  std::vector<const Identification*> all;
  for (const Identification& one : found.pairs) all.push_back(&one);
  return all;
}

Identification identify(const std::vector<Pair>& pairs, const std::vector<Unknown>& unknowns,
                        const IdentifyOptions& options) {
  return Search(pairs, unknowns, options).all();
}

}  // namespace palpate::identify
