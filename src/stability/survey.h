// The context that the functions of a stability map share while it is measured.
#pragma once

#include "stability/measure.h"

namespace palpate::stability {

struct Survey {
  const scenario::Case* one = nullptr;
  const scenario::Family* family = nullptr;
  const Told* told = nullptr;
  scene::SpecimenShapes shapes;     // of all bodies
  ModelAndVolume given;             // of the scenario
  std::unique_ptr<ProbedBody> own;  // the scenario's specimen
  StabilityMap map;
  int done = 0;     // measurements
  int planned = 1;  // estimated number of measurements

  // For a large mesh other models are measured without damping only, and axes with fewer settings.
  [[nodiscard]] bool large() const { return own->nodes() > 200; }

  // Call before every measurement: reports `what` to `told`. Throws Stopped.
  void go_on(const std::string& what);

  // The body of the scenario with the model and volume term `on`, after `change`.
  [[nodiscard]] std::unique_ptr<ProbedBody> make_body(
      const ModelAndVolume& on, const std::function<void(scenario::Scenario&)>& change = {});
};

// The parts of the map.
void survey_models(Survey& survey);
void survey_axes(Survey& survey);
void probe_time(Survey& survey);   // divergence, non_finite, drift
void probe_shape(Survey& survey);  // inversion, false equilibrium, locking
void probe_touch(Survey& survey);  // chatter

// The longest step (s) that was stable with central differences and the scenario's own model.
[[nodiscard]] std::optional<double> longest_step(const Survey& survey);

// The findings of the map as sentences, for stdout.
[[nodiscard]] std::vector<std::string> map_sentences(const Survey& survey);

}  // namespace palpate::stability
