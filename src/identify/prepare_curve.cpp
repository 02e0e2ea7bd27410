// Chooses the points that are used, the model, and the weights of the residuals.
#include "identify/prepare_curve.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "fit/parts.h"
#include "fit/regression.h"
#include "identify/box_search.h"
#include "identify/scenario_curve.h"

namespace palpate::identify {
namespace {

class Preparation {
 public:
  Preparation(const Measurement& measured, const scenario::Family& family,
              const std::vector<Unknown>& unknowns)
      : measured_(measured), family_(family), unknowns_(unknowns) {}

  PreparedCurve all(Noise noise) {
    const scenario::Case& asked = family_.cases.front();
    found_.kind = curve_of(measured_, asked.scenario, unknowns_);
    check_pseudo_keys();
    choose_model(asked);
    choose_points();
    average();
    made_.curve->set_points(found_.x);
    weigh(noise);
    return std::move(made_);
  }

 private:
  [[nodiscard]] const Unknown* unknown_of(Unknown::What what) const {
    for (const Unknown& one : unknowns_)
      if (one.what == what) return &one;
    return nullptr;
  }

  void check_pseudo_keys() {
    for (const auto& [what, does] :
         {std::pair{Unknown::What::contact_point, "contact_point` shifts a displacement"},
          {Unknown::What::force_tilt, "force_tilt` is the slope of a force over a displacement"}})
      if (unknown_of(what) != nullptr && kind_ != CurveKind::force_travel)
        refuse("`--unknown " + std::string(does) + ", and this curve is " +
               words_of(kind_).sentence + "; give force over displacement, or leave it out");
    if (unknown_of(Unknown::What::force_offset) != nullptr &&
        (kind_ == CurveKind::strain_time || kind_ == CurveKind::stress_time ||
         kind_ == CurveKind::stress_strain))
      refuse("`--unknown force_offset` is added to a force, and this curve is " +
             std::string(words_of(kind_).sentence) + "; leave it out");
    if (unknown_of(Unknown::What::force_delay) != nullptr && kind_ != CurveKind::force_time)
      refuse("`--unknown force_delay` shifts a force over time, and this curve is " +
             std::string(words_of(kind_).sentence) + "; leave it out");
  }

  void choose_model(scenario::Case asked) {
    const Unknown* contact = unknown_of(Unknown::What::contact_point);
    double farthest = 0.0;
    for (const double x : measured_.x) farthest = std::max(farthest, x);
    farthest -= contact != nullptr ? contact->low : 0.0;
    asked.scenario = part_for(kind_, asked.scenario, farthest);
    const bool travel = kind_ == CurveKind::force_travel;
    double end = *std::ranges::max_element(measured_.x);
    if (travel && contact != nullptr) end -= contact->value(0.5);
    const bool goes_on = still_in_the_last_step(asked.scenario);
    if (goes_on && lengthen(kind_, asked.scenario, end))
      found_.notes.push_back(
          "the loading history is shorter than the measurement and is lengthened to " +
          x_text(end));
    const FixedModel fixed = fix_model(asked, family_.document, unknowns_);
    found_.given = fixed.given;
    found_.worst_error = fixed.worst_error;
    found_.taken = fixed.model;
    made_.curve = std::make_unique<ScenarioCurve>(kind_, fixed, family_, unknowns_);
    found_.closed_form = made_.curve->has_formula();
    if (goes_on) made_.curve->set_farthest(*std::ranges::max_element(measured_.x));
  }

  [[nodiscard]] std::size_t shift_of(const Unknown* one) const {
    return as_index(one - unknowns_.data());
  }

  // Whether the rows beyond the loading history can belong to its last step. A finger that
  // withdraws after a hold leaves half to one and a half times the force at the end of the loading
  // history.
  [[nodiscard]] bool still_in_the_last_step(const scenario::Scenario& scenario) const {
    if (kind_ != CurveKind::force_time) return true;
    const auto end = duration(scenario);
    if (!end) return true;
    double held = 0.0;
    for (std::size_t i = 0; i < measured_.x.size(); ++i)
      if (measured_.x[i] <= *end) held = measured_.y[i];
    for (std::size_t i = 0; i < measured_.x.size(); ++i)
      if (measured_.x[i] > *end && std::abs(measured_.y[i] - held) > 0.5 * std::abs(held))
        return false;
    return true;
  }

  [[nodiscard]] std::string x_text(double si) const {
    const Unit& unit = words_of(kind_).x;
    return rounded_text(unit.from_si(si)) + (*unit.symbol == '\0' ? "" : " ") + unit.symbol;
  }

  void note_excluded(int points, const std::string& why) {
    if (points == 0) return;
    found_.excluded += points;
    found_.notes.push_back(fit::excluded_text(as_index(points), why));
  }

  // Takes the points up to the end of the loading history, which is run at the first of the
  // search's starts where it can be (the middle of the box, if possible).
  void choose_points() {
    std::optional<ScenarioCurve::Rows> rows;
    std::vector<double> first;
    std::string failure;
    for (const std::vector<double>& u : search_starts(unknowns_.size())) {
      std::vector<double> values;
      for (std::size_t i = 0; i < u.size(); ++i) values.push_back(unknowns_[i].value(u[i]));
      rows = made_.curve->rows(values);
      first = u;
      if (rows) break;
      if (failure.empty()) failure = made_.curve->failure();
    }
    if (!rows)
      refuse("the scenario cannot be run anywhere in the ranges of `--unknown`: " + failure);
    const Unknown* contact = unknown_of(Unknown::What::contact_point);
    const bool travel = kind_ == CurveKind::force_travel;
    double end = rows->x.back() * (1.0 + 1e-9);
    if (contact != nullptr) end += contact->value(first[shift_of(contact)]);
    // If the finger withdraws, only the points up to the deepest travel are used.
    std::size_t count = measured_.x.size();
    if (travel && count > 0) {
      const auto part = fit::one_way(measured_.x, fit::Way::approach);
      if (part.loadings == 0)
        refuse(
            "`" + measured_.x_name +
            "` falls from its first row to its last: these are rows of the way back, and the way "
            "in is computed; choose other rows, or fit them by `palpate fit --segment retract`");
      if (part.loadings > 1)
        found_.notes.push_back("the first of " + std::to_string(part.loadings) +
                               " loadings is fitted; `--rows` chooses the rows of another");
      note_excluded(static_cast<int>(count - part.to),
                    part.loadings > 1 ? "the way back, and other loadings"
                                      : "the way back from the largest displacement");
      count = part.to;
      if (contact == nullptr)
        found_.notes.push_back("contact is taken to begin at 0 of `" + measured_.x_name +
                               "`; `--unknown contact_point=LOW..HIGH` fits it");
    }
    if (kind_ == CurveKind::stress_strain) {
      // A hold, whose strain is noisy, begins within a thousandth of the largest strain.
      const double most = *std::ranges::max_element(measured_.x);
      const auto held =
          std::ranges::find_if(measured_.x, [&](double x) { return x >= 0.999 * most; });
      count = as_index(held - measured_.x.begin()) + 1;
      note_excluded(static_cast<int>(measured_.x.size() - count), "after the largest strain");
    }
    if (travel || kind_ == CurveKind::stress_strain) {
      if (const fit::Limit limit = fit::limit_of({measured_.y.data(), count}); limit.to == count) {
        note_excluded(static_cast<int>(count - limit.from),
                      "the load stays at its largest value, as at the limit of a sensor");
        count = limit.from;
      }
      const auto whole = fit::rows_before_break({measured_.y.data(), count});
      note_excluded(static_cast<int>(count - whole),
                    "beyond the largest load, from which it falls by over 10 %");
      count = whole;
    }
    int beyond = 0;
    int before = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double x = measured_.x[i];
      if (x > end)
        ++beyond;
      else if (!travel && x < 0.0)
        ++before;
      else {
        found_.x.push_back(x);
        found_.measured.push_back(measured_.y[i]);
      }
    }
    note_excluded(beyond, "beyond the loading history, which ends at " + x_text(rows->x.back()) +
                              " (its last step ends at a force, or the force leaves it)");
    note_excluded(before, "before the loading history begins, at " + x_text(0.0));
    refuse_poor_data();
  }

  // The cost of a search grows with the rows, and means of neighbours say as much as they do.
  void average() {
    if (found_.x.size() <= most_rows) return;
    AveragedRows means = averaged(found_.x, found_.measured);
    found_.notes.push_back(std::to_string(found_.x.size()) + " rows are averaged to " +
                           std::to_string(means.x.size()) +
                           " points, means of neighbours over which the curve is straight");
    found_.x = std::move(means.x);
    found_.measured = std::move(means.y);
    counts_ = std::move(means.count);
    made_.rows_each = *std::ranges::max_element(counts_);
  }

  void refuse_poor_data() const {
    const std::size_t points = found_.x.size();
    if (points <= unknowns_.size())
      refuse(std::to_string(points) + (points == 1 ? " usable point" : " usable points") +
             " cannot determine " + std::to_string(unknowns_.size()) +
             (unknowns_.size() == 1 ? " unknown" : " unknowns") +
             " and the noise; record more points, or remove an `--unknown`");
    const auto [least, most] = std::ranges::minmax_element(found_.measured);
    if (*least == *most)
      refuse("`" + measured_.y_name +
             "` is the same at every point, which determines no property; name another column with "
             "`--y`");
  }

  void weigh(Noise noise) {
    const auto [least, most] = std::ranges::minmax_element(found_.measured);
    const double range = *most - *least;
    const double largest = std::max(std::abs(*least), std::abs(*most));
    for (const double y : found_.measured)
      made_.weights.push_back(
          noise == Noise::constant ? 1.0 / range : 1.0 / std::max(std::abs(y), 0.01 * largest));
    for (std::size_t i = 0; i < counts_.size(); ++i)
      made_.weights[i] *= std::sqrt(counts_[i] / made_.rows_each);
  }

  const Measurement& measured_;
  const scenario::Family& family_;
  const std::vector<Unknown>& unknowns_;
  PreparedCurve made_;
  Identification& found_ = made_.found;
  const CurveKind& kind_ = found_.kind;
  std::vector<double> counts_;  // rows of each point, where they are averaged
};

}  // namespace

PreparedCurve prepare_curve(const Measurement& measured, const scenario::Family& family,
                            const std::vector<Unknown>& unknowns, Noise noise) {
  return Preparation(measured, family, unknowns).all(noise);
}

// Blocks are halved where the curve bends within them.

namespace {

class Blocks {
 public:
  Blocks(const std::vector<double>& x, const std::vector<double>& y) : x_(x), y_(y) {
    const auto [low, high] = std::ranges::minmax_element(y);
    least_ = 1e-4 * (*high - *low);
    noise_ = fit::noise_of(y);
    constexpr std::size_t count = 1500;
    for (std::size_t k = 0; k < count; ++k) add(y.size() * k / count, y.size() * (k + 1) / count);
  }

  AveragedRows found;

 private:
  void add(std::size_t from, std::size_t to) {
    const std::size_t size = to - from;
    if (size >= 2 && bends(from, to)) {
      add(from, from + size / 2);
      add(from + size / 2, to);
      return;
    }
    found.x.push_back(mean(x_, from, to));
    found.y.push_back(mean(y_, from, to));
    found.count.push_back(static_cast<double>(size));
  }

  [[nodiscard]] bool bends(std::size_t from, std::size_t to) const {
    const std::size_t size = to - from;
    if (size < 4) return std::abs(y_[to - 1] - y_[from]) > std::max(least_, 6.0 * noise_);
    const std::size_t a = from + size / 4;
    const std::size_t b = to - size / 4;
    const double outer = 0.5 * (mean(y_, from, a) + mean(y_, b, to));
    const double error = noise_ * std::sqrt(4.0 / static_cast<double>(size));
    return std::abs(mean(y_, a, b) - outer) > std::max(least_, 4.0 * error);
  }

  static double mean(const std::vector<double>& values, std::size_t from, std::size_t to) {
    double sum = 0.0;
    for (std::size_t i = from; i < to; ++i) sum += values[i];
    return sum / static_cast<double>(to - from);
  }

  const std::vector<double>& x_;
  const std::vector<double>& y_;
  double least_ = 0.0;
  double noise_ = 0.0;
};

}  // namespace

AveragedRows averaged(const std::vector<double>& x, const std::vector<double>& y) {
  return std::move(Blocks(x, y).found);
}

}  // namespace palpate::identify
