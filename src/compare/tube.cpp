// Minimum and maximum of a polyline in a window, and the comparison with them.
#include "compare/tube.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/index.h"

namespace palpate::compare {
namespace {

using record::Cell;
using record::Table;

constexpr double unbounded = std::numeric_limits<double>::infinity();

// The rows of one case with their x. Rows without a finite x are left out.
struct Course {
  std::vector<double> x;
  std::vector<std::size_t> rows;
};
using Courses = std::map<std::string, Course>;

Courses courses_of(const Table& table, const std::string& x, bool by_case) {
  Courses courses;
  const auto column = as_index(table.find(x));
  const auto name = as_index(table.find("case"));
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto* number = std::get_if<double>(&table.rows[i][column]);
    if (number == nullptr || !std::isfinite(*number)) continue;
    std::string key;
    if (by_case)
      if (const auto* word = std::get_if<std::string>(&table.rows[i][name])) key = *word;
    courses[key].x.push_back(*number);
    courses[key].rows.push_back(i);
  }
  return courses;
}

const double* finite(const Cell& cell) {
  const auto* number = std::get_if<double>(&cell);
  return number != nullptr && std::isfinite(*number) ? number : nullptr;
}

// The values of WANT in a window of x.
struct Window {
  double low = unbounded, high = -unbounded;
  bool met = false;  // one of them is identical to the value of GOT

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

class Want {
 public:
  Want(const Table& table, const std::string& name, const Course& course)
      : table_(table), column_(as_index(table.find(name))), course_(course) {}

  [[nodiscard]] Window around(double x, double width, const Cell& got) const {
    Window window;
    const auto& xs = course_.x;
    const auto first = std::lower_bound(xs.begin(), xs.end(), x - width) - xs.begin();
    const auto last = std::upper_bound(xs.begin(), xs.end(), x + width) - xs.begin();
    for (auto i = first; i < last; ++i) {
      const Cell& cell = at(i);
      window.met = window.met || same(got, cell);
      if (const double* value = finite(cell)) window.take(*value);
    }
    // Between two rows a word may be that of either row.
    if (first == last && finite(got) == nullptr)
      for (const auto i : {first - 1, first})
        if (i >= 0 && i < static_cast<std::ptrdiff_t>(xs.size()))
          window.met = window.met || same(got, at(i));
    edge(first, x - width, window);
    edge(last, x + width, window);
    return window;
  }

 private:
  [[nodiscard]] const Cell& at(std::ptrdiff_t i) const {
    return table_.rows[course_.rows[as_index(i)]][column_];
  }
  // Adds the value at `x` on the line from row i - 1 to row i.
  void edge(std::ptrdiff_t i, double x, Window& window) const {
    if (i < 1 || i >= static_cast<std::ptrdiff_t>(course_.x.size())) return;
    const double* before = finite(at(i - 1));
    const double* after = finite(at(i));
    if (before == nullptr || after == nullptr) return;
    const double from = course_.x[as_index(i - 1)];
    const double to = course_.x[as_index(i)];
    const double share = to > from ? (x - from) / (to - from) : 1.0;
    window.take(*before + share * (*after - *before));
  }

  const Table& table_;
  std::size_t column_;
  const Course& course_;
};

bool by_case(const Table& got, const Table& want) {
  return got.find("case") >= 0 && want.find("case") >= 0;
}

struct Judged {
  double excess = 0.0;  // above 1 is beyond the tolerance
  WorstRow row;
};

Judged judge(const Cell& got, const Window& window, const Tolerance& tolerance) {
  Judged judged;
  judged.row.got = got;
  if (window.met) return judged;
  judged.excess = judged.row.relative = unbounded;
  const double* value = finite(got);
  if (value == nullptr || window.low > window.high) return judged;
  const double nearest = std::clamp(*value, window.low, window.high);
  const double distance = std::abs(*value - nearest);
  judged.row.want = nearest;
  judged.row.allowed = tolerance.abs + tolerance.rel * std::abs(nearest);
  if (distance == 0.0) {
    judged.excess = judged.row.relative = 0.0;
    return judged;
  }
  if (nearest != 0.0) judged.row.relative = distance / std::abs(nearest);
  judged.excess = excess(distance, judged.row.allowed);
  return judged;
}

}  // namespace

bool same(const Cell& got, const Cell& want) {
  const auto* g = std::get_if<double>(&got);
  const auto* w = std::get_if<double>(&want);
  return got == want || (g != nullptr && w != nullptr && std::isnan(*g) && std::isnan(*w));
}

double excess(double size, double allowed) {
  if (size <= allowed) return size / allowed;  // at most 1
  return allowed > 0.0 ? std::max(size / allowed, std::nextafter(1.0, 2.0)) : unbounded;
}

ColumnComparison compare_in_tube(const Table& got, const Table& want, const std::string& name,
                                 const Tolerances& tolerances) {
  ColumnComparison column{.name = name};
  const Tube& tube = *tolerances.tube;
  const bool cases = by_case(got, want);
  const Courses theirs = courses_of(want, tube.x, cases);
  const auto value = as_index(got.find(name));
  const Course none;
  double most = 0.0;
  for (const auto& [key, ours] : courses_of(got, tube.x, cases)) {
    const auto found = theirs.find(key);
    const Want wanted(want, name, found == theirs.end() ? none : found->second);
    for (std::size_t i = 0; i < ours.x.size(); ++i) {
      const Cell& cell = got.rows[ours.rows[i]][value];
      Judged judged = judge(cell, wanted.around(ours.x[i], tube.width, cell), tolerances.of(name));
      if (judged.excess > 1.0) ++column.differing;
      if (judged.excess <= most) continue;
      most = judged.excess;
      judged.row.row = ours.rows[i] + 1;
      column.worst = judged.row;
    }
  }
  return column;
}

ColumnComparison compare_ends(const Table& got, const Table& want, const Tube& tube) {
  ColumnComparison column{.name = tube.x};
  const bool cases = by_case(got, want);
  const Courses ours = courses_of(got, tube.x, cases);
  for (const auto& [key, theirs] : courses_of(want, tube.x, cases)) {
    const auto found = ours.find(key);
    const bool none = found == ours.end();
    for (const bool first : {true, false}) {
      const double wanted = first ? theirs.x.front() : theirs.x.back();
      const double there = none    ? unbounded
                           : first ? found->second.x.front()
                                   : found->second.x.back();
      const double distance = std::abs(there - wanted);
      if (distance <= tube.width) continue;
      ++column.differing;
      WorstRow& worst = column.worst.emplace();
      if (!none) {
        worst.row = (first ? found->second.rows.front() : found->second.rows.back()) + 1;
        worst.got = there;
      }
      worst.want = wanted;
      worst.relative = wanted != 0.0 ? distance / std::abs(wanted) : unbounded;
      worst.allowed = tube.width;
    }
  }
  return column;
}

}  // namespace palpate::compare
