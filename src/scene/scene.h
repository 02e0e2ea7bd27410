// All that is needed to compute one case; built once from the case, and constant from then on.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "contact/law.h"
#include "contact/layer.h"
#include "contact/viscous_contact.h"
#include "geometry/curved_edges.h"
#include "geometry/shapes.h"
#include "geometry/smooth_surface.h"
#include "geometry/tet_mesh.h"
#include "scenario/resolved.h"
#include "scene/estimates.h"
#include "scene/refining_press.h"
#include "scene/spring_body.h"
#include "scene/surface_touch.h"
#include "scene/time_plan.h"
#include "tissue/stiffness.h"
#include "tissue/viscous.h"

namespace palpate::scene {

struct Finger;
struct Scene;

// One of the first three gives the body; inclusions and layers of the scenario come on top.
struct SolidBody {
  std::optional<geometry::Shape> shape;
  std::shared_ptr<const geometry::SmoothSurface> surface;  // of a file, or of a mesh of one tissue
  std::optional<geometry::TetMesh> mesh;                   // with the numbers of substances
  geometry::EdgeMiddles middles;                           // of a mesh of curved tetrahedra
  std::shared_ptr<const geometry::SmoothSurface> outer_surface;  // the surface of any of them
  double base_level = 0.0;          // m; the surface up to here along `tissue.base_up` is held
  Vec3 first_touch = Vec3::Zero();  // m, the finger's point there
  Vec3 touched = Vec3::Zero();      // m, the place of the surface there
};

// The substance of a part of a shape: 0 is the tissue, then the scenario's regions in order.
[[nodiscard]] int substance_of(const scenario::Resolved& scenario, int part);

// The finger's point and the place of the surface (m) at first touch, with the finger at a place
// (m) beside that of the body; nothing where it passes beside the body.
[[nodiscard]] std::optional<std::pair<Vec3, Vec3>> touch_beside(const SolidBody& body,
                                                                const Finger& finger,
                                                                const Vec3& place);

// With the triangles of a file's surface as they are, and their first touch. Throws MeshError if
// the finger passes beside the body.
[[nodiscard]] SolidBody flattened(const SolidBody& body, const Scene& scene);

// Throws MeshError if the finger passes beside the body, or as specimen_mesh() does.
[[nodiscard]] std::unique_ptr<SolidBody> make_solid_body(const Scene& scene,
                                                         const std::string& folder);

}  // namespace palpate::scene

namespace palpate::integrate {
struct KnownModes;
}

namespace palpate::scene {

// The questions (criteria) of the choice of a model.
enum class Asked {
  uniform,
  ratio_matters,
  force_knows_mesh,
  rigid_tissue,
  half_space,
  layer,
  edge,
  deep,
  curved,
  time_dependent,
  inertia,
  shape_or_inclusion,
  family
};

// A question with its numbers.
struct Question {
  std::string asked;    // in a word: "sides"
  std::string measure;  // "decrease of the force by the sides"; empty without a number
  double number = 0.0;
  double threshold = 0.0;
  std::string answer;  // the result as a sentence
};

// The expected error and cost of a model for the case.
struct Forecast {
  scenario::Model model = scenario::Model::hertz;
  double error = 0.0;       // relative, of the force; of the strain in a uniform test
  double of_mesh = 0.0;     // the part of it that a mesh knows better once it is made
  double seconds = 0.0;     // rough time to set up and run on one core
  std::string cannot = {};  // the reason why the model is not applicable; empty if it is

  // The error with what the mesh of the model `at_hand` costs, if that is known. Springs share a
  // mesh; that of `solid` is another.
  [[nodiscard]] double known(std::optional<double> mesh_error, scenario::Model at_hand) const {
    const bool same = !scenario::traits(model).formula() &&
                      scenario::traits(model).solid == scenario::traits(at_hand).solid;
    return mesh_error && same ? error - of_mesh + *mesh_error : error;
  }
};

// The model for the case, and the reasons for it. Values that the scenario gives are kept.
struct Choice {
  scenario::Resolved chosen;
  bool given = false;  // whether the scenario names the model
  std::vector<Question> questions;
  std::vector<Forecast> forecasts;  // cheapest first; empty if `one_way` alone decides the model
  scenario::Found found;
  double waves = 0.0;  // relative error of the force of every model without inertia
  // What would be taken if the scenario named no model, and what it would have.
  Forecast otherwise;
  scenario::Found otherwise_found;
  SurfaceTouch touch;  // what closed forms know of the surface; not in a uniform test
  Estimates expected;  // not in a uniform test; its `depth_ratio` may not be used

  // The forecast for a model; null if there is none, or the model is not applicable.
  [[nodiscard]] const Forecast* forecast(scenario::Model model) const;
  // The forecast for the chosen model.
  [[nodiscard]] const Forecast* taken() const { return forecast(chosen.solver.model); }
  // A sentence if `auto` found no model within the tolerance, also with what the mesh at hand
  // costs; otherwise empty.
  [[nodiscard]] std::string shortfall(std::optional<double> mesh_error = {}) const;
};
class SpecimenShapes;

// The given model as the choice, with no questions and no forecasts.
[[nodiscard]] Choice given_choice(const scenario::Case& one, scenario::Model model,
                                  SpecimenShapes& shapes);

// The finger: equal spheres around a reference point that travels.
struct Finger {
  double sphere_radius = 0.0;     // m, of each
  std::vector<Vec3> centres;      // m, from the reference point
  double sphere_modulus = 0.0;    // Pa, E* of each, with the factor of its calibration
  contact::SphereLaw whole;       // the single sphere that they replace: radius and E*
  double weight = 0.0;            // N, if friction counts it besides the contact force; else 0
  double compliance_share = 0.0;  // lambda_1 / (lambda_1 + lambda_2)
  double shear_compliance = 0.0;  // 1/Pa, q of Cattaneo and Mindlin; docs/theory.md [cattaneo]
  double force_factor = 1.0;      // force of all spheres over that of `whole`, on a flat
};

[[nodiscard]] Finger make_finger(const scenario::Resolved& scenario);

// The deepest travel of the loading history, m; a force is converted into Hertz's depth, and what
// the body yields over that (Estimates::yields).
[[nodiscard]] double deepest_travel(const scenario::Resolved& scenario,
                                    const contact::SphereLaw& law, double yields = 0.0);

constexpr double most_poisson_ratio = 0.4995;  // in a mesh; larger values are reduced to it
// The elastic properties of the tissue and of the regions, in the order of a mesh's numbers. A mesh
// has no solution at nu = 1/2, so that nu is at most most_poisson_ratio.
[[nodiscard]] std::vector<tissue::Isotropic> tissues_of(const scenario::Resolved& scenario);

constexpr double own_share = 0.05;  // bulk over shear modulus of a tetrahedron; [nodal_volume]

// The specimen as springs, with all data that its steps need.
struct Specimen {
  geometry::TetMesh mesh;          // regions: 0 is the tissue, then the scenario's regions in order
  std::optional<Refined> refined;  // empty if the mesh is as asked for
  tissue::Network network;
  tissue::ViscousLaw law;
  tissue::Kinematics kinematics = tissue::Kinematics::linear;
  tissue::Base base = tissue::Base::bonded;
  double base_height = 0.0;  // m; the surface up to this height is the base
  Vec3 low = Vec3::Zero();   // m, corners of the bounding box
  Vec3 high = Vec3::Zero();
  std::vector<int> outer_surface;  // the node of every vertex of `surface`
  std::optional<geometry::SmoothSurface> surface;
  std::string warning;  // those of SpecimenShape
  std::string straightened;
  tissue::Uniaxial measured;               // E and nu of the network with the tissue everywhere
  tissue::Uniaxial pressed;                // response to platens, for a uniform test
  std::vector<char> held;                  // in a press and in creep
  std::vector<char> held_between_platens;  // in relaxation
  TimePlan plan;

  [[nodiscard]] double height() const { return high.z() - low.z(); }
};

class SurfaceDisplacementStore;

struct Scene {
  std::string name;
  scenario::Resolved scenario;
  Choice choice;
  Finger finger;
  contact::Relaxation relaxation;                  // of the contact's modulus; empty if elastic
  std::optional<contact::DepthRatio> depth_ratio;  // with `contact.depth = "neo_hookean"`
  std::optional<contact::LayerContact> layer;  // for `layer`, and for `consistent` on flat layers
  std::unique_ptr<Specimen> specimen;          // null for `hertz`, `layer` and `solid`
  std::unique_ptr<SolidBody> solid;            // null for the others
  // The surface of the file; null for other shapes. A mesh may have a coarser one.
  std::shared_ptr<const geometry::SmoothSurface> of_file;
  // The surface that is pressed; null without a mesh.
  [[nodiscard]] const geometry::SmoothSurface* outer_surface() const;
  SurfaceDisplacementStore* surface_displacements =
      nullptr;                                   // of cases that share bodies; outlives the scene
  integrate::KnownModes* known_modes = nullptr;  // of a body that is run again; outlives the scene

  // From the top (without a mesh: the touch) to the base, m; infinite for shapes without size.
  [[nodiscard]] double thickness() const;

  // The contact law of the finger as one sphere on a flat, for estimates.
  [[nodiscard]] const contact::SphereLaw& law() const { return finger.whole; }
};

// Number of cells of the surface along the contact radius a = sqrt(R h) of the deepest travel, at
// the coarsest place of the finger's path. A cell is two triangles; its side is the square root of
// twice their mean area within a of the finger.                              docs/theory.md [cells]
[[nodiscard]] double cells_per_contact_radius(const Scene& scene);

// Builds a case with a choice that was made before; `shapes` keeps what is built. Relative mesh
// files are looked for in the family's folder. Throws MeshError for an unsuitable mesh, InputError
// for a time step above its limit and for a model that cannot be used.
[[nodiscard]] Scene build(const scenario::Case& one, const scenario::Family& family,
                          SpecimenShapes& shapes, Choice choice);

// The reason why a model cannot compute a scene with a finger; nothing if it can.
[[nodiscard]] std::optional<std::string> beyond(scenario::Model model,
                                                const scenario::Resolved& scenario,
                                                const SurfaceTouch& touch);

// The finger's part of the compliance, behind which the tissue relaxes: a thin layer or a body that
// is stiffer than a half-space has less of it than their half-spaces have. At once and at rest the
// modulus is then that of the elastic forces.                          docs/theory.md [relaxation]
[[nodiscard]] double finger_share_on_body(const Scene& scene);
// A tissue's law as that of its modulus.
[[nodiscard]] contact::Relaxation relaxation_of(const tissue::ViscousLaw& law);

// Whether all regions are layers; true without regions.
[[nodiscard]] bool all_slabs(const scenario::Resolved& scenario);

// Whether a region has another Young's modulus or Poisson's ratio than the tissue, or is an
// inclusion: one of the tissue's own modulus takes the model that it would take with another, so
// that both can be compared.
[[nodiscard]] bool several_tissues(const scenario::Resolved& scenario);

// The flat layers of a cuboid, with the tissue on top. `share` as in contact::Layer.
//                                                               docs/theory.md [layer_stack]
[[nodiscard]] contact::Layer layers_of(const scenario::Resolved& scenario, double share);

}  // namespace palpate::scene
