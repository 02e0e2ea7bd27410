// Presses and fingers that do not fit the size of the body: mostly a wrong unit of its file.
#pragma once

#include <string>
#include <vector>

#include "scenario/family.h"
#include "scenario/resolved.h"
#include "scene/estimates.h"
#include "scene/surface_touch.h"

namespace palpate::scene {

// The first step (from 1) whose displacement goes through the body under the finger, with what is
// hollow in it, down to what holds it, or is longer than the body; 0 if there is none.
[[nodiscard]] std::size_t step_through(const scenario::Resolved& scenario,
                                       const SurfaceTouch& touch, const Estimates& estimates);

// Throws InputError for such a step.
void refuse_through(const scenario::Resolved& scenario, const SurfaceTouch& touch,
                    const Estimates& estimates, const scenario::Family& family);

// Throws InputError for `finger.at` far from the surface, mostly a wrong unit, and on an inner
// wall, along whose normal the finger meets another side of the body first.
void refuse_beside(const scenario::Resolved& scenario, const SurfaceTouch& touch,
                   const scenario::Family& family);

// Sentences on what is computed, but probably not meant: a press through more than half of the
// tissue, a finger wider than the body, a body longer than any that is pressed, another side of the
// body than that of `finger.at`, and a press along a normal from which that of the surface around
// it differs.
[[nodiscard]] std::vector<std::string> disproportions(const scenario::Resolved& scenario,
                                                      const SurfaceTouch& touch,
                                                      const Estimates& estimates);

}  // namespace palpate::scene
