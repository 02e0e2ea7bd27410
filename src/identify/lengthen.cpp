// The loading history is lengthened where its end alone would leave rows of the measurement out.
#include "identify/lengthen.h"

#include <optional>

namespace palpate::identify {
std::optional<double> duration(const scenario::Scenario& scenario) {
  double time = 0.0;
  double travel = 0.0;
  for (const scenario::Step& step : scenario.steps) {
    if (const auto* indent = std::get_if<scenario::Indent>(&step)) {
      if (indent->to.second) return std::nullopt;
      time += (indent->to.value - travel) / indent->rate;
      travel = indent->to.value;
    } else if (const auto* retract = std::get_if<scenario::Retract>(&step)) {
      time += (travel - retract->to) / retract->rate;
      travel = retract->to;
    } else if (const auto* hold = std::get_if<scenario::Hold>(&step)) {
      time += hold->time;
    } else if (const auto* slide = std::get_if<scenario::Slide>(&step)) {
      time += slide->by / slide->rate;
    } else if (const auto* creep = std::get_if<scenario::Creep>(&step)) {
      time += creep->load_time + creep->recovery_time;
    } else if (const auto* relax = std::get_if<scenario::Relax>(&step)) {
      time += relax->time;
    } else if (const auto* compress = std::get_if<scenario::Compress>(&step)) {
      time += compress->ramp_time() + compress->hold_time;
    }
  }
  return time;
}

namespace {

constexpr double margin = 1e-6;  // relative; the last row lies beyond the last point

bool lengthen_time(scenario::Scenario& scenario, double farthest) {
  const auto lasts = duration(scenario);
  if (!lasts || farthest <= *lasts * (1.0 + 1e-9)) return false;
  const double more = farthest * (1.0 + margin) - *lasts;
  scenario::Step& last = scenario.steps.back();
  if (auto* hold = std::get_if<scenario::Hold>(&last))
    hold->time += more;
  else if (auto* relax = std::get_if<scenario::Relax>(&last))
    relax->time += more;
  else if (auto* creep = std::get_if<scenario::Creep>(&last))
    creep->recovery_time += more;
  else if (auto* compress = std::get_if<scenario::Compress>(&last))
    compress->hold_time += more;
  else if (auto* indent = std::get_if<scenario::Indent>(&last))
    indent->to.value += more * indent->rate;
  else
    return false;
  return true;
}

}  // namespace

bool lengthen(CurveKind kind, scenario::Scenario& scenario, double farthest) {
  const double end = farthest * (1.0 + margin);
  if (kind == CurveKind::force_travel) {
    for (scenario::Step& step : scenario.steps)
      if (auto* indent = std::get_if<scenario::Indent>(&step)) {
        if (indent->to.second || indent->to.value >= farthest) return false;
        indent->to.value = end;
        return true;
      }
    return false;
  }
  if (kind == CurveKind::tangential_slide) {
    for (scenario::Step& step : scenario.steps)
      if (auto* slide = std::get_if<scenario::Slide>(&step)) {
        if (slide->by >= farthest) return false;
        slide->by = end;
        return true;
      }
    return false;
  }
  if (kind == CurveKind::stress_strain) {
    auto* compress = std::get_if<scenario::Compress>(&scenario.steps.front());
    if (compress == nullptr || compress->strain >= farthest) return false;
    compress->strain = end;
    return true;
  }
  return lengthen_time(scenario, farthest);
}

}  // namespace palpate::identify
