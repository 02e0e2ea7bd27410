// The largest value or the first departure from the first level, against the scatter of the rows.
#include "fit/step_origin.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"

namespace palpate::fit {

double noise_of(std::span<const double> y) {
  std::vector<double> bends;
  for (std::size_t i = 2; i < y.size(); ++i)
    bends.push_back(std::abs(y[i] - 2.0 * y[i - 1] + y[i - 2]));
  if (bends.size() < 3) return 0.0;
  const auto middle = bends.begin() + static_cast<std::ptrdiff_t>(bends.size() / 2);
  std::nth_element(bends.begin(), middle, bends.end());
  // The median of |N(0, 1)| is 0.6745; a second difference has sqrt(6) times the deviation.
  return *middle / (0.6745 * std::sqrt(6.0));
}

namespace {

struct Record {
  std::vector<double> x, y;  // finite, by ascending x

  [[nodiscard]] double gap_after(std::size_t i) const {
    const std::size_t k = std::min(i, x.size() - 2);
    return x[k + 1] - x[k];
  }
};

Record record_of(std::span<const double> x, std::span<const double> y) {
  std::vector<std::pair<double, double>> rows;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) rows.emplace_back(x[i], y[i]);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto& one, const auto& other) { return one.first < other.first; });
  Record record;
  for (const auto& [time, value] : rows) {
    record.x.push_back(time);
    record.y.push_back(value);
  }
  return record;
}

// Rheometers space their rows by a constant factor of the time since the step.
bool spaced_by_a_factor(const Record& record) {
  if (record.x.size() < 6 || !(record.x.front() > 0.0)) return false;
  std::vector<double> factors;
  for (std::size_t i = 1; i < record.x.size(); ++i)
    factors.push_back(record.x[i] / record.x[i - 1]);
  const auto [least, most] = std::minmax_element(factors.begin(), factors.end());
  return *least > 1.05 && (*most - 1.0) < 2.0 * (*least - 1.0);
}

// The row of the largest |y|: the first that reaches it within the scatter.
std::size_t row_of_peak(const Record& record, double noise) {
  std::size_t far = 0;
  for (std::size_t i = 0; i < record.y.size(); ++i)
    if (std::abs(record.y[i]) > std::abs(record.y[far])) far = i;
  const double sign = record.y[far] < 0.0 ? -1.0 : 1.0;
  const double enough = sign * record.y[far] - 3.0 * noise;
  for (std::size_t i = 0; i < far; ++i)
    if (sign * record.y[i] >= enough) return i;
  return far;
}

// The last row of the first level, from whose mean y goes on to differ in at least three rows. Only
// a level of at least three rows is one.
std::size_t row_of_departure(const Record& record, double noise) {
  const auto [least, most] = std::minmax_element(record.y.begin(), record.y.end());
  const double clear = std::max(5.0 * noise, 0.02 * (*most - *least));
  const std::size_t size = record.y.size();
  double sum = record.y[0];
  std::size_t i = 1;
  for (; i < size; ++i) {
    const double level = sum / static_cast<double>(i);
    const auto differs = [&](std::size_t k) {
      return k >= size || std::abs(record.y[k] - level) > clear;
    };
    if (differs(i) && differs(i + 1) && differs(i + 2)) break;
    sum += record.y[i];
  }
  // y rises after the step by as much in a few rows if the record begins with it.
  return i < 4 || i == size ? 0 : i - 1;
}

// Whether a slow start, and no level, lies before the departure.
bool rises_from_the_first_row(const Record& record, std::size_t departure) {
  const double later = record.y[std::min(2 * departure, record.y.size() - 1)] - record.y[departure];
  const double before = record.y[departure] - record.y[0];
  return std::abs(before) > 0.3 * std::abs(later);
}

}  // namespace

StepOrigin step_origin(std::span<const double> given_x, std::span<const double> given_y,
                       AfterStep shape, double ramp) {
  const Record record = record_of(given_x, given_y);
  if (record.x.size() < 3) return {};
  const double noise = noise_of(record.y);
  std::size_t row = 0;
  if (shape == AfterStep::falls) {
    row = row_of_peak(record, noise);
  } else {
    row = row_of_departure(record, noise);
    if (row > 0 && rises_from_the_first_row(record, row)) row = 0;
    // A jump lies after the last row of the level, which is none of the response.
    if (shape == AfterStep::rises && row > 0 &&
        std::abs(record.y[row + 1] - record.y[row]) > 10.0 * noise)
      ++row;
  }
  const double at = record.x[row] - ramp;
  const double first =
      row > 0 && ramp == 0.0 ? record.x[row] : -std::numeric_limits<double>::infinity();
  const double gap = record.gap_after(row);
  const double before = row > 0 ? std::max(gap, record.x[row] - record.x[row - 1]) : gap;
  const double slack = 1e-9 * std::abs(record.x.back());
  // The clock's zero agrees with the curve.
  if (at >= -gap - slack && at <= before + slack) return {0.0, {}, first};
  if (ramp > 0.0 && row == 0 && record.x[0] >= -slack && record.x[0] <= gap + slack) return {};
  if (row == 0 && spaced_by_a_factor(record))
    return {0.0,
            "the times are spaced by a factor, as those since a step, so that the step is taken at "
            "0; `--origin` moves it"};
  if (shape == AfterStep::rises_from_zero && row == 0) {
    double largest = 0.0;
    for (const double each : record.y) largest = std::max(largest, std::abs(each));
    if (std::abs(record.y[0]) > 0.1 * largest + 5.0 * noise)
      throw InputError({}, "the first row, at " + rounded_text(record.x[0]) +
                               ", is not near zero, so that the creep began before the record; "
                               "give the moment of the load by `--origin`, as `--origin " +
                               rounded_text(record.x[0] - gap) + "`");
  }
  const std::string where = rounded_text(at);
  if (ramp > 0.0)
    return {at,
            "the ramp is taken to begin at " + where +
                ", its duration before the largest "
                "value; `--origin` moves it",
            first};
  if (row == 0)
    return {at,
            "the record begins at " + where +
                ", and its first row is taken as the step; `--origin` moves it",
            first};
  return {at,
          std::string("the step is taken at ") + where +
              (shape == AfterStep::falls ? ", where the curve is largest"
                                         : ", where the curve leaves its first level") +
              "; `--origin` moves it",
          first};
}

}  // namespace palpate::fit
