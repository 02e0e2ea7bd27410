// What a choice says of its models.
#include "base/text.h"
#include "scene/places.h"
#include "scene/refining_press.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"

namespace palpate::scene {

const Forecast* Choice::forecast(scenario::Model model) const {
  for (const Forecast& rung : rungs)
    if (rung.model == model && rung.cannot.empty()) return &rung;
  return nullptr;
}

std::string Choice::shortfall(std::optional<double> mesh_error) const {
  const Forecast* rung = taken();
  const double error = rung != nullptr ? rung->known(mesh_error) : 0.0;
  if (given || !(error > chosen.solver.tolerance)) return "";
  return "no model is expected to be within the tolerance of " +
         percent_text(chosen.solver.tolerance) + ": `" + scenario::rung(rung->model).word +
         "` comes nearest with " + error_text(error) +
         (chosen.meshed() && !refines(chosen) ? "; a finer `tissue.mesh` may help" : "");
}

Choice given_choice(const scenario::Case& one, scenario::Model model, SpecimenShapes& shapes) {
  Choice choice;
  choice.given = true;
  choice.chosen = scenario::resolve(one, model);
  place_in_scene(choice.chosen, one.folder, shapes);
  if (choice.chosen.uniform()) return choice;
  choice.touch = surface_touch(choice.chosen, one.folder, shapes);
  choice.expected = estimate(choice.chosen, choice.touch);
  return choice;
}

}  // namespace palpate::scene
