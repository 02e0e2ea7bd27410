// What will be computed: built once from a case, constant from then on.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contact/coupling.h"
#include "geometry/flat_top.h"
#include "scenario/family.h"
#include "scene/spring_body.h"
#include "scene/time_plan.h"
#include "tissue/uniaxial.h"

namespace palpate::scene {

// A question of the ladder, asked in numbers.
struct Question {
  std::string asked;    // "rigid tissue?"
  std::string measure;  // "lambda_2 / (lambda_1 + lambda_2)"
  double number = 0.0;
  double threshold = 0.0;
  std::string answer;  // a sentence
};

// Which model serves the case, and why. Given models are kept.
struct Choice {
  scenario::Solver::Model model = scenario::Solver::Model::mass_spring;
  std::vector<Question> questions;
};
[[nodiscard]] Choice choose(const scenario::Scenario& scenario);

// The deepest travel of the programme, m; a force counts as the depth that Hertz gives it.
[[nodiscard]] double deepest_travel(const scenario::Scenario& scenario,
                                    const contact::SphereLaw& law);

// The specimen as springs. Holds everything that a step needs.
struct Specimen {
  geometry::TetMesh mesh;
  tissue::Network network;
  tissue::ViscousLaw law;
  tissue::Kinematics kinematics = tissue::Kinematics::linear;
  tissue::Base base = tissue::Base::bonded;
  double top_height = 0.0;  // m
  double top_area = 0.0;    // m^2
  std::optional<geometry::FlatTop> top;
  tissue::Uniaxial measured;               // on frictionless platens: the network's own E and nu
  tissue::Uniaxial pressed;                // on the scene's own base: how platens load it
  std::vector<char> held;                  // of a pressed specimen
  std::vector<char> held_between_platens;  // of a relaxing one
  TimePlan plan;
};

struct Scene {
  std::string name;
  scenario::Scenario scenario;
  Choice choice;
  contact::SphereLaw law;              // of the finger on the flat
  double finger_weight = 0.0;          // N, where it counts besides the contact force
  double finger_share = 0.0;           // lambda_1 / (lambda_1 + lambda_2)
  std::unique_ptr<Specimen> specimen;  // none for `hertz`
};

// Builds a case. Relative mesh files are looked for in `folder`.
// Throws MeshError for a mesh that cannot serve, InputError for a time step above its limit.
[[nodiscard]] Scene build(const scenario::Case& one, const scenario::Family& family);

// The contact in the middle of the specimen's top.
[[nodiscard]] contact::FlatContact make_contact(const Scene& scene);

}  // namespace palpate::scene
