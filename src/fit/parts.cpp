// Turning points by hysteresis, and the running maximum of the stress.
#include "fit/parts.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/error.h"
#include "base/index.h"
#include "base/numerics.h"
#include "base/text.h"

namespace palpate::fit {

std::vector<Branch> branches_of(std::span<const double> x, double share) {
  std::vector<Branch> branches;
  if (x.empty()) return branches;
  const auto [least, most] = std::ranges::minmax_element(x);
  const double back = share * (*most - *least);
  std::size_t start = 0;
  std::size_t low = 0;  // first lowest and highest row since the last turn
  std::size_t high = 0;
  int way = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < x[low]) low = i;
    if (x[i] > x[high]) high = i;
    if (way >= 0 && x[high] - x[i] > back) {
      if (high > start || way > 0) branches.push_back({start, high + 1, true});
      start = high;
      low = i;
      high = i;
      way = -1;
    } else if (way <= 0 && x[i] - x[low] > back) {
      if (low > start && way < 0) branches.push_back({start, low + 1, false});
      if (way < 0) start = low;
      low = i;
      high = i;
      way = 1;
    }
  }
  branches.push_back({start, x.size(), way >= 0});
  return branches;
}

OneWay one_way(std::span<const double> depth, Way way) {
  const auto [low, high] = std::ranges::minmax_element(depth);
  OneWay part{0, depth.size()};
  const std::vector<Branch> branches = branches_of(depth);
  for (std::size_t k = 0; k < branches.size(); ++k) {
    if (!branches[k].up || depth[branches[k].to - 1] < *high - 0.1 * (*high - *low)) continue;
    if (++part.loadings > 1 || way == Way::all) continue;
    if (way == Way::approach)
      part.to = branches[k].to;
    else if (k + 1 < branches.size())
      part = {branches[k].to - 1, branches[k + 1].to, part.loadings};
  }
  return part;
}

Limit limit_of(std::span<const double> y) {
  const auto from = std::ranges::max_element(y);
  auto to = from;
  while (to != y.end() && *to == *from) ++to;
  // The longest of the next two runs of equal values.
  const auto longest = [](auto at, auto end) {
    std::ptrdiff_t most = 0;
    for (int k = 0; k < 2 && at != end; ++k) {
      const auto next = std::find_if(at, end, [&](double each) { return each != *at; });
      most = std::max<std::ptrdiff_t>(most, next - at);
      at = next;
    }
    return most;
  };
  const std::ptrdiff_t beside =
      std::max(longest(std::make_reverse_iterator(from), y.rend()), longest(to, y.end()));
  if (to - from < 5 || to - from <= 3 * beside || beside == 0) return {y.size(), y.size()};
  return {static_cast<std::size_t>(from - y.begin()), static_cast<std::size_t>(to - y.begin())};
}

std::size_t rows_before_break(std::span<const double> force) {
  if (force.size() < 4) return force.size();
  const auto [least, peak] = std::ranges::minmax_element(force);
  if (*peak - force[0] < 0.5 * (*peak - *least)) return force.size();  // negative in compression
  const auto beyond = static_cast<std::size_t>(force.end() - peak) - 1;
  if (beyond < 3) return force.size();
  double mean = 0.0;
  for (auto each = peak + 1; each != force.end(); ++each)
    mean += *each / static_cast<double>(beyond);
  const double clear = 0.1 * (*peak - force[0]) + 4.0 * noise_of(force);
  return *peak - mean > clear ? force.size() - beyond : force.size();
}

std::size_t rows_before_fall(std::span<const double> stress, double share) {
  if (stress.empty()) return 0;
  // The largest of n values of noise lies 2 sqrt(2 ln n) deviations above the least.
  const double spread = 2.0 * std::sqrt(2.0 * std::log(static_cast<double>(stress.size())));
  const double clear = std::max(6.0, spread) * noise_of(stress);
  // What falls below a tenth of the whole rise is slack that gives way, or noise.
  const double rise = *std::ranges::max_element(stress) - stress[0];
  std::size_t peak = 0;
  for (std::size_t i = 0; i < stress.size(); ++i) {
    if (stress[i] > stress[peak]) peak = i;
    const double fall = stress[peak] - stress[i];
    const double risen = stress[peak] - stress[0];
    if (risen > 0.1 * rise && fall > std::max(share * risen, clear)) return peak + 1;
  }
  return stress.size();
}

// The largest value or the first departure from the first level, against the scatter of the rows.

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> block_means(std::span<const double> values, std::size_t blocks) {
  std::vector<double> means;
  for (std::size_t k = 0; k < blocks; ++k) {
    const std::size_t from = values.size() * k / blocks;
    const std::size_t to = values.size() * (k + 1) / blocks;
    double sum = 0.0;
    for (std::size_t i = from; i < to; ++i) sum += values[i];
    means.push_back(sum / static_cast<double>(to - from));
  }
  return means;
}

double noise_of(std::span<const double> y) {
  std::vector<double> bends;
  for (std::size_t i = 2; i < y.size(); ++i)
    bends.push_back(std::abs(y[i] - 2.0 * y[i - 1] + y[i - 2]));
  if (bends.size() < 3) return 0.0;
  // The median of |N(0, 1)| is 0.6745; a second difference has sqrt(6) times the deviation.
  return median(std::move(bends)) / (0.6745 * std::sqrt(6.0));
}

namespace {

struct Record {
  std::vector<double> x, y;  // finite, by ascending x

  [[nodiscard]] double gap_after(std::size_t i) const {
    const std::size_t k = std::min(i, x.size() - 2);
    return x[k + 1] - x[k];
  }
  // A time with four digits of the record's length, which a clock that counts from elsewhere hides.
  [[nodiscard]] std::string text(double time) const {
    const double far = std::max(std::abs(x.front()), std::abs(x.back()));
    const double more = std::log10(far / std::max({x.back() - x.front(), 1e-12 * far, 1e-300}));
    return rounded_text(time, 4 + static_cast<int>(std::clamp(more, 0.0, 10.0)));
  }
};

Record record_of(std::span<const double> x, std::span<const double> y) {
  std::vector<std::pair<double, double>> rows;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) rows.emplace_back(x[i], y[i]);
  std::ranges::stable_sort(
      rows, [](const auto& one, const auto& other) { return one.first < other.first; });
  Record record;
  for (const auto& [time, value] : rows) {
    record.x.push_back(time);
    record.y.push_back(value);
  }
  return record;
}

// Rheometers space their rows by a constant factor of the time since the step, up to the digits of
// the file. Over a factor of four, even spacing gives factors - 1 that differ by more than two.
bool spaced_by_a_factor(const Record& record) {
  const std::size_t count = record.x.size() - 1;
  if (count < 5 || !(record.x.front() > 0.0) || record.x.back() < 4.0 * record.x.front())
    return false;
  std::vector<double> more;
  for (std::size_t i = 0; i < count; ++i) more.push_back(record.x[i + 1] / record.x[i] - 1.0);
  std::ranges::sort(more);
  return more[count - 1 - count / 10] < 2.0 * more[count / 10];
}

// The rows of the largest |y|: the first and the last that reach it within the scatter.
struct Peak {
  std::size_t first = 0, last = 0;
};
Peak peak_of(const Record& record, double noise) {
  double far = 0.0;
  for (const double each : record.y)
    if (std::abs(each) > std::abs(far)) far = each;
  const auto reaches = [&](double y) {
    return std::copysign(1.0, far) * y >= std::abs(far) - 3.0 * noise;
  };
  const auto first = std::ranges::find_if(record.y, reaches);
  const auto last = std::find_if(record.y.rbegin(), record.y.rend(), reaches);
  return {as_index(first - record.y.begin()), as_index(record.y.rend() - last) - 1};
}

// The last row of the first level, from whose mean y goes on to differ in at least three rows. Only
// a level of at least four rows is one.
std::size_t row_of_departure(const Record& record, double noise) {
  const auto [least, most] = std::ranges::minmax_element(record.y);
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

// Whether a slow start, and no level, lies before the departure: the third quarter of its rows is
// above the first.
bool rises_from_the_first_row(const Record& record, std::size_t departure, double noise) {
  const std::size_t quarter = std::max<std::size_t>(departure / 4, 1);
  double before = 0.0;
  for (std::size_t i = 0; i < quarter; ++i)
    before += (record.y[departure / 2 + i] - record.y[i]) / static_cast<double>(quarter);
  const double later = record.y[std::min(2 * departure, record.y.size() - 1)] - record.y[departure];
  const double clear = 3.0 * noise * std::sqrt(2.0 / static_cast<double>(quarter));
  return std::abs(before) > std::max(0.15 * std::abs(later), clear);
}

// The row from `from` to `to` that divides these rows, with `reach` more on either side, into two
// straight lines of the least squares.
std::size_t corner(const Record& record, std::size_t from, std::size_t to, std::size_t reach) {
  const auto squares = [&](std::size_t begin, std::size_t end) {  // about their line
    const auto n = static_cast<double>(end - begin);
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      x += record.x[i] / n;
      y += record.y[i] / n;
    }
    for (std::size_t i = begin; i < end; ++i) {
      xx += (record.x[i] - x) * (record.x[i] - x);
      xy += (record.x[i] - x) * (record.y[i] - y);
      yy += (record.y[i] - y) * (record.y[i] - y);
    }
    return xx > 0.0 ? yy - xy * xy / xx : yy;
  };
  const std::size_t low = from - std::min(from, reach);
  const std::size_t high = std::min(to + reach + 1, record.x.size());
  std::size_t best = from;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = from; i <= to; ++i) {
    const double sum = squares(low, i + 1) + squares(i, high);
    if (!(sum < least)) continue;
    least = sum;
    best = i;
  }
  return best;
}

// The ramp before a hold, where at least one row lies between the first level and the peak. Without
// a level the ramp began where the straight line through its ends is zero.
std::optional<StepOrigin> ramp_before(const Record& record, const Peak& peak, double noise) {
  const double top = record.y[peak.first];
  const std::size_t level = row_of_departure(record, noise);
  const double low = std::abs(record.y[level]);
  const bool held = peak.first + 3 < record.x.size();
  if (level + 2 > peak.first || !held || low > 0.8 * std::abs(top)) return std::nullopt;
  std::vector<double> rise;
  for (std::size_t i = 0; i <= peak.first; ++i)
    rise.push_back(std::copysign(1.0, top) * record.y[i]);
  if (const std::size_t whole = rows_before_fall(rise, 0.1); whole < rise.size())
    throw InputError({}, "the load falls by over 10 % from " + record.text(record.x[whole - 1]) +
                             " on, and is largest at " + record.text(record.x[peak.first]) +
                             ", so that it has several steps or cycles; choose the rows of one by "
                             "`--rows`, or give the measured loading by `--history`");
  const std::size_t reach = std::max<std::size_t>((peak.first - level) / 3, 3);
  const std::size_t end =
      corner(record, peak.first, std::min(peak.first + reach, record.x.size() - 3), reach);
  const double to = record.x[end];
  double from = record.x[level];
  if (level == 0 && low > 5.0 * noise + 0.02 * std::abs(top))
    from -= record.y[0] / (record.y[end] - record.y[0]) * (to - from);
  const double by = record.gap_after(level);
  const bool clock = std::abs(from) <= by;
  if (clock) from = 0.0;
  StepOrigin found;
  found.best = {from, to - from, to};
  // Its end may lie in the interval on either side of the row, its start in that after the level.
  const double early = std::max(record.x[end - 1], from);
  const double late = record.x[end + 1];
  found.others = {{from, early - from, to},
                  {clock ? from : from + by, late - from - (clock ? 0.0 : by), late}};
  found.sentence = "the load rises from " + record.text(from) + " to " + record.text(to) +
                   ", which is taken as a ramp at a constant rate, and the rows from its end on "
                   "are fitted; `--ramp 0` takes a step, and `--history` a measured loading";
  return found;
}

}  // namespace

StepOrigin step_origin(std::span<const double> given_x, std::span<const double> given_y,
                       AfterStep shape, std::optional<double> given_ramp) {
  const Record record = record_of(given_x, given_y);
  if (record.x.size() < 3) return {};
  const double noise = noise_of(record.y);
  const double ramp = given_ramp.value_or(0.0);
  const bool falls = shape == AfterStep::relaxes || shape == AfterStep::recovers;
  std::size_t row = 0;
  if (falls) {
    const Peak peak = peak_of(record, noise);
    row = peak.first;
    if (shape == AfterStep::relaxes && !given_ramp)
      if (auto found = ramp_before(record, peak, noise)) return *std::move(found);
    // Creep that has come to its end before the recovery is as large for long.
    if (shape == AfterStep::recovers && peak.last > peak.first + 3) {
      std::size_t half = peak.last;
      while (half + 1 < record.y.size() &&
             std::abs(record.y[half]) > 0.5 * std::abs(record.y[peak.last]))
        ++half;
      const std::size_t reach = std::max<std::size_t>((half - peak.last) / 2, 3);
      row = corner(record, peak.last - std::min(reach, peak.last - peak.first), peak.last, reach);
    }
  } else {
    // What follows a step at the clock's zero rises from the first row on, out of the noise later.
    if (!spaced_by_a_factor(record)) row = row_of_departure(record, noise);
    if (row > 0 && rises_from_the_first_row(record, row, noise)) row = 0;
    // A jump lies after the last row of the level, which is none of the response.
    if (shape == AfterStep::rises && row > 0 &&
        std::abs(record.y[row + 1] - record.y[row]) > 10.0 * noise)
      ++row;
  }
  StepOrigin found;
  found.after_level = !falls && row > 0;
  found.best.ramp = ramp;
  const double at = record.x[row] - (falls ? ramp : 0.0);
  if (row > 0 && ramp == 0.0) found.best.first = record.x[row];
  const double gap = record.gap_after(row);
  const double before = row > 0 ? std::max(gap, record.x[row] - record.x[row - 1]) : gap;
  const double slack = 1e-9 * std::abs(record.x.back());
  // The clock's zero agrees with the curve.
  if (at >= -gap - slack && at <= before + slack) return found;
  if (ramp > 0.0 && row == 0 && record.x[0] >= -slack && record.x[0] <= gap + slack) return found;
  if (row == 0 && spaced_by_a_factor(record)) {
    found.sentence =
        "the times are spaced by a factor, as those since a step, so that the step is taken at 0; "
        "`--origin` moves it";
    return found;
  }
  if (shape == AfterStep::rises_from_zero && row == 0) {
    double largest = 0.0;
    for (const double each : record.y) largest = std::max(largest, std::abs(each));
    if (std::abs(record.y[0]) > 0.1 * largest + 5.0 * noise)
      throw InputError({}, "the first row, at " + rounded_text(record.x[0]) +
                               ", is not near zero, so that the creep began before the record; "
                               "give the moment of the load by `--origin`, as `--origin " +
                               rounded_text(record.x[0] - gap) + "`");
  }
  found.best.time = at;
  const std::string where = record.text(at);
  if (ramp > 0.0) {
    found.sentence = "the ramp is taken to begin at " + where +
                     (falls ? ", its duration before the largest value"
                            : ", where the curve leaves its first level") +
                     "; `--origin` moves it";
    return found;
  }
  // The step lies between two rows; a recovery may begin after the largest.
  const double first = found.best.first;
  found.others.push_back({row > 0 ? record.x[row - 1] : at - gap, 0.0, first});
  if (shape == AfterStep::recovers && row > 0) found.others.push_back({at + gap, 0.0, at + gap});
  found.sentence =
      row == 0 ? "the record begins at " + where + ", and its first row is taken as"
      : falls  ? "the step is taken at " + where + ", where the curve is largest"
               : "the step is taken at " + where + ", where the curve leaves its first level";
  found.sentence += row == 0 ? " the step; `--origin` moves it" : "; `--origin` moves it";
  return found;
}

std::size_t rows_before_recovery(std::span<const double> x, std::span<const double> y) {
  if (y.empty()) return 0;
  const double noise = noise_of(y);
  const double rise = *std::ranges::max_element(y) - y[0];
  std::size_t peak = 0;
  std::size_t from = 0;  // of the recovery
  double clear = 0.0;
  for (; from < y.size(); ++from) {
    if (y[from] > y[peak]) peak = from;
    const double risen = y[peak] - y[0];
    clear = std::max(0.25 * risen, 6.0 * noise);
    const auto below = [&](std::size_t i) { return i >= y.size() || y[peak] - y[i] > clear; };
    if (risen > 0.1 * rise && below(from) && below(from + 1) && below(from + 2)) break;
  }
  if (from == y.size()) return from;
  std::size_t to = from;  // where the next creep begins, if there is one
  for (double least = y[from]; to < y.size() && y[to] - least <= clear; ++to)
    least = std::min(least, y[to]);
  const double corner = step_origin(x.first(to), y.first(to), AfterStep::recovers, 0.0).best.first;
  return as_index(std::ranges::count_if(x, [&](double each) { return each <= corner; }));
}

std::optional<Misfit> misfit_of(const std::function<Fit()>& fit) {
  try {
    const Fit found = fit();
    if (found.termination != Termination::converged) return std::nullopt;
    return Misfit{found.rmse * found.rmse * found.n,
                  found.rho > 0.0 ? found.n / found.effective_size : 1.0,
                  static_cast<int>(found.parameters.size())};
  } catch (const InputError&) {  // too few rows
    return std::nullopt;
  }
}

StepOrigin refined(const StepOrigin& coarse, std::span<const double> given_x,
                   std::span<const double> given_y,
                   const std::function<std::optional<Misfit>(const Loading&)>& fit_after) {
  const Record record = record_of(given_x, given_y);
  const auto begin = record.x.begin();
  const std::size_t row =
      as_index(std::lower_bound(begin, record.x.end(), coarse.best.first) - begin);
  struct At {
    double squares = std::numeric_limits<double>::infinity();
    Misfit fit;
  };
  const auto at = [&](double time) -> At {
    const std::size_t rows = as_index(std::lower_bound(begin, record.x.end(), time) - begin);
    const auto fit = fit_after({time, 0.0, time});
    if (!fit) return {};
    double mean = 0.0, squares = fit->squares;
    for (std::size_t i = 0; i < rows; ++i) mean += record.y[i] / static_cast<double>(rows);
    for (std::size_t i = 0; i < rows; ++i) squares += (record.y[i] - mean) * (record.y[i] - mean);
    return {squares, *fit};
  };
  // The rise is found late, by less than it takes to get half as high.
  std::size_t half = row;
  const auto height = [&](std::size_t i) { return std::abs(record.y[i] - record.y[0]); };
  while (half + 1 < record.x.size() && height(half) < 0.5 * height(record.x.size() - 1)) ++half;
  const double low = std::max(
      record.x[1], record.x[row] - (record.x[half] - record.x[row]) - 3.0 * record.gap_after(row));
  const double high = record.x[std::min(row + 2, half)];
  constexpr int steps = 12;
  const double step = (high - low) / steps;
  StepOrigin found = coarse;
  At best = at(coarse.best.first);
  double time = coarse.best.first;
  const auto keep = [&](double moment) {
    const At here = at(moment);
    if (here.squares < (1.0 - 1e-9) * best.squares) {
      best = here;
      time = moment;
    }
    return here.squares;
  };
  for (int i = 0; i <= steps; ++i) keep(low + i * step);
  if (!std::isfinite(best.squares)) return coarse;
  (void)numerics::minimum({std::max(low, time - step), std::min(high, time + step)}, keep);
  const double degrees = static_cast<double>(record.x.size()) - best.fit.parameters - 2.0;
  const double t = numerics::student_t_quantile(0.975, std::max(degrees, 1.0));
  const double most = best.squares * (1.0 + t * t * best.fit.rows_each / std::max(degrees, 1.0));
  const auto end = [&](double out) {
    double in = time;
    if (at(out).squares <= most) return out;
    for (int i = 0; i < 10; ++i) {
      const double middle = 0.5 * (in + out);
      (at(middle).squares <= most ? in : out) = middle;
    }
    return in;
  };
  double earliest = end(low);
  const double latest = end(high);
  if (earliest == record.x[1])
    earliest = record.x[0] - record.gap_after(0);  // or before the record
  found.others.clear();
  if (earliest <= 0.0 && latest >= 0.0) {  // the clock's zero agrees with the curve
    found.best = {0.0, 0.0, 0.0};
    found.sentence.clear();
    return found;
  }
  found.best = {time, 0.0, time};
  for (const double each : {earliest, latest}) found.others.push_back({each, 0.0, each});
  found.sentence = "the step is taken at " + record.text(time) +
                   " (95 %: " + record.text(earliest) + " to " + record.text(latest) +
                   "), from which on the curve leaves its first level; `--origin` moves it";
  return found;
}

}  // namespace palpate::fit
