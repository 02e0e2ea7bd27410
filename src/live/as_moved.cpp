// A line through the readings of every motion; what lies between two of them is a hold.
#include "live/as_moved.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace palpate::live {
namespace {

constexpr double shortest_hold = 1e-3;  // s: the first hold exists however early the stand sets off
constexpr double edge = 0.15;           // of a way, at both ends, where the stand changes its speed
constexpr int fewest = 5;               // readings

struct Way {
  double rate = 0.0;              // m/s, along travel, below 0 upwards
  double begin = 0.0, end = 0.0;  // s
  double to = 0.0;                // m
};

double travel_of(const record::MeasuredRow& row) { return -row.place[2]; }

// The motion from `from` (m) in the rows of a step.
std::optional<Way> way_of(const record::CaseRecord& record, int step, double from) {
  double to = from;
  for (std::size_t i = 0; i < record.contact.size(); ++i)
    if (record.contact[i].step == step) to = travel_of(record.measured[i]);
  const double low = std::min(from, to) + edge * std::abs(to - from);
  const double high = std::max(from, to) - edge * std::abs(to - from);
  double n = 0.0;
  double t = 0.0;
  double z = 0.0;
  double first = 0.0;
  double tt = 0.0;
  double tz = 0.0;
  for (std::size_t i = 0; i < record.contact.size(); ++i) {
    const double travel = travel_of(record.measured[i]);
    if (record.contact[i].step != step || travel < low || travel > high) continue;
    if (n == 0.0) first = record.contact[i].time;
    const double passed = record.contact[i].time - first;
    n += 1.0;
    t += passed;
    z += travel - from;
    tt += passed * passed;
    tz += passed * (travel - from);
  }
  const double spread = n * tt - t * t;
  const double rate = (n * tz - t * z) / spread;
  if (n < fewest || !(spread > 0.0) || !(std::abs(rate) > 0.0)) return std::nullopt;
  Way way;
  way.rate = rate;
  way.begin = first + (t - z / rate) / n;
  way.end = way.begin + (to - from) / rate;
  way.to = to;
  return way;
}

}  // namespace

std::optional<std::vector<scenario::Step>> as_moved(const record::CaseRecord& record,
                                                    const std::vector<scenario::Step>& planned) {
  if (record.outcome != record::Outcome::completed || record.measured.empty()) return std::nullopt;
  std::vector<scenario::Step> steps;
  double time = 0.0;
  double travel = 0.0;
  for (std::size_t i = 0; i < planned.size(); ++i) {
    if (std::holds_alternative<scenario::Hold>(planned[i])) continue;
    const auto way = way_of(record, static_cast<int>(i) + 1, travel);
    if (!way) return std::nullopt;
    const double rest = way->begin - time;
    if (steps.empty() || rest > shortest_hold)
      steps.emplace_back(scenario::Hold{std::max(rest, shortest_hold)});
    if (way->to <= travel) return steps;
    steps.emplace_back(scenario::Indent{{way->to, false}, way->rate});
    time = way->end;
    travel = way->to;
  }
  const double rest = record.contact.back().time - time;
  if (!steps.empty() && rest > shortest_hold) steps.emplace_back(scenario::Hold{rest});
  return steps.empty() ? std::nullopt : std::optional(steps);
}

}  // namespace palpate::live
