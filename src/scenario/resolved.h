// A scenario in which open keys have values, from the materials and from the choice of the model;
// it is what a Scene computes.
#pragma once

#include "base/vec3.h"
#include "contact/hertz.h"
#include "scenario/family.h"

namespace palpate::scenario {

struct Resolved : PlainScenario {
  struct Substance {
    double density = 0.0;        // kg/m^3
    double young_modulus = 0.0;  // Pa
    double poisson_ratio = 0.0;  // of a region: the tissue's, if its springs cannot represent it
  };
  struct Tissue : PlainTissue, Substance {
    tissue::ViscousLaw law;  // elastic if no viscosity is computed and the material has none
    tissue::Base base = tissue::Base::bonded;
    // From the coordinates of a body's file to those of the scene, in which the finger comes along
    // -z; and the direction in the scene away from the side that is held.
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    Vec3 base_up = Vec3::UnitZ();
    int near_part = 0;  // of a file with several parts, which `finger.at` chooses; otherwise 0

    [[nodiscard]] bool held_from_below() const { return base_up.z() == 1.0; }
  };
  struct Region : PlainRegion, Substance {
    bool other_law = false;  // its material relaxes otherwise than the tissue, whose law it takes
  };
  struct Finger : PlainFinger {
    double density = 0.0;                     // kg/m^3
    std::optional<contact::Elastic> elastic;  // none if rigid, and in a uniform test
    double beside = 0.0;                      // m, of `at` from the surface
    std::optional<double> height = {};        // m, of the surface at `at`, in the scene
    int replaced = 0;                         // spheres for which the one stands
    bool moved = false;                       // to the top of a body that has nothing at its middle
  };
  struct Contact : PlainContact {
    Viscosity viscosity = Viscosity::none;
    Depth depth = Depth::hertz;
    Direction direction = Direction::surface;
  };
  struct Solver : PlainSolver {
    Model model = Model::hertz;
    Volume volume = Volume::none;
    Integrator integrator = Integrator::central_difference;
  };
  Tissue tissue;
  std::vector<Region> regions;
  Finger finger;
  Contact contact;
  Solver solver;

  [[nodiscard]] bool meshed() const { return traits(solver.model).meshed(); }
};

// Results of the choice of a model on which open keys depend. By default nothing was evaluated.
struct Found {
  bool viscosity_matters = true;
  bool inertia_matters = true;
  bool depth_matters = false;

  friend bool operator==(const Found&, const Found&) = default;
};

// The case with this model. All other open keys follow from the model, the materials and `found`.
// If viscosity does not matter, the contact has none, even if the scenario requests it.
[[nodiscard]] Resolved resolve(const Case& one, Model model, const Found& found = {});

// Whether a scenario without an integrator has keys of explicit steps.
[[nodiscard]] bool asks_for_steps(const Solver& solver);

// The scenario with the materials' values for all properties that it leaves open.
[[nodiscard]] Scenario filled(const Case& one);

// The same, with model, integrator, and viscosity and depth of the contact as resolved.
[[nodiscard]] Scenario answered(const Case& one, const Resolved& resolved);

// A tissue's viscous law: `Kelvin-Voigt, retardation time 0.1 s`; `none` without viscosity.
[[nodiscard]] std::string viscosity_text(const Resolved::Tissue& tissue);

}  // namespace palpate::scenario
