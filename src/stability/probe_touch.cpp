// Probes for failures of contact: presses between two frames (tunnelling), and chatter.
#include <cmath>

#include "stability/sampled_wall.h"
#include "stability/survey.h"

namespace palpate::stability {
namespace {

// Whether a press to `depth` (m) and back at `speed` (m/s) can fall between two frames.
bool slips_through(double depth, double speed, double frame) {
  constexpr int phases = 1000;
  const double lasts = 2.0 * depth / speed;
  for (int i = 0; i < phases; ++i) {
    // `time` runs over the frames after the first contact, which lies between two frames.
    bool seen = false;
    for (double time = frame * (i + 1) / phases; time < lasts && !seen; time += frame) seen = true;
    if (!seen) return true;
  }
  return false;
}

double first_rate(const scenario::Scenario& scenario) {
  for (const scenario::Step& step : scenario.steps)
    if (const auto* indent = std::get_if<scenario::Indent>(&step)) return indent->rate;
  return 0.0;
}

void probe_tunnelling(Survey& survey, double depth) {
  survey.go_on("tunnelling");
  const scenario::Scenario& scenario = survey.one->scenario;
  const double frame = scenario.output.interval;
  const double rate = first_rate(scenario);
  FailureRow row;
  row.failure = Failure::tunnelling;
  row.rung = "any";
  row.setting = 1e3 * rate;
  row.setting_unit = "mm/s, the rate of loading";
  row.measure = "rate above which a press to the deepest travel falls between two frames, mm/s";
  const auto seen = [&](double speed) { return !slips_through(depth, speed, frame); };
  row.theory = 1e3 * 2.0 * depth / frame;
  if (const auto limit = bisect_limit(seen, 0.01 * depth / frame, 1e3 * depth / frame, 1e-4))
    row.measured = 1e3 * *limit;
  row.reached = slips_through(depth, rate, frame);
  row.note = "a press of the loading history lasts " +
             std::to_string(std::lround(2.0 * depth / rate / frame)) + " frames, in and out";
  survey.map.failures.push_back(std::move(row));
}

// A hand pushes on a wall with the stiffness of the contact, through a device whose damping is
// `share` times the bound of Colgate and Brown for frames of 1 ms.
void probe_chatter(Survey& survey, double stiffness) {
  for (const double share : {2.0, 0.25}) {
    survey.go_on("chatter");
    Device device;
    device.sampled.damping = share * contact::needed_damping(stiffness, device.sampled);
    FailureRow row;
    row.failure = Failure::chatter;
    row.rung = "device";
    row.integrator = "zero_order_hold";
    row.setting = share;
    row.setting_unit = "device damping over K T / 2, frames of 1 ms";
    row.measure = "share of frames in which the contact comes or goes";
    row.measured = chatter_share(device, stiffness, {});
    if (share > 1.0) row.theory = 0.0;
    row.reached = *row.measured > 0.0;
    row.note = "K = " + std::to_string(std::lround(stiffness)) + " N/m, pushed by 1 N";
    survey.map.failures.push_back(std::move(row));
  }
}

}  // namespace

void probe_touch(Survey& survey) {
  const auto spring = contact_spring(*survey.own);
  if (!spring) return;
  const scene::Scene& scene = survey.own->scene;
  probe_tunnelling(survey, scene::deepest_travel(scene.scenario, scene.law()));
  probe_chatter(survey, spring->stiffness);
}

}  // namespace palpate::stability
