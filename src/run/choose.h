// The choice of the model for a case.
#pragma once

#include <map>
#include <optional>

#include "scene/scene.h"

namespace palpate::run {

// `quick` excludes models that take seconds: for searches and for steps in real time.
enum class Models { all, quick };

// The cheapest model whose stated error is within `solver.tolerance`, or else the one with the
// least error, and the reasons for it. What size, base and sides of the body change is measured on
// one coarse mesh of it, size_effect(); `shapes` keeps meshes and measurements.
//                                                                    docs/theory.md [choice]
[[nodiscard]] scene::Choice choose(const scenario::Case& one, scene::SpecimenShapes& shapes,
                                   Models models = Models::all);
[[nodiscard]] scene::Choice choose(const scenario::Case& one);

// The dearest model that `auto` takes for a case of the family; of more than 64 cases, for 64 of
// them, evenly chosen: compared cases take one model, so that their differences are none of models.
struct OneModel {
  std::optional<scenario::Model> model;            // nothing where the scenario names a model
  std::map<std::size_t, scene::Choice> choices{};  // that were made, by the number of the case
};
[[nodiscard]] OneModel one_model(const scenario::Family& family, scene::SpecimenShapes& shapes,
                                 int workers);

}  // namespace palpate::run
