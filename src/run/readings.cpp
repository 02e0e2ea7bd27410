// Interpolates between the first row that reaches a value and the row before it.
#include "run/readings.h"

#include <algorithm>

namespace palpate::run {
namespace {

struct Point {
  double x = 0.0;
  double y = 0.0;
};

// The x at which the straight line from a to b has the given y, with a.y < y <= b.y.
double crossing(const Point& a, const Point& b, double y) {
  if (y == b.y) return b.x;
  return a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
}

}  // namespace

std::optional<double> force_at_indentation(const scenario::PlainScenario& scenario,
                                           const record::CaseRecord& record, double depth) {
  const auto first =
      std::find_if(scenario.steps.begin(), scenario.steps.end(),
                   [](const auto& step) { return std::holds_alternative<scenario::Indent>(step); });
  const int number = static_cast<int>(first - scenario.steps.begin()) + 1;
  std::optional<Point> before;
  for (const record::ContactRow& row : record.contact) {
    if (row.step > number) break;
    const Point here{row.force, row.indentation};
    if (row.step == number && before && here.y >= depth) return crossing(*before, here, depth);
    if (here.y < depth) before = here;
  }
  return std::nullopt;
}

std::optional<double> creep_half_time(const record::CaseRecord& record, double elastic_strain) {
  const auto first = std::find_if(record.strain.begin(), record.strain.end(),
                                  [](const auto& row) { return row.stress > 0.0; });
  std::optional<Point> before;
  for (auto row = first; row != record.strain.end(); ++row) {
    if (row->step != first->step || row->stress <= 0.0) break;
    const Point here{row->time - first->time, row->strain};
    if (here.y >= 0.5 * elastic_strain)
      return before ? crossing(*before, here, 0.5 * elastic_strain) : 0.0;
    before = here;
  }
  return std::nullopt;
}

}  // namespace palpate::run
