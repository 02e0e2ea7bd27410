// One specimen of the stability map: a model with a mesh, without contact and damping.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "scene/scene.h"
#include "scene/specimen_shape.h"
#include "stability/modes.h"

namespace palpate::stability {

struct ProbedBody {
  scene::Scene scene;
  std::unique_ptr<scene::SpringBody> elastic;
  BodyMode highest;

  [[nodiscard]] int nodes() const { return scene.specimen->network.nodes(); }
};

// The case with this model and volume term, linear kinematics, the whole body, and no viscosity.
[[nodiscard]] scenario::Case bare(scenario::Case one, scenario::Model model, tissue::Volume volume);

// Builds the scene and its highest mode; `shapes` keeps the mesh. Throws like scene::build().
[[nodiscard]] std::unique_ptr<ProbedBody> make_probed_body(const scenario::Case& one,
                                                           const scenario::Family& family,
                                                           scene::SpecimenShapes& shapes);

// The scenario's model and volume term, or the model's default term. Coupled springs if the
// scenario names no model or one without a mesh.
struct RungOf {
  scenario::Solver::Model model;
  scenario::Solver::Volume volume;
  bool operator==(const RungOf&) const = default;
};
[[nodiscard]] RungOf rung_of(const scenario::Scenario& scenario);

// A form of damping with the values of the scenario, else of its material, else assumed values.
struct Damping {
  tissue::ViscousLaw law;
  bool assumed = false;  // whether a value is assumed
};
[[nodiscard]] Damping damping_of(const scenario::Case& one, tissue::Viscosity form);

// The contact at the deepest travel of the loading history as a spring on the mesh, with the force
// distributed over the nodes by the Hertz pressure; nothing for uniform tests.
[[nodiscard]] std::optional<ContactSpring> contact_spring(const ProbedBody& probed);

}  // namespace palpate::stability
