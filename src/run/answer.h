// What a case computes, how good it is and what it leaves out, in plain sentences.
#pragma once

#include <optional>
#include <vector>

#include "record/record.h"
#include "run/left_out.h"

namespace palpate::run {

// What is known before a case runs.
struct Expected {
  record::Answer answer;
  std::optional<double> mesh_error;  // the mesh's part of it: run::mesh_error()
  std::vector<LeftOut> left_out;
};
[[nodiscard]] Expected expect(const scene::Scene& scene);

// The error of the model, relative, of the force (in a uniform test of the strain), with
// `mesh_error` in place of the forecast for the mesh. Empty if nothing estimates it.
[[nodiscard]] std::optional<double> stated_error(const scene::Scene& scene,
                                                 std::optional<double> mesh_error);

// The answer of a case that has ended.
[[nodiscard]] record::Answer answer(const scene::Scene& scene, const record::CaseRecord& record);

}  // namespace palpate::run
