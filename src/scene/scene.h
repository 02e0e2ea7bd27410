// What will be computed: built once from a case, constant from then on.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contact/deep.h"
#include "contact/law.h"
#include "contact/layer.h"
#include "contact/layer_sinking.h"
#include "contact/relaxation.h"
#include "geometry/smooth_surface.h"
#include "scenario/family.h"
#include "scene/spring_body.h"
#include "scene/time_plan.h"
#include "tissue/uniaxial.h"
#include "tissue/viscous.h"

namespace palpate::scene {

// A question of the ladder, asked in numbers.
struct Question {
  std::string asked;    // "rigid tissue?"
  std::string measure;  // "lambda_2 / (lambda_1 + lambda_2)"
  double number = 0.0;
  double threshold = 0.0;
  std::string answer;  // a sentence
};

// What a rung of the ladder is expected to be worth for the case.
struct Rung {
  scenario::Solver::Model model = scenario::Solver::Model::hertz;
  double error = 0.0;       // relative, of the force; of the strain in a uniform test
  double seconds = 0.0;     // to set up and to run, on one core, roughly
  std::string cannot = {};  // why it cannot serve at all, where it cannot
};

// Which model serves the case, and why. What the scenario gives is kept.
struct Choice {
  scenario::Scenario chosen;  // the scenario, with an answer in the place of every `auto`
  bool given = false;         // the model was: there are no questions
  std::vector<Question> questions;
  std::vector<Rung> rungs;  // cheapest first

  // Of the model that is taken; nothing where it is no rung.
  [[nodiscard]] const Rung* taken() const;
  // A sentence where `auto` found nothing within the tolerance; else empty.
  [[nodiscard]] std::string shortfall() const;
};
[[nodiscard]] Choice choose(const scenario::Scenario& scenario);

// The finger: equal spheres about a point that travels.
struct Finger {
  double sphere_radius = 0.0;     // m, of each
  std::vector<Vec3> centres;      // m, from the finger's point
  double sphere_modulus = 0.0;    // Pa, E* of each, its calibration included
  contact::SphereLaw whole;       // the one sphere that they replace: radius and E*
  double weight = 0.0;            // N, where it counts besides the contact force
  double compliance_share = 0.0;  // lambda_1 / (lambda_1 + lambda_2)
  double shear_compliance = 0.0;  // 1/Pa, q of Cattaneo and Mindlin
  double force_factor = 1.0;      // of all spheres together over the whole, on a flat
};

[[nodiscard]] Finger make_finger(const scenario::Scenario& scenario);

// The deepest travel of the programme, m; a force counts as the depth that Hertz gives it.
[[nodiscard]] double deepest_travel(const scenario::Scenario& scenario,
                                    const contact::SphereLaw& law);

constexpr double most_poisson_ratio = 0.4995;  // of a mesh
constexpr double own_share = 0.05;  // of the shear modulus: the bulk stiffness of tetrahedra alone

// The specimen as springs. Holds everything that a step needs.
struct Specimen {
  geometry::TetMesh mesh;  // its regions count the tissue and the scenario's regions from 0
  tissue::Network network;
  tissue::ViscousLaw law;
  tissue::Kinematics kinematics = tissue::Kinematics::linear;
  tissue::Base base = tissue::Base::bonded;
  double base_height = 0.0;  // m, of the skin that is the base
  Vec3 low = Vec3::Zero();   // m, corners of the bounding box
  Vec3 high = Vec3::Zero();
  std::vector<int> skin;  // the node of every vertex of `surface`
  std::optional<geometry::SmoothSurface> surface;
  std::optional<tissue::Network> one_tissue;     // were it all the tissue; none: it is
  tissue::Uniaxial measured;                     // the network's own E and nu, were it one tissue
  std::optional<contact::LayerSinking> sinking;  // of a flat layer of the network's nu
  tissue::Uniaxial pressed;                      // how platens load it, in a uniform test
  std::vector<char> held;                        // of a pressed specimen
  std::vector<char> held_between_platens;        // of a relaxing one
  TimePlan plan;

  [[nodiscard]] double height() const { return high.z() - low.z(); }
};

struct Scene {
  std::string name;
  scenario::Scenario scenario;  // with what `auto` chose in the place of every `auto`
  Choice choice;
  Finger finger;
  contact::Relaxation relaxation;              // of the contact's modulus; elastic: it does not
  std::optional<contact::DeepLaw> deep;        // for `hertz` with `contact.depth = "neo_hookean"`
  std::optional<contact::LayerContact> layer;  // for `layer`, and where `consistent` builds on it
  std::optional<contact::LayerSinking> layer_sinking;  // around the contact on it
  std::unique_ptr<Specimen> specimen;                  // none for `hertz` and `layer`

  // From the top to what the specimen stands on, m; infinite for a half-space.
  [[nodiscard]] double thickness() const;

  // The finger's law on the flat as one sphere, for estimates.
  [[nodiscard]] const contact::SphereLaw& law() const { return finger.whole; }
};

// Builds a case. Relative mesh files are looked for in `folder`.
// Throws MeshError for a mesh that cannot serve, InputError for a time step above its limit.
[[nodiscard]] Scene build(const scenario::Case& one, const scenario::Family& family);

// The same scene, to the bit, with what `shapes` has of its specimen not built again.
class SpecimenShapes;
[[nodiscard]] Scene build(const scenario::Case& one, const scenario::Family& family,
                          SpecimenShapes& shapes);
// By a choice that was made before, for many cases: no question is asked.
[[nodiscard]] Scene build(const scenario::Case& one, const scenario::Family& family,
                          SpecimenShapes& shapes, Choice choice);

// The principal curvatures (1/m, convex positive) where `hertz` presses: of the flat or half-space,
// or of the parametric shape's top. Nothing for shapes that only a mesh knows.
struct TopCurvature {
  double kappa_1 = 0.0, kappa_2 = 0.0;  // kappa_1 >= kappa_2
  Vec3 direction_1 = Vec3::UnitX();
};
[[nodiscard]] std::optional<TopCurvature> top_curvature(const scenario::Shape& shape);

// Why `hertz` or `layer` cannot serve a scene with a finger; nothing where they can.
[[nodiscard]] std::optional<std::string> beyond_hertz(const scenario::Scenario& scenario);
[[nodiscard]] std::optional<std::string> beyond_layer(const scenario::Scenario& scenario);

// What the specimen stands on.
[[nodiscard]] tissue::Base base_of(const scenario::Scenario& scenario);
[[nodiscard]] contact::LayerBase layer_base(const scenario::Scenario& scenario);

// The tissue's viscous law.
[[nodiscard]] tissue::ViscousLaw viscous_law(const scenario::Tissue& tissue);

// How the contact's modulus relaxes: the tissue's branches behind an elastic finger; elastic where
// the contact does not know them.
[[nodiscard]] contact::Relaxation contact_relaxation(const scenario::Scenario& scenario,
                                                     const Finger& finger);

// The finger on a flat layer as thick as the specimen.
// Whether every region is a layer from side to side, or there is none.
[[nodiscard]] bool all_slabs(const scenario::Scenario& scenario);

// The flat layers of a cuboid, the tissue on top; with a `network`, as that has them: with its nu
// in place of the tissue's. `share` as in contact::Layer.
[[nodiscard]] contact::Layer layers_of(const scenario::Scenario& scenario, double share,
                                       const tissue::Uniaxial* network = nullptr);

[[nodiscard]] contact::LayerContact make_layer(const scenario::Scenario& scenario,
                                               const Finger& finger, contact::LayerLaw law);

}  // namespace palpate::scene
