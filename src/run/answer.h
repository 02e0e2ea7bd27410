// What a case computes, how good it is and what it neglects, in plain sentences.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "record/record.h"
#include "scene/scene.h"

namespace palpate::run {

struct Neglected {
  std::string what;  // "viscosity"
  // Of the force (in a uniform test of the strain) by the effect, relative; empty if it is not
  // known.
  std::optional<double> change = {};
  std::string when;    // the change in words: "which would add 36 % to the force while pressing"
  std::string remedy;  // an instruction such as "add `key = value`"; empty if there is none
  std::string
      beside;  // what the stated error does not contain: "viscosity"; empty if it contains it
};

// Viscosity and large strains count from a fifth of `solver.tolerance` on, the others from the
// tolerance on. What is not known is the first, then the largest.
[[nodiscard]] std::vector<Neglected> neglected(const scene::Scene& scene);

// What is known before a case runs.
struct Expected {
  record::Answer answer;
  std::optional<double> mesh_error;  // the mesh's part of it: run::mesh_error()
  std::vector<Neglected> neglected;
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
