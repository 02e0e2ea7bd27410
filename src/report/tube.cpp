// The least and the greatest of a polyline in a window.
#include "report/tube.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace palpate::report {
namespace {

using record::Cell;
using record::Table;

constexpr double infinity = std::numeric_limits<double>::infinity();

// The rows of each case by x. Rows whose x is no finite number are left out.
struct Course {
  std::vector<double> x;
  std::vector<std::size_t> rows;
};
using Courses = std::map<std::string, Course>;

Courses courses_of(const Table& table, const std::string& x, bool by_case) {
  Courses courses;
  const auto column = static_cast<std::size_t>(table.find(x));
  const auto name = static_cast<std::size_t>(table.find("case"));
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

bool same(const Cell& got, const Cell& want) {
  const auto* g = std::get_if<double>(&got);
  const auto* w = std::get_if<double>(&want);
  return got == want || (g != nullptr && w != nullptr && std::isnan(*g) && std::isnan(*w));
}

const double* finite(const Cell& cell) {
  const auto* number = std::get_if<double>(&cell);
  return number != nullptr && std::isfinite(*number) ? number : nullptr;
}

// What WANT has in a window.
struct Window {
  double low = infinity, high = -infinity;
  bool met = false;  // the very same cell stands there

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

class Want {
 public:
  Want(const Table& table, const std::string& name, const Course& course)
      : table_(table), column_(static_cast<std::size_t>(table.find(name))), course_(course) {}

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
    // Between two rows a word is what either of them says.
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
    return table_.rows[course_.rows[static_cast<std::size_t>(i)]][column_];
  }
  // On the line that ends with row `i`, at `x`.
  void edge(std::ptrdiff_t i, double x, Window& window) const {
    if (i < 1 || i >= static_cast<std::ptrdiff_t>(course_.x.size())) return;
    const double* before = finite(at(i - 1));
    const double* after = finite(at(i));
    if (before == nullptr || after == nullptr) return;
    const double from = course_.x[static_cast<std::size_t>(i - 1)];
    const double to = course_.x[static_cast<std::size_t>(i)];
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
  double excess = 0.0;  // beyond the tolerance where above 1
  WorstRow row;
};

Judged judge(const Cell& got, const Window& window, const Tolerance& tolerance) {
  Judged judged;
  judged.row.got = got;
  if (window.met) return judged;
  judged.excess = judged.row.relative = infinity;
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
  if (distance <= judged.row.allowed)
    judged.excess = distance / judged.row.allowed;
  else if (judged.row.allowed > 0.0)
    judged.excess = std::max(distance / judged.row.allowed, std::nextafter(1.0, 2.0));
  return judged;
}

}  // namespace

ColumnComparison compare_in_tube(const Table& got, const Table& want, const std::string& name,
                                 const Tolerances& tolerances) {
  ColumnComparison column{.name = name};
  const Tube& tube = *tolerances.tube;
  const bool cases = by_case(got, want);
  const Courses theirs = courses_of(want, tube.x, cases);
  const auto value = static_cast<std::size_t>(got.find(name));
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
      const double there = none    ? infinity
                           : first ? found->second.x.front()
                                   : found->second.x.back();
      const double distance = std::abs(there - wanted);
      if (distance <= tube.width) continue;
      ++column.differing;
      WorstRow worst;
      if (!none) {
        worst.row = (first ? found->second.rows.front() : found->second.rows.back()) + 1;
        worst.got = there;
      }
      worst.want = wanted;
      worst.relative = wanted != 0.0 ? distance / std::abs(wanted) : infinity;
      worst.allowed = tube.width;
      column.worst = std::move(worst);
    }
  }
  return column;
}

}  // namespace palpate::report
