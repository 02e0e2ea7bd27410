// What a case computes, how good it is and what it neglects, in plain sentences.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

// Viscosity and large strains count from a fifth of `solver.tolerance` on, the others from the
// tolerance on. What is not known is the first, then the largest.
[[nodiscard]] std::vector<record::Neglected> neglected(const scene::Scene& scene);

// What is known before a case runs.
struct Expected {
  record::Answer answer;
  std::optional<double> mesh_error;  // the mesh's part of its error: run::mesh_error()
};
[[nodiscard]] Expected expect(const scene::Scene& scene);

// The error of the model, relative, of the force (in a uniform test of the strain), with
// `mesh_error` in place of the forecast for the mesh. Empty if nothing estimates it.
[[nodiscard]] std::optional<double> stated_error(const scene::Scene& scene,
                                                 std::optional<double> mesh_error);

// The answer of a case that has ended.
[[nodiscard]] record::Answer answer(const scene::Scene& scene, const record::CaseRecord& record);

// Whether the force of a press comes from a mesh that states its own error in every row.
[[nodiscard]] bool states_mesh_error(const scene::Scene& scene);

// The mesh's own error in the static force at the largest displacement of the loading history, a
// fraction of it. Nothing without a finger on a mesh with `consistent`, or where the contact has no
// solution.
//                                                                docs/theory.md [compliance]
[[nodiscard]] std::optional<double> mesh_error(const scene::Scene& scene);

}  // namespace palpate::run
