// Compares the two forces, and tries one explanation after the other on what remains.
#include "live/verdict.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace palpate::live {
namespace {

constexpr double barely = 1e-3;  // of the model's largest force: no contact

double median(std::vector<double> values) {
  if (values.empty()) return Verdict::unknown;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? Verdict::unknown : std::sqrt(sum / static_cast<double>(values.size()));
}

// The rows with a measured force, divided at the largest force of the model.
struct Rows {
  std::vector<double> travel, model, measured;
  std::size_t begin = 0;  // the last row without contact before the largest force
  std::size_t top = 0;    // the largest force of the model
  [[nodiscard]] std::size_t size() const { return travel.size(); }
};

Rows usable(const MeasuredCurve& curve) {
  Rows rows;
  for (std::size_t i = 0; i < curve.measured.size(); ++i) {
    if (!std::isfinite(curve.measured[i])) continue;
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

class Judgement {
 public:
  Judgement(const MeasuredCurve& curve, double tolerance)
      : rows_(usable(curve)), free_(curve.free), tolerance_(tolerance) {}

  Verdict all() {
    if (rows_.size() == 0) return found_;
    found_.peak = rows_.model[rows_.top];
    if (!(found_.peak > 0.0)) return found_;
    look_before_contact();
    found_.allowed = tolerance_ * found_.peak;
    if (found_.noise > 0.5 * found_.allowed) found_.allowed = 2.0 * found_.noise;
    found_.difference = rest(rows_.measured);
    found_.stiffness = ratio(rows_.measured);
    describe();
    found_.outcome =
        found_.difference <= found_.allowed ? Verdict::Outcome::agrees : Verdict::Outcome::differs;
    if (found_.outcome == Verdict::Outcome::differs) explain();
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
    std::vector<double> away;
    for (const double reading : before) away.push_back(std::abs(reading - found_.offset));
    // Of a normal distribution the median distance is 0.6745 standard deviations.
    if (before.size() >= 5) found_.noise = median(away) / 0.6745;
    std::vector<double> after;
    for (std::size_t i = rows_.top; i < rows_.size(); ++i)
      if (!in_contact(i)) after.push_back(rows_.measured[i]);
    found_.drift = median(after) - found_.offset;
  }

  // N, rms of `force` minus the model.
  [[nodiscard]] double rest(const std::vector<double>& force) const {
    std::vector<double> residual;
    for (std::size_t i = 0; i < rows_.size(); ++i) residual.push_back(force[i] - rows_.model[i]);
    return root_mean_square(residual);
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

  // The measured force with its sign turned and without its offset.
  [[nodiscard]] std::vector<double> corrected() const {
    const double sign = found_.stiffness < 0.0 ? -1.0 : 1.0;
    const double offset = std::isfinite(found_.offset) ? found_.offset : 0.0;
    std::vector<double> force;
    for (const double reading : rows_.measured) force.push_back(sign * (reading - offset));
    return force;
  }

  void describe() {
    const std::vector<double> force = corrected();
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

  void explain() {
    std::vector<double> force = corrected();
    double most = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (in_contact(i)) most = std::max(most, std::abs(force[i]));
    if (most <= std::max(found_.allowed, 5.0 * found_.noise)) {
      add_tare();
      found_.causes.push_back(Cause::no_specimen);
      found_.explained = true;
      return;
    }
    // A weak correlation has a sign too, which means nothing.
    if (found_.stiffness < -0.1) found_.causes.push_back(Cause::wrong_sign);
    add_tare();
    if (rest(force) <= found_.allowed) {
      found_.explained = true;
      return;
    }
    if (explain_by_outliers(force) || explain_by_drift(force)) {
      found_.explained = true;
      return;
    }
    const double scale = std::abs(found_.stiffness);
    std::vector<double> scaled;
    for (const double each : force) scaled.push_back(each / scale);
    const double by_stiffness = scale > 0.1 ? rest(scaled) * scale : Verdict::unknown;
    const double by_surface = find_surface(force);
    // Another surface shows in the press: where the press agrees as it is, the difference is
    // elsewhere.
    const bool surface = !(by_surface > by_stiffness) && by_surface <= found_.allowed &&
                         press_rest(force) > found_.allowed;
    if (!surface) found_.surface = Verdict::unknown;
    if (surface) found_.causes.push_back(Cause::wrong_surface);
    if (!surface && by_stiffness <= found_.allowed) found_.causes.push_back(Cause::wrong_stiffness);
    found_.explained = surface || by_stiffness <= found_.allowed;
  }

  // A few readings alone are far off: without the farthest, one in fifty, the rest agrees.
  bool explain_by_outliers(const std::vector<double>& force) {
    std::vector<double> away;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      away.push_back(std::abs(force[i] - rows_.model[i]));
    const std::size_t few = 1 + away.size() / 50;
    if (away.size() < 10 * few) return false;
    std::sort(away.begin(), away.end());
    const double far = 3.0 * found_.allowed;
    const auto off = as_index(away.end() - std::upper_bound(away.begin(), away.end(), far));
    if (off == 0 || off > few) return false;
    away.resize(away.size() - off);
    if (root_mean_square(away) > found_.allowed) return false;
    found_.causes.push_back(Cause::outliers);
    found_.outliers = off;
    return true;
  }

  // The gauge's zero moves evenly over the run: in the order of the rows, which are taken at a
  // constant rate.
  bool explain_by_drift(std::vector<double> force) {
    if (!(std::abs(found_.drift) > found_.allowed)) return false;
    const double sign = found_.stiffness < 0.0 ? -1.0 : 1.0;
    const double last = static_cast<double>(rows_.size() - 1);
    for (std::size_t i = 0; i < force.size(); ++i)
      force[i] -= sign * found_.drift * static_cast<double>(i) / last;
    if (rest(force) > found_.allowed) return false;
    found_.causes.push_back(Cause::drift);
    return true;
  }

  // N, rms of `force` minus the model in the press.
  [[nodiscard]] double press_rest(const std::vector<double>& force) const {
    std::vector<double> residual;
    for (std::size_t i = rows_.begin; i <= rows_.top; ++i)
      residual.push_back(force[i] - rows_.model[i]);
    return root_mean_square(residual);
  }

  void add_tare() {
    if (std::abs(found_.offset) > found_.allowed) found_.causes.push_back(Cause::wrong_tare);
  }

  // Shifts the model's press along the travel until it fits best. Returns the rms that remains in
  // the press, N; the rest of the run would need another computation.
  double find_surface(const std::vector<double>& force) {
    const Press press(rows_);
    if (press.size() < 5) return Verdict::unknown;
    const auto left = [&](double shift) {
      std::vector<double> residual;
      for (std::size_t i = rows_.begin; i <= rows_.top; ++i)
        residual.push_back(force[i] - press.at(rows_.travel[i] - shift));
      return root_mean_square(residual);
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
    found_.surface = best;
    return left(best);
  }

  Rows rows_;
  std::vector<double> free_;
  double tolerance_;
  Verdict found_;
};

}  // namespace

bool Verdict::has(Cause cause) const {
  return std::find(causes.begin(), causes.end(), cause) != causes.end();
}

MeasuredCurve measured_curve(const record::CaseRecord& record, std::span<const double> free) {
  MeasuredCurve curve;
  for (std::size_t i = 0; i < record.measured.size(); ++i) {
    curve.travel.push_back(-record.measured[i].place[2]);
    curve.model.push_back(record.contact[i].force);
    curve.measured.push_back(record.measured[i].force);
  }
  curve.free.assign(free.begin(), free.end());
  return curve;
}

Verdict judge(const MeasuredCurve& curve, double tolerance) {
  return Judgement(curve, tolerance).all();
}

}  // namespace palpate::live
