// Compares the two forces, and tries one explanation after the other on what remains.
#include "live/verdict.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "base/index.h"

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

// The rows with a measured force, divided at the largest force of the model.
struct Rows {
  std::vector<double> time, travel, model, measured;
  std::size_t begin = 0;  // the last row without contact before the largest force
  std::size_t top = 0;    // the largest force of the model
  [[nodiscard]] std::size_t size() const { return travel.size(); }
};

Rows usable(const MeasuredCurve& curve) {
  Rows rows;
  for (std::size_t i = 0; i < curve.measured.size(); ++i) {
    if (!std::isfinite(curve.measured[i])) continue;
    rows.time.push_back(curve.time.empty() ? static_cast<double>(i) : curve.time[i]);
    rows.travel.push_back(curve.travel[i]);
    rows.model.push_back(curve.model[i]);
    rows.measured.push_back(curve.measured[i]);
  }
  if (rows.size() == 0) return rows;
  rows.top = as_index(std::max_element(rows.model.begin(), rows.model.end()) - rows.model.begin());
  rows.begin = rows.top;
  while (rows.begin > 0 && rows.model[rows.begin] > barely * rows.model[rows.top]) --rows.begin;
  return rows;
}

// Where the line through F^(2/3) of the rows with 5 to 50 % of the largest force is zero, m.
double end_of_force(const Rows& rows, const std::vector<double>& force, std::size_t from,
                    std::size_t to) {
  double most = 0.0;
  for (std::size_t i = from; i < to; ++i) most = std::max(most, force[i]);
  double n = 0.0;
  double x = 0.0;
  double xx = 0.0;
  double y = 0.0;
  double xy = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    if (force[i] < 0.05 * most || force[i] > 0.5 * most) continue;
    const double root = std::cbrt(force[i] * force[i]);
    n += 1.0;
    x += rows.travel[i];
    xx += rows.travel[i] * rows.travel[i];
    y += root;
    xy += rows.travel[i] * root;
  }
  const double spread = n * xx - x * x;
  const double slope = (n * xy - x * y) / spread;
  if (n < 3.0 || !(spread > 0.0) || !(slope > 0.0)) return Verdict::unknown;
  // A line that is almost level meets zero anywhere.
  const double end = (x - y / slope) / n;
  const auto [low, high] = std::minmax_element(rows.travel.begin(), rows.travel.end());
  const double reach = *high - *low;
  return end >= *low - reach && end <= *high + reach ? end : Verdict::unknown;
}

// Energy lost over energy put in. Nothing if the finger has not come back half of its way.
double lost_energy(const Rows& rows, const std::vector<double>& force) {
  const double deepest = *std::max_element(rows.travel.begin(), rows.travel.end());
  if (rows.travel.back() > 0.5 * deepest) return Verdict::unknown;
  double in = 0.0;
  double out = 0.0;
  for (std::size_t i = rows.begin + 1; i < rows.size(); ++i) {
    const double work = 0.5 * (force[i] + force[i - 1]) * (rows.travel[i] - rows.travel[i - 1]);
    (work > 0.0 ? in : out) += work;
  }
  return in > 0.0 ? (in + out) / in : Verdict::unknown;
}

// The model's force in the press, over travel, continued as h^(3/2) below its last row.
class Press {
 public:
  explicit Press(const Rows& rows) {
    for (std::size_t i = rows.begin; i <= rows.top; ++i) {
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
    const auto k =
        as_index(std::upper_bound(travel_.begin(), travel_.end(), travel) - travel_.begin());
    const double part = (travel - travel_[k - 1]) / (travel_[k] - travel_[k - 1]);
    return force_[k - 1] + part * (force_[k] - force_[k - 1]);
  }

 private:
  std::vector<double> travel_, force_;
};

// 1 while the travel grows, -1 while it falls, as at the motion before where it rests. A way back
// of a fiftieth of the travel turns it.
std::vector<double> ways(const Rows& rows) {
  const auto [low, high] = std::minmax_element(rows.travel.begin(), rows.travel.end());
  const double enough = 0.02 * (*high - *low);
  std::vector<double> way(rows.size(), 1.0);
  double now = 1.0;
  std::size_t turn = 0;  // the row that is farthest that way
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double ahead = now * (rows.travel[i] - rows.travel[turn]);
    if (ahead < -enough) {
      now = -now;
      std::fill(way.begin() + static_cast<std::ptrdiff_t>(turn) + 1,
                way.begin() + static_cast<std::ptrdiff_t>(i), now);
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
    found_.deepest = *std::max_element(rows_.travel.begin(), rows_.travel.end());
    if (!(found_.peak > 0.0)) return found_;
    look_before_contact();
    look_at_noise();
    found_.allowed = tolerance_ * found_.peak;
    const bool noisy = found_.noise > 0.5 * found_.allowed;
    if (noisy) found_.allowed = 2.0 * found_.noise;
    found_.difference = rest(rows_.measured);
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
  [[nodiscard]] bool in_contact(std::size_t i) const {
    return rows_.model[i] > barely * found_.peak;
  }

  // Without readings from above the surface, the rows before contact must do.
  void look_before_contact() {
    std::vector<double> before = free_;
    if (before.empty())
      for (std::size_t i = 0; i <= rows_.begin; ++i)
        if (!in_contact(i)) before.push_back(rows_.measured[i]);
    if (before.empty()) return;
    found_.offset = median(before);
    std::vector<double> after;
    for (std::size_t i = rows_.top; i < rows_.size(); ++i)
      if (!in_contact(i)) after.push_back(rows_.measured[i]);
    found_.drift = median(after) - found_.offset;
  }

  // The second differences of readings from the model, where what changes slowly is not seen.
  void look_at_noise() {
    std::vector<double> differences;
    const auto add = [&](const std::vector<double>& values) {
      for (std::size_t i = 1; i + 1 < values.size(); ++i)
        differences.push_back(std::abs(values[i - 1] - 2.0 * values[i] + values[i + 1]));
    };
    std::vector<double> residuals;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      residuals.push_back(rows_.measured[i] - rows_.model[i]);
    add(free_);
    add(residuals);
    // Those of a normal distribution have a variance of 1 + 4 + 1, and half of them are below
    // 0.6745 of its root.
    if (differences.size() >= 5) found_.noise = median(differences) / (0.6745 * std::sqrt(6.0));
  }

  // N, rms of `force` minus `expected(i)` over all rows.
  template <typename Expected>
  [[nodiscard]] double rest(const std::vector<double>& force, const Expected& expected) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double residual = force[i] - expected(i);
      sum += residual * residual;
    }
    return std::sqrt(sum / static_cast<double>(rows_.size()));
  }
  [[nodiscard]] double rest(const std::vector<double>& force) const {
    return rest(force, [&](std::size_t i) { return rows_.model[i]; });
  }

  // The measured force over the model's by least squares: with a constant offset if none is known.
  [[nodiscard]] double ratio(const std::vector<double>& force) const {
    const auto count = static_cast<double>(rows_.size());
    double known = found_.offset;
    double x = 0.0;
    if (!std::isfinite(known)) {
      known = 0.0;
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        known += force[i] / count;
        x += rows_.model[i] / count;
      }
    }
    double xy = 0.0;
    double xx = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      xy += (rows_.model[i] - x) * (force[i] - known);
      xx += (rows_.model[i] - x) * (rows_.model[i] - x);
    }
    return xx > 0.0 ? xy / xx : Verdict::unknown;
  }

  // A weak correlation has a sign too, which means nothing, and one far reading can turn it.
  [[nodiscard]] bool seems_turned() const {
    if (!(found_.stiffness < -0.1)) return false;
    std::vector<double> pressed;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (in_contact(i)) pressed.push_back(rows_.measured[i] - known_offset());
    return median(pressed) < 0.0;
  }

  // The measured force with its sign turned if need be, above `offset`.
  [[nodiscard]] std::vector<double> corrected(double sign, double offset) const {
    std::vector<double> force;
    for (const double reading : rows_.measured) force.push_back(sign * (reading - offset));
    return force;
  }
  [[nodiscard]] double known_offset() const {
    return std::isfinite(found_.offset) ? found_.offset : 0.0;
  }

  void describe() {
    const std::vector<double> force =
        corrected(found_.stiffness < 0.0 ? -1.0 : 1.0, known_offset());
    found_.hysteresis = lost_energy(rows_, force);
    found_.hysteresis_model = lost_energy(rows_, rows_.model);
    const std::size_t top = rows_.top + 1;
    found_.contact = end_of_force(rows_, force, rows_.begin, top);
    found_.contact_model = end_of_force(rows_, rows_.model, rows_.begin, top);
    if (!std::isfinite(found_.hysteresis_model)) return;
    // On the way back the force of the hold is not that of the largest travel.
    std::size_t back = rows_.size();
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
    const std::vector<double> zeroed = corrected(sign_, known_offset());
    double most = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (in_contact(i)) most = std::max(most, std::abs(zeroed[i]));
    const bool tare = std::abs(known_offset()) > found_.allowed;
    if (most <= std::max(found_.allowed, 5.0 * found_.noise)) {
      if (tare) found_.causes.push_back(Cause::wrong_tare);
      found_.causes.push_back(Cause::no_specimen);
      found_.explained = found_.sure = true;
      return;
    }
    if (sign_ < 0.0) found_.causes.push_back(Cause::wrong_sign);
    const std::vector<double> as_shown = corrected(sign_, 0.0);
    if (rest(as_shown) <= found_.allowed) {
      found_.explained = found_.sure = true;
      return;
    }
    Explanation best = best_of(as_shown);
    Explanation above_rest = best_of(zeroed);
    above_rest.score *= second_number;
    // An offset within what is allowed is no fault, and every cause may have it besides.
    if (!tare && above_rest.score < best.score) best = above_rest;
    const double left = rest(zeroed);
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
  [[nodiscard]] Explanation best_of(const std::vector<double>& force) const {
    Explanation best;
    for (const Explanation& one :
         {by_outliers(force), by_stiffness(force), by_drift(force), by_friction(force),
          by_lag(force), by_loss(force), by_ceiling(force), by_surface(force)})
      if (one.rest <= found_.allowed && one.score < best.score) best = one;
    return best;
  }

  // How many readings are far off, if they are one in fifty at most; 0 otherwise.
  [[nodiscard]] std::size_t far_readings(const std::vector<double>& force) const {
    const std::size_t few = 1 + rows_.size() / 50;
    if (rows_.size() < 10 * few) return 0;
    std::size_t far = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (is_far(force, i)) ++far;
    return far <= few ? far : 0;
  }
  [[nodiscard]] bool is_far(const std::vector<double>& force, std::size_t i) const {
    return std::abs(force[i] - rows_.model[i]) > 3.0 * found_.allowed;
  }

  // A few readings alone are far off: without them the rest agrees.
  [[nodiscard]] Explanation by_outliers(const std::vector<double>& force) const {
    const std::size_t far = far_readings(force);
    if (far == 0) return {};
    const double near =
        rest(force, [&](std::size_t i) { return is_far(force, i) ? force[i] : rows_.model[i]; });
    return {Cause::outliers, near, static_cast<double>(far)};
  }

  [[nodiscard]] Explanation by_stiffness(const std::vector<double>& force) const {
    double xy = 0.0;
    double xx = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      xy += rows_.model[i] * force[i];
      xx += rows_.model[i] * rows_.model[i];
    }
    const double scale = xy / xx;
    if (!(scale > 0.1)) return {};
    // What is allowed grows with the force, as where the gauge's unit is another one.
    return {
        Cause::wrong_stiffness,
        rest(force, [&](std::size_t i) { return scale * rows_.model[i]; }) / std::max(1.0, scale),
        scale};
  }

  // The gauge's zero moves evenly in time: a straight line through the residuals.
  [[nodiscard]] Explanation by_drift(const std::vector<double>& force) const {
    const auto count = static_cast<double>(rows_.size());
    double t = 0.0;
    double y = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      t += rows_.time[i] / count;
      y += (force[i] - rows_.model[i]) / count;
    }
    double tt = 0.0;
    double ty = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      tt += (rows_.time[i] - t) * (rows_.time[i] - t);
      ty += (rows_.time[i] - t) * (force[i] - rows_.model[i] - y);
    }
    if (!(tt > 0.0)) return {};
    const double rate = ty / tt;
    const double left =
        rest(force, [&](std::size_t i) { return rows_.model[i] + y + rate * (rows_.time[i] - t); });
    const double change = sign_ * rate * (rows_.time.back() - rows_.time.front());
    if (std::abs(change) <= found_.allowed) return {};  // the rest would be a tare
    return {Cause::drift, left, change, second_number * left};
  }

  // A force along the motion, of one size, which stays at rest as the last motion left it.
  [[nodiscard]] Explanation by_friction(const std::vector<double>& force) const {
    const std::vector<double> way = ways(rows_);
    double xy = 0.0;
    double xx = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      xy += way[i] * (force[i] - rows_.model[i]);
      xx += way[i] * way[i];
    }
    if (!(xy > 0.0)) return {};
    const double size = xy / xx;
    return {Cause::friction,
            rest(force, [&](std::size_t i) { return rows_.model[i] + size * way[i]; }), size};
  }

  // The force is that of an earlier time.
  [[nodiscard]] Explanation by_lag(const std::vector<double>& force) const {
    const double span = rows_.time.back() - rows_.time.front();
    Explanation best;
    constexpr int steps = 200;
    for (int i = 1; i <= steps; ++i) {
      const double lag = 0.25 * span * i / steps;
      std::size_t k = 0;
      const double left = rest(force, [&](std::size_t row) {
        const double time = rows_.time[row] - lag;
        while (k + 1 < rows_.size() && rows_.time[k + 1] <= time) ++k;
        if (time <= rows_.time.front() || k + 1 == rows_.size()) return rows_.model[k];
        const double part = (time - rows_.time[k]) / (rows_.time[k + 1] - rows_.time[k]);
        return rows_.model[k] + part * (rows_.model[k + 1] - rows_.model[k]);
      });
      if (left < best.rest) best = {Cause::lag, left, lag};
    }
    return best;
  }

  // From a row on the gauge shows one force, whatever the model's is.
  [[nodiscard]] Explanation by_loss(const std::vector<double>& force) const {
    double before = 0.0;  // squares of the residuals of the rows before
    for (std::size_t i = 0; i < rows_.size(); ++i) before += square(force[i] - rows_.model[i]);
    double n = 0.0;
    double mean = 0.0;
    double squares = 0.0;  // of the distances from the mean of the rows from here on
    Explanation best;
    for (std::size_t i = rows_.size(); i-- > 0;) {
      before -= square(force[i] - rows_.model[i]);
      n += 1.0;
      const double change = force[i] - mean;
      mean += change / n;
      squares += change * (force[i] - mean);
      const double left =
          std::sqrt(std::max(0.0, before + squares) / static_cast<double>(rows_.size()));
      if (in_contact(i) && left < best.rest)
        best = {Cause::lost_force, left, rows_.time[i], second_number * left};
    }
    return best;
  }

  // The gauge shows no more than its largest reading, which it then shows again and again.
  [[nodiscard]] Explanation by_ceiling(const std::vector<double>& force) const {
    const double most = *std::max_element(force.begin(), force.end());
    const double near = std::max(2.0 * found_.noise, 0.01 * most);
    std::size_t there = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (force[i] > most - near && rows_.model[i] > most + near) ++there;
    if (there < 3) return {};
    return {Cause::overload,
            rest(force, [&](std::size_t i) { return std::min(rows_.model[i], most); }), most};
  }

  // The model's force for a specimen that begins `shift` (m) lower: in the press at the travel
  // less the shift; afterwards, where another computation would be needed, by Hertz's law of depth.
  [[nodiscard]] std::function<double(std::size_t)> moved(double shift) const {
    return [this, shift, press = Press(rows_)](std::size_t i) {
      const double depth = rows_.travel[i];
      if (i <= rows_.top) return press.at(depth - shift);
      if (!(depth > 0.0) || depth <= shift) return 0.0;
      const double share = (depth - shift) / depth;
      return rows_.model[i] * share * std::sqrt(share);
    };
  }

  // Shifts the model's press along the travel until it fits best. What remains is that of the whole
  // run.
  [[nodiscard]] Explanation by_surface(const std::vector<double>& force) const {
    const Press press(rows_);
    if (press.size() < 5) return {};
    const auto left = [&](double shift) {
      double sum = 0.0;
      for (std::size_t i = rows_.begin; i <= rows_.top; ++i)
        sum += square(force[i] - press.at(rows_.travel[i] - shift));
      return std::sqrt(sum / static_cast<double>(rows_.top - rows_.begin + 1));
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
    return {Cause::wrong_surface, rest(force, moved(best)), best};
  }

  Rows rows_;
  std::vector<double> free_;
  double tolerance_;
  double sign_ = 1.0;  // by which the measured force is multiplied
  Verdict found_;
};

}  // namespace

bool Verdict::has(Cause cause) const {
  return std::find(causes.begin(), causes.end(), cause) != causes.end();
}

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

}  // namespace palpate::live
