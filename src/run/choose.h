// The choice of the model for a case.
#pragma once

#include "scene/scene.h"

namespace palpate::run {

// `quick` leaves out models that take seconds: for searches and for steps in real time.
enum class Models { all, quick };

// The cheapest model whose stated error is within `solver.tolerance`, or else the one with the
// least error, and the reasons for it. What size, base and sides of the body change is measured on
// one coarse mesh of it, size_effect(); `shapes` keeps meshes and measurements.
//                                                                        docs/theory.md (69)
[[nodiscard]] scene::Choice choose(const scenario::Case& one, scene::SpecimenShapes& shapes,
                                   Models models = Models::all);
[[nodiscard]] scene::Choice choose(const scenario::Case& one);

}  // namespace palpate::run
