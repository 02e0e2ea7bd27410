// One specimen of the stability map: a rung of the ladder with a mesh, free of contact and damping.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "scenario/family.h"
#include "scene/scene.h"
#include "study/modes.h"

namespace palpate::study {

struct Variant {
  scene::Scene scene;
  std::unique_ptr<scene::SpringBody> elastic;
  BodyMode highest;

  [[nodiscard]] int nodes() const { return scene.specimen->network.nodes(); }
};

// The scenario as the map needs it: with this model and volume term, linear kinematics, the whole
// body, no viscosity, and steps of any size.
[[nodiscard]] scenario::Scenario bare(scenario::Scenario scenario, scenario::Solver::Model model,
                                      scenario::Solver::Volume volume);

// Builds it. Throws what scene::build() throws.
[[nodiscard]] std::unique_ptr<Variant> make_variant(const scenario::Scenario& scenario,
                                                    const scenario::Family& family);

// The models that have a mesh, and the volume term that `auto` stands for; coupled springs where
// the scenario leaves the model open or needs none.
struct RungOf {
  scenario::Solver::Model model;
  scenario::Solver::Volume volume;
  bool operator==(const RungOf&) const = default;
};
[[nodiscard]] RungOf rung_of(const scenario::Scenario& scenario);

// A damping form with the tissue's own values: those of the scenario, else of its material, else
// assumed ones, and then `assumed` says so.
struct Damping {
  tissue::ViscousLaw law;
  bool assumed = false;
};
[[nodiscard]] Damping damping_of(const scenario::Scenario& scenario, const scenario::Family& family,
                                 tissue::Viscosity form);

// The contact at the deepest travel of the programme as a spring on the mesh, its force spread over
// the nodes by the Hertz pressure; nothing in uniform tests, which have no contact.
[[nodiscard]] std::optional<ContactSpring> contact_spring(const Variant& variant);

}  // namespace palpate::study
