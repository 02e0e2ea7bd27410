// What the parts of a stability map share while it is measured.
#pragma once

#include "contact/passivity.h"
#include "study/measure.h"

namespace palpate::study {

struct Survey {
  const scenario::Case* one = nullptr;
  const scenario::Family* family = nullptr;
  const std::atomic<bool>* stop = nullptr;
  const Told* told = nullptr;
  RungOf rung;                   // the scenario's own
  std::unique_ptr<Variant> own;  // on its own mesh
  StabilityMap map;
  int done = 0;
  int planned = 1;

  // Where every step costs ten times as much, other rungs are measured without damping alone, and
  // a few settings stand for an axis.
  [[nodiscard]] bool large() const { return own->nodes() > 200; }

  // Before every measurement: says what comes; false where the map is to end.
  [[nodiscard]] bool go_on(const std::string& what);

  // A variant of the case's scenario on `rung`, changed by `change`.
  [[nodiscard]] std::unique_ptr<Variant> variant(
      const RungOf& on, const std::function<void(scenario::Scenario&)>& change = {}) const;
};

struct Setting {
  std::string axis;
  std::optional<double> value = {};
  std::string damping = {};
  std::string note = {};
  const ContactSpring* contact = nullptr;
};

// Measures one limit and adds its row.
void add_limit(Survey& survey, Variant& variant, const std::string& method,
               const tissue::ViscousLaw& law, const Setting& setting);

// The parts of the map; each ends early where the survey does.
void survey_rungs(Survey& survey);
void survey_axes(Survey& survey);
void probe_time(Survey& survey);   // divergence, non_finite, drift
void probe_shape(Survey& survey);  // inversion, false equilibrium, locking
void probe_touch(Survey& survey);  // tunnelling, chatter

// What the map says, for people.
[[nodiscard]] std::vector<std::string> map_sentences(const Survey& survey);

}  // namespace palpate::study
