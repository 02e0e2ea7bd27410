// Compares the two forces, tries one explanation after the other on what remains, and says it in
// words and as findings.
#include "live/verdict.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/index.h"
#include "base/text.h"
#include "live/touch.h"

namespace palpate::live {
namespace {

constexpr double barely = 1e-3;       // of the model's largest force: no contact
constexpr double least_depth = 0.95;  // of the travel that the loading history asks for

double median(std::vector<double> values) {
  if (values.empty()) return Verdict::unknown;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double square(double value) { return value * value; }
using Array = Eigen::ArrayXd;

// The rows with a measured force, divided at the largest force of the model.
struct Rows {
  Array time, travel, model, measured;
  Eigen::Index begin = 0;  // the last row without contact before the largest force
  Eigen::Index top = 0;    // the largest force of the model
  [[nodiscard]] Eigen::Index size() const { return travel.size(); }
};

Rows usable(const MeasuredCurve& curve) {
  std::vector<int> kept;
  for (std::size_t i = 0; i < curve.measured.size(); ++i)
    if (std::isfinite(curve.measured[i])) kept.push_back(static_cast<int>(i));
  const auto of = [&](const std::vector<double>& all) -> Array {
    return Eigen::Map<const Array>(all.data(), static_cast<Eigen::Index>(all.size()))(kept);
  };
  const Eigen::Map<const Eigen::ArrayXi> numbers(kept.data(),
                                                 static_cast<Eigen::Index>(kept.size()));
  Rows rows{curve.time.empty() ? Array(numbers.cast<double>()) : of(curve.time), of(curve.travel),
            of(curve.model), of(curve.measured)};
  if (rows.size() == 0) return rows;
  (void)rows.model.maxCoeff(&rows.top);
  rows.begin = rows.top;
  while (rows.begin > 0 && rows.model[rows.begin] > barely * rows.model[rows.top]) --rows.begin;
  return rows;
}

// Where the line through F^(2/3) of the rows with 5 to 50 % of the largest force is zero, m.
double end_of_force(const Rows& rows, const Array& force, Eigen::Index from, Eigen::Index to) {
  const double most = from < to ? std::max(0.0, force.segment(from, to - from).maxCoeff()) : 0.0;
  StraightLine line;
  for (Eigen::Index i = from; i < to; ++i)
    if (force[i] >= 0.05 * most && force[i] <= 0.5 * most)
      line.add(rows.travel[i], linear_in_depth(force[i]));
  const auto found = line.found();
  if (!found || !(found->slope > 0.0)) return Verdict::unknown;
  // A line that is almost level meets zero anywhere.
  const double low = rows.travel.minCoeff();
  const double high = rows.travel.maxCoeff();
  const double reach = high - low;
  return found->zero >= low - reach && found->zero <= high + reach ? found->zero : Verdict::unknown;
}

// Energy lost over energy put in. Nothing if the finger has not come back half of its way.
double lost_energy(const Rows& rows, const Array& force) {
  if (rows.travel[rows.size() - 1] > 0.5 * rows.travel.maxCoeff()) return Verdict::unknown;
  double in = 0.0;
  double out = 0.0;
  for (Eigen::Index i = rows.begin + 1; i < rows.size(); ++i) {
    const double work = 0.5 * (force[i] + force[i - 1]) * (rows.travel[i] - rows.travel[i - 1]);
    (work > 0.0 ? in : out) += work;
  }
  return in > 0.0 ? (in + out) / in : Verdict::unknown;
}

// The model's force in the press, over travel, continued as h^(3/2) below its last row.
class Press {
 public:
  explicit Press(const Rows& rows) {
    for (Eigen::Index i = rows.begin; i <= rows.top; ++i) {
      if (!travel_.empty() && rows.travel[i] <= travel_.back()) continue;
      travel_.push_back(rows.travel[i]);
      force_.push_back(rows.model[i]);
    }
  }
  [[nodiscard]] std::size_t size() const { return travel_.size(); }
  [[nodiscard]] double at(double travel) const {
    if (travel <= travel_.front()) return force_.front() * (travel < travel_.front() ? 0.0 : 1.0);
    if (travel >= travel_.back()) {
      const double ratio = travel_.back() > 0.0 ? travel / travel_.back() : 1.0;
      return force_.back() * ratio * std::sqrt(ratio);
    }
    const auto k = as_index(std::ranges::upper_bound(travel_, travel) - travel_.begin());
    const double part = (travel - travel_[k - 1]) / (travel_[k] - travel_[k - 1]);
    return force_[k - 1] + part * (force_[k] - force_[k - 1]);
  }

 private:
  std::vector<double> travel_, force_;
};

// 1 while the travel grows, -1 while it falls, as at the motion before where it rests. A way back
// of a fiftieth of the travel turns it.
Array ways(const Rows& rows) {
  const double enough = 0.02 * (rows.travel.maxCoeff() - rows.travel.minCoeff());
  Array way = Array::Ones(rows.size());
  double now = 1.0;
  Eigen::Index turn = 0;  // the row that is farthest that way
  for (Eigen::Index i = 0; i < rows.size(); ++i) {
    const double ahead = now * (rows.travel[i] - rows.travel[turn]);
    if (ahead < -enough) {
      now = -now;
      way.segment(turn + 1, i - turn - 1) = now;
    }
    if (ahead < -enough || ahead >= 0.0) turn = i;
    way[i] = now;
  }
  return way;
}

// One cause, with its value that explains the measured force best.
struct Explanation {
  Cause cause = Cause::wrong_stiffness;
  double rest = std::numeric_limits<double>::infinity();  // N, rms that remains
  double value = Verdict::unknown;  // of the cause, in the unit that Verdict gives it
  double score = rest;              // the least is the best
};

// A second number must explain more than the model's own difference could.
constexpr double second_number = 1.2;

class Judgement {
 public:
  Judgement(const MeasuredCurve& curve, double tolerance)
      : rows_(usable(curve)), free_(curve.free), tolerance_(tolerance) {
    found_.asked = curve.asked;
  }

  Verdict all() {
    if (rows_.size() == 0) return found_;
    found_.peak = rows_.model[rows_.top];
    found_.deepest = rows_.travel.maxCoeff();
    if (!(found_.peak > 0.0)) return found_;
    look_before_contact();
    look_at_noise();
    found_.allowed = tolerance_ * found_.peak;
    const bool noisy = found_.noise > 0.5 * found_.allowed;
    if (noisy) found_.allowed = 2.0 * found_.noise;
    found_.difference = rest(rows_.measured, rows_.model);
    found_.stiffness = ratio(rows_.measured);
    describe();
    const bool deep_enough = found_.deepest >= least_depth * found_.asked;
    const bool small = found_.difference <= found_.allowed;
    found_.outcome = small && deep_enough ? Verdict::Outcome::agrees : Verdict::Outcome::differs;
    if (!deep_enough) found_.causes.push_back(Cause::short_press);
    if (!small) {
      explain();
    } else {
      found_.explained = found_.sure = true;
      found_.outliers = far_readings(rows_.measured);
      if (found_.outliers > 0) found_.causes.push_back(Cause::outliers);
      if (noisy) found_.causes.push_back(Cause::noise);
    }
    return found_;
  }

 private:
  [[nodiscard]] bool in_contact(Eigen::Index i) const {
    return rows_.model[i] > barely * found_.peak;
  }

  // Without readings from above the surface, the rows before contact must do.
  void look_before_contact() {
    std::vector<double> before = free_;
    if (before.empty())
      for (Eigen::Index i = 0; i <= rows_.begin; ++i)
        if (!in_contact(i)) before.push_back(rows_.measured[i]);
    if (before.empty()) return;
    found_.offset = median(before);
    std::vector<double> after;
    for (Eigen::Index i = rows_.top; i < rows_.size(); ++i)
      if (!in_contact(i)) after.push_back(rows_.measured[i]);
    found_.drift = median(after) - found_.offset;
  }

  // The second differences of readings from the model, where what changes slowly is not seen.
  void look_at_noise() {
    std::vector<double> differences;
    const Array residuals = rows_.measured - rows_.model;
    for (const Eigen::Map<const Array>& values :
         {Eigen::Map<const Array>(free_.data(), static_cast<Eigen::Index>(free_.size())),
          Eigen::Map<const Array>(residuals.data(), residuals.size())})
      for (Eigen::Index i = 1; i + 1 < values.size(); ++i)
        differences.push_back(std::abs(values[i - 1] - 2.0 * values[i] + values[i + 1]));
    // Those of a normal distribution have a variance of 1 + 4 + 1, and half of them are below
    // 0.6745 of its root.
    if (differences.size() >= 5) found_.noise = median(differences) / (0.6745 * std::sqrt(6.0));
  }

  // N, rms of `force` minus `expected` over all rows.
  [[nodiscard]] static double rest(const Array& force, const Array& expected) {
    return std::sqrt((force - expected).square().mean());
  }

  // The measured force over the model's by least squares: with a constant offset if none is known.
  [[nodiscard]] double ratio(const Array& force) const {
    const bool known = std::isfinite(found_.offset);
    const Array model = rows_.model - (known ? 0.0 : rows_.model.mean());
    const double squares = model.square().sum();
    if (!(squares > 0.0)) return Verdict::unknown;
    return (model * (force - (known ? found_.offset : force.mean()))).sum() / squares;
  }

  // A weak correlation has a sign too, which means nothing, and one far reading can turn it.
  [[nodiscard]] bool seems_turned() const {
    if (!(found_.stiffness < -0.1)) return false;
    std::vector<double> pressed;
    for (Eigen::Index i = 0; i < rows_.size(); ++i)
      if (in_contact(i)) pressed.push_back(rows_.measured[i] - known_offset());
    return median(pressed) < 0.0;
  }

  // The measured force with its sign turned if need be, above `offset`.
  [[nodiscard]] Array corrected(double sign, double offset) const {
    return sign * (rows_.measured - offset);
  }
  [[nodiscard]] double known_offset() const {
    return std::isfinite(found_.offset) ? found_.offset : 0.0;
  }

  void describe() {
    const Array force = corrected(found_.stiffness < 0.0 ? -1.0 : 1.0, known_offset());
    found_.hysteresis = lost_energy(rows_, force);
    found_.hysteresis_model = lost_energy(rows_, rows_.model);
    const Eigen::Index top = rows_.top + 1;
    found_.contact = end_of_force(rows_, force, rows_.begin, top);
    found_.contact_model = end_of_force(rows_, rows_.model, rows_.begin, top);
    if (!std::isfinite(found_.hysteresis_model)) return;
    // On the way back the force of the hold is not that of the largest travel.
    Eigen::Index back = rows_.size();
    const double deepest = rows_.travel[rows_.top];
    while (back > rows_.top && rows_.travel[back - 1] < 0.95 * deepest) --back;
    found_.release = end_of_force(rows_, force, back, rows_.size());
    found_.release_model = end_of_force(rows_, rows_.model, back, rows_.size());
  }

  // A drift or a jump beyond the press turns the correlation as well: a turned sign is named only
  // where it is part of what explains the difference.
  void explain() {
    const Verdict before = found_;
    if (seems_turned()) {
      sign_ = -1.0;
      explain_with_sign();
      if (found_.sure) return;
    }
    const Verdict turned = std::exchange(found_, before);
    sign_ = 1.0;
    explain_with_sign();
    if (turned.explained && !found_.sure) found_ = turned;
  }

  void explain_with_sign() {
    const Array zeroed = corrected(sign_, known_offset());
    double most = 0.0;
    for (Eigen::Index i = 0; i < rows_.size(); ++i)
      if (in_contact(i)) most = std::max(most, std::abs(zeroed[i]));
    const bool tare = std::abs(known_offset()) > found_.allowed;
    if (most <= std::max(found_.allowed, 5.0 * found_.noise)) {
      if (tare) found_.causes.push_back(Cause::wrong_tare);
      found_.causes.push_back(Cause::no_specimen);
      found_.explained = found_.sure = true;
      return;
    }
    if (sign_ < 0.0) found_.causes.push_back(Cause::wrong_sign);
    const Array as_shown = corrected(sign_, 0.0);
    if (rest(as_shown, rows_.model) <= found_.allowed) {
      found_.explained = found_.sure = true;
      return;
    }
    Explanation best = best_of(as_shown);
    Explanation above_rest = best_of(zeroed);
    above_rest.score *= second_number;
    // An offset within what is allowed is no fault, and every cause may have it besides.
    if (!tare && above_rest.score < best.score) best = above_rest;
    const double left = rest(zeroed, rows_.model);
    if (left <= found_.allowed && left <= best.score) best = {Cause::wrong_tare, left};
    if (tare && !is_sure(best) && above_rest.score <= best.score) {
      found_.causes.push_back(Cause::wrong_tare);
      best = above_rest;
    }
    if (best.rest > found_.allowed) return;
    found_.causes.push_back(best.cause);
    found_.explained = true;
    found_.sure = is_sure(best);
    take(best);
  }

  // Another law of the specimen, or two faults, leave more beside what one fault explains of them.
  [[nodiscard]] bool is_sure(const Explanation& one) const {
    return square(one.rest) <= square(0.5 * found_.allowed) + square(found_.noise);
  }

  void take(const Explanation& best) {
    switch (best.cause) {
      case Cause::wrong_surface: found_.surface = best.value; break;
      case Cause::outliers: found_.outliers = static_cast<std::size_t>(best.value); break;
      case Cause::drift: found_.drift = best.value; break;
      case Cause::friction: found_.friction = best.value; break;
      case Cause::lag: found_.lag = best.value; break;
      case Cause::lost_force: found_.lost_at = best.value; break;
      case Cause::overload: found_.ceiling = best.value; break;
      default: break;
    }
  }

  // The cause that leaves the least of the difference, among those that leave what is allowed.
  [[nodiscard]] Explanation best_of(const Array& force) const {
    Explanation best;
    for (const Explanation& one :
         {by_outliers(force), by_stiffness(force), by_drift(force), by_friction(force),
          by_lag(force), by_loss(force), by_ceiling(force), by_surface(force)})
      if (one.rest <= found_.allowed && one.score < best.score) best = one;
    return best;
  }

  // How many readings are far off, if they are one in fifty at most; 0 otherwise.
  [[nodiscard]] std::size_t far_readings(const Array& force) const {
    const Eigen::Index few = 1 + rows_.size() / 50;
    if (rows_.size() < 10 * few) return 0;
    const Eigen::Index far = is_far(force).count();
    return far <= few ? as_index(far) : 0;
  }
  [[nodiscard]] Eigen::Array<bool, Eigen::Dynamic, 1> is_far(const Array& force) const {
    return (force - rows_.model).abs() > 3.0 * found_.allowed;
  }

  // A few readings alone are far off: without them the rest agrees.
  [[nodiscard]] Explanation by_outliers(const Array& force) const {
    const std::size_t far = far_readings(force);
    if (far == 0) return {};
    return {Cause::outliers, rest(force, is_far(force).select(force, rows_.model)),
            static_cast<double>(far)};
  }

  [[nodiscard]] Explanation by_stiffness(const Array& force) const {
    const double scale = (rows_.model * force).sum() / rows_.model.square().sum();
    if (!(scale > 0.1)) return {};
    // What is allowed grows with the force, as where the gauge's unit is another one.
    return {Cause::wrong_stiffness, rest(force, scale * rows_.model) / std::max(1.0, scale), scale};
  }

  // The gauge's zero moves evenly in time: a straight line through the residuals.
  [[nodiscard]] Explanation by_drift(const Array& force) const {
    const Array time = rows_.time - rows_.time.mean();
    const double spread = time.square().sum();
    if (!(spread > 0.0)) return {};
    const double mean = (force - rows_.model).mean();
    const double rate = (time * (force - rows_.model - mean)).sum() / spread;
    const double left = rest(force, rows_.model + mean + rate * time);
    const double change = sign_ * rate * (time[time.size() - 1] - time[0]);
    if (std::abs(change) <= found_.allowed) return {};  // the rest would be a tare
    return {Cause::drift, left, change, second_number * left};
  }

  // A force along the motion, of one size, which stays at rest as the last motion left it.
  [[nodiscard]] Explanation by_friction(const Array& force) const {
    const Array way = ways(rows_);
    const double size = (way * (force - rows_.model)).mean();
    if (!(size > 0.0)) return {};
    return {Cause::friction, rest(force, rows_.model + size * way), size};
  }

  // The force is that of an earlier time.
  [[nodiscard]] Explanation by_lag(const Array& force) const {
    const Eigen::Index last = rows_.size() - 1;
    Explanation best;
    constexpr int steps = 200;
    Array late(rows_.size());
    for (int i = 1; i <= steps; ++i) {
      const double lag = 0.25 * (rows_.time[last] - rows_.time[0]) * i / steps;
      Eigen::Index k = 0;
      for (Eigen::Index row = 0; row <= last; ++row) {
        const double time = rows_.time[row] - lag;
        while (k < last && rows_.time[k + 1] <= time) ++k;
        late[row] = rows_.model[k];
        if (time <= rows_.time[0] || k == last) continue;
        const double part = (time - rows_.time[k]) / (rows_.time[k + 1] - rows_.time[k]);
        late[row] += part * (rows_.model[k + 1] - rows_.model[k]);
      }
      if (const double left = rest(force, late); left < best.rest) best = {Cause::lag, left, lag};
    }
    return best;
  }

  // From a row on the gauge shows one force, whatever the model's is.
  [[nodiscard]] Explanation by_loss(const Array& force) const {
    const Array squares = (force - rows_.model).square();
    double before = squares.sum();  // of the rows before
    double n = 0.0;
    double mean = 0.0;
    double after = 0.0;  // squares of the distances from the mean of the rows from here on
    Explanation best;
    for (Eigen::Index i = rows_.size(); i-- > 0;) {
      before -= squares[i];
      n += 1.0;
      const double change = force[i] - mean;
      mean += change / n;
      after += change * (force[i] - mean);
      const double left =
          std::sqrt(std::max(0.0, before + after) / static_cast<double>(rows_.size()));
      if (in_contact(i) && left < best.rest)
        best = {Cause::lost_force, left, rows_.time[i], second_number * left};
    }
    return best;
  }

  // The gauge shows no more than its largest reading, which it then shows again and again.
  [[nodiscard]] Explanation by_ceiling(const Array& force) const {
    const double most = force.maxCoeff();
    const double near = std::max(2.0 * found_.noise, 0.01 * most);
    if ((force > most - near && rows_.model > most + near).count() < 3) return {};
    return {Cause::overload, rest(force, rows_.model.min(most)), most};
  }

  // The model's force for a specimen that begins `shift` (m) lower: in the press at the travel
  // less the shift; afterwards, where another computation would be needed, by Hertz's law of depth.
  [[nodiscard]] Array moved(const Press& press, double shift) const {
    Array force = Array::Zero(rows_.size());
    for (Eigen::Index i = 0; i < rows_.size(); ++i) {
      const double depth = rows_.travel[i];
      if (i <= rows_.top) {
        force[i] = press.at(depth - shift);
      } else if (depth > 0.0 && depth > shift) {
        const double share = (depth - shift) / depth;
        force[i] = rows_.model[i] * share * std::sqrt(share);
      }
    }
    return force;
  }

  // Shifts the model's press along the travel until it fits best. What remains is that of the whole
  // run.
  [[nodiscard]] Explanation by_surface(const Array& force) const {
    const Press press(rows_);
    if (press.size() < 5) return {};
    const auto left = [&](double shift) {
      double sum = 0.0;
      for (Eigen::Index i = rows_.begin; i <= rows_.top; ++i)
        sum += square(force[i] - press.at(rows_.travel[i] - shift));
      return sum;
    };
    constexpr int steps = 200;
    const double deepest = rows_.travel[rows_.top];
    double best = 0.0;
    for (int i = -steps; i <= steps; ++i) {
      const double shift = deepest * i / steps;
      if (left(shift) < left(best)) best = shift;
    }
    double width = deepest / steps;
    for (int i = 0; i < 30; ++i, width *= 0.7)
      for (const double shift : {best - width, best + width})
        if (left(shift) < left(best)) best = shift;
    return {Cause::wrong_surface, rest(force, moved(press, best)), best};
  }

  Rows rows_;
  std::vector<double> free_;
  double tolerance_;
  double sign_ = 1.0;  // by which the measured force is multiplied
  Verdict found_;
};

}  // namespace

bool Verdict::has(Cause cause) const { return std::ranges::find(causes, cause) != causes.end(); }

MeasuredCurve measured_curve(const record::CaseRecord& record,
                             const std::vector<scenario::Step>& steps, std::span<const double> free,
                             double until) {
  MeasuredCurve curve;
  for (std::size_t i = 0; i < record.measured.size(); ++i) {
    if (record.contact[i].time > until) break;
    curve.time.push_back(record.contact[i].time);
    curve.travel.push_back(-record.measured[i].place[2]);
    curve.model.push_back(record.contact[i].force);
    curve.measured.push_back(record.measured[i].force);
  }
  curve.free.assign(free.begin(), free.end());
  for (const scenario::Step& step : steps)
    if (const auto* indent = std::get_if<scenario::Indent>(&step); indent && !indent->to.second)
      curve.asked = std::max(curve.asked, indent->to.value);
  return curve;
}

Verdict judge(const MeasuredCurve& curve, double tolerance) {
  return Judgement(curve, tolerance).all();
}

namespace {

// A number that is only rounding is 0: no gauge has a nanometre or a nanonewton.
std::string text_of(double number, int digits = 2) {
  return rounded_text(std::abs(number) < 1e-6 ? 0.0 : number, digits);
}
std::string force_text(double force) { return text_of(force, 3) + " N"; }
std::string millinewtons(double force) { return text_of(1e3 * force) + " mN"; }
std::string length_text(double length) { return text_of(1e3 * length) + " mm"; }
std::string percent(double share) { return text_of(100.0 * share) + " %"; }

// In the order of Cause.
constexpr std::array names{
    "no_specimen", "wrong_sign",  "wrong_tare", "wrong_surface", "wrong_stiffness",
    "outliers",    "drift",       "friction",   "lag",           "lost_force",
    "overload",    "short_press", "noise"};
static_assert(names.size() == static_cast<std::size_t>(Cause::noise) + 1);

// What is wrong, and what to do about it.
std::string cause_clause(Cause cause, const Verdict& verdict) {
  switch (cause) {
    case Cause::no_specimen:
      return "no specimen: nothing is measured where the model has " + force_text(verdict.peak) +
             "; put it under the finger, or give its height by `--surface`";
    case Cause::wrong_sign:
      return "wrong sign: the gauge shows compression as negative; change its polarity (IPOL), or "
             "the way it is mounted";
    case Cause::wrong_tare:
      return "wrong tare: the gauge shows " + force_text(verdict.offset) +
             " out of contact; zero it out of contact";
    case Cause::wrong_surface:
      return "wrong surface: the specimen begins " + length_text(std::abs(verdict.surface)) +
             (verdict.surface > 0.0 ? " lower" : " higher") +
             " than assumed; give its height by `--surface`, or leave the option out";
    case Cause::wrong_stiffness:
      return "another stiffness: the specimen's force is " +
             rounded_text(std::abs(verdict.stiffness), 3) +
             " times the model's; `palpate identify` estimates its properties, if the gauge's unit "
             "is right";
    case Cause::outliers:
      return "outliers: " + std::to_string(verdict.outliers) +
             (verdict.outliers == 1 ? " reading is" : " readings are") +
             " far off, and all others agree; look for a loose cable";
    case Cause::drift:
      return "drift: the gauge's zero moves by " + millinewtons(verdict.drift) +
             " during the run; let it warm up, and zero it out of contact";
    case Cause::friction:
      return "friction: " + millinewtons(verdict.friction) +
             " along the motion, added on the way in and taken off on the way out; see what rubs";
    case Cause::lag:
      return "lag: the force is shown " + text_of(1e3 * verdict.lag) +
             " ms late; shorten the gauge's filter, or press slower";
    case Cause::lost_force:
      return "lost force: from " + text_of(verdict.lost_at, 3) +
             " s on the gauge does not follow the press; look at its cable";
    case Cause::overload:
      return "overload: the gauge shows no more than " + force_text(verdict.ceiling) +
             "; take one with a larger range, or press less deep";
    case Cause::short_press:
      return "short press: it ends at " + length_text(verdict.deepest) + " of " +
             length_text(verdict.asked) + "; press to the displacement that the scenario asks for";
    case Cause::noise:
      return "noise: the gauge scatters by " + millinewtons(verdict.noise) +
             ", and a smaller difference cannot be told; use a gauge of a smaller range, or its "
             "filter";
  }
  return {};
}

// Two numbers side by side, or the reason why there are none.
std::string beside_model(double measured, double model, std::string (*text)(double)) {
  return (std::isfinite(measured) ? text(measured) : "unknown") + " (model " +
         (std::isfinite(model) ? text(model) : "unknown") + ")";
}

}  // namespace

std::string verdict_sentence(const Verdict& verdict) {
  if (verdict.outcome == Verdict::Outcome::not_judged)
    return "measured and model are not compared, because no row has both a measured force and a "
           "force of the model";
  std::string text = verdict.outcome == Verdict::Outcome::agrees ? "measured and model agree: "
                                                                 : "measured and model differ: ";
  text += millinewtons(verdict.difference) + " rms, " + percent(verdict.difference / verdict.peak) +
          " of " + force_text(verdict.peak) + " (" + percent(verdict.allowed / verdict.peak) +
          " allowed)";
  if (std::isfinite(verdict.offset))
    text += ", " + millinewtons(verdict.offset) + " before contact";
  text += verdict.stiffness < 0.0 ? ", sign -" : ", sign +";
  if (std::isfinite(verdict.drift)) text += ", drift " + millinewtons(verdict.drift);
  if (std::isfinite(verdict.hysteresis_model))
    text += ", hysteresis " + beside_model(verdict.hysteresis, verdict.hysteresis_model, percent);
  text += ", contact at " + beside_model(verdict.contact, verdict.contact_model, length_text);
  if (std::isfinite(verdict.release_model))
    text += ", release at " + beside_model(verdict.release, verdict.release_model, length_text);
  for (const Cause cause : verdict.causes) text += "; " + cause_clause(cause, verdict);
  if (verdict.outcome == Verdict::Outcome::differs && !verdict.explained)
    text += "; no single fault of gauge, stand or specimen explains it";
  else if (!verdict.sure)
    text +=
        "; that leaves more than half of what is allowed, so that it cannot be told from another "
        "relaxation of the specimen or from two faults at once";
  return text;
}

std::vector<record::Finding> verdict_findings(const Verdict& verdict) {
  using Outcome = Verdict::Outcome;
  if (verdict.outcome == Outcome::not_judged) return {};
  std::string causes;
  for (const Cause cause : verdict.causes)
    causes += std::string(causes.empty() ? "" : " ") + names[static_cast<std::size_t>(cause)];
  if (!verdict.explained)
    causes += causes.empty() ? "unexplained" : " unexplained";
  else if (!verdict.sure)
    causes += " unsure";
  std::vector<record::Finding> findings;
  findings.push_back({"measured_verdict", verdict.outcome == Outcome::agrees
                                              ? std::string("agrees")
                                              : std::string("differs")});
  if (!causes.empty()) findings.push_back({"measured_causes", causes});
  const auto add = [&](const char* what, double value) {
    if (std::isfinite(value)) findings.push_back({what, value});
  };
  add("measured_difference_N", verdict.difference);
  add("measured_difference", verdict.difference / verdict.peak);
  add("measured_allowed", verdict.allowed / verdict.peak);
  add("measured_offset_N", verdict.offset);
  add("measured_noise_N", verdict.noise);
  add("measured_drift_N", verdict.drift);
  add("measured_stiffness", verdict.stiffness);
  add("measured_surface_mm", 1e3 * verdict.surface);
  add("measured_hysteresis", verdict.hysteresis);
  add("model_hysteresis", verdict.hysteresis_model);
  add("measured_contact_mm", 1e3 * verdict.contact);
  add("model_contact_mm", 1e3 * verdict.contact_model);
  add("measured_release_mm", 1e3 * verdict.release);
  add("model_release_mm", 1e3 * verdict.release_model);
  return findings;
}

}  // namespace palpate::live
