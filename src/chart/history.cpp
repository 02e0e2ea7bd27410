// Deviations by linear interpolation, relative to the largest value of each kind of step.
#include "chart/history.h"

#include <algorithm>
#include <cmath>

namespace palpate::chart {
namespace {

using Plain = scenario::PlainScenario;

// Deviations are relative to the largest value in steps of the same kind: strains to strains.
std::size_t kind_of(const Plain& scenario, int step) {
  if (!scenario.uniform()) return 0;
  return scenario.steps[as_index(step) - 1].index();
}

// By step (from 1): the largest value in steps of its kind; 0 if there is none.
std::vector<double> scales(const Plain& scenario, const History& reference) {
  std::vector<double> by_kind(std::variant_size_v<scenario::Step>, 0.0);
  for (const Moment& moment : reference) {
    double& most = by_kind[kind_of(scenario, moment.step)];
    most = std::max(most, std::abs(moment.value));
  }
  std::vector<double> by_step{0.0};
  for (std::size_t i = 1; i <= scenario.steps.size(); ++i)
    by_step.push_back(by_kind[kind_of(scenario, static_cast<int>(i))]);
  return by_step;
}

// The moments of a step; in a press (`pressed`) the last moment of the previous step comes first.
History of_step(const History& all, int step, bool pressed) {
  History part;
  for (const Moment& moment : all) {
    if (moment.step == step) part.push_back(moment);
    if (pressed && moment.step < step) part.assign(1, moment);
  }
  return part;
}

constexpr double same_time = 1e-9;  // relative: rounding of a sum of intervals

std::optional<double> value_at(const History& part, double time) {
  const double slack = same_time * std::abs(time) + 1e-12;
  if (part.empty() || time < part.front().time - slack || time > part.back().time + slack)
    return std::nullopt;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (std::abs(part[i].time - time) <= slack) return part[i].value;
    if (part[i].time < time) continue;
    const Moment& before = part[i - 1];
    const double share = (time - before.time) / (part[i].time - before.time);
    return before.value + share * (part[i].value - before.value);
  }
  return part.back().value;
}

// Largest, last and mean square of `error(moment)` divided by the scale of its step.
template <class Error>
std::optional<Deviation> summed_up(const Plain& scenario, const History& reference,
                                   const Error& error) {
  const std::vector<double> scale = scales(scenario, reference);
  Deviation deviation;
  double squares = 0.0;
  for (const Moment& moment : reference) {
    const double over = scale[as_index(moment.step)];
    const std::optional<double> difference = error(moment);
    if (!difference || !std::isfinite(*difference) || over <= 0.0) return std::nullopt;
    deviation.at_end = std::abs(*difference) / over;
    deviation.greatest = std::max(deviation.greatest, deviation.at_end);
    squares += deviation.at_end * deviation.at_end;
  }
  if (reference.empty()) return std::nullopt;
  deviation.rms = std::sqrt(squares / static_cast<double>(reference.size()));
  return deviation;
}

}  // namespace

History history(const Plain& scenario, const record::CaseRecord& record) {
  History all;
  for (const record::ContactRow& row : record.contact)
    all.push_back({row.step, row.time, row.contact_force});
  for (const record::StrainRow& row : record.strain) {
    const auto& step = scenario.steps[as_index(row.step) - 1];
    const bool creeps = std::holds_alternative<scenario::Creep>(step);
    all.push_back({row.step, row.time, creeps ? row.strain : row.stress});
  }
  return all;
}

double start_of(const Plain& scenario, int step) {
  double start = 0.0;
  for (int i = 1; i < step; ++i) {
    const auto& one = scenario.steps[as_index(i) - 1];
    if (const auto* creep = std::get_if<scenario::Creep>(&one))
      start += creep->load_time + creep->recovery_time;
    else if (const auto* relax = std::get_if<scenario::Relax>(&one))
      start += relax->time;
    else if (const auto* compress = std::get_if<scenario::Compress>(&one))
      start += compress->ramp_time() + compress->hold_time;
  }
  return start;
}

History without_starts(const Plain& scenario, const History& all) {
  if (!scenario.uniform()) return all;
  History kept;
  for (const Moment& moment : all) {
    const double start = start_of(scenario, moment.step);
    if (moment.time > start * (1.0 + same_time) + 1e-12) kept.push_back(moment);
  }
  return kept;
}

std::optional<Deviation> deviation(const Plain& scenario, const History& got,
                                   const History& reference) {
  std::vector<History> parts{{}};
  for (std::size_t i = 1; i <= scenario.steps.size(); ++i)
    parts.push_back(of_step(got, static_cast<int>(i), !scenario.uniform()));
  return summed_up(scenario, reference, [&](const Moment& moment) -> std::optional<double> {
    const auto value = value_at(parts[as_index(moment.step)], moment.time);
    if (!value) return std::nullopt;
    return *value - moment.value;
  });
}

Deviation own_error(const Plain& scenario, const History& reference) {
  return summed_up(scenario, reference,
                   [](const Moment& moment) -> std::optional<double> { return moment.error; })
      .value_or(Deviation{});
}

}  // namespace palpate::chart
