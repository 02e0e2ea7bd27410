// Builds the specimens of a stability map from changed scenarios.
#include "stability/probed_body.h"

#include "contact/hertz.h"
#include "contact/patch.h"
#include "run/refined_mesh.h"
#include "scene/first_touch.h"

namespace palpate::stability {

using scenario::Scenario;
using scenario::Solver;
using tissue::Viscosity;

scenario::Case bare(scenario::Case one, scenario::Model model, tissue::Volume volume) {
  Scenario& scenario = one.scenario;
  scenario.solver.model = model;
  scenario.solver.volume = volume;
  scenario.solver.kinematics = Solver::Kinematics::linear;
  scenario.solver.integrator = Solver::Integrator::central_difference;
  scenario.solver.start = integrate::Start::consistent;
  scenario.solver.time_step.reset();
  scenario.solver.substeps.reset();
  scenario.solver.rings.reset();
  scenario.solver.allow_unstable = true;
  scenario.tissue.viscosity = Viscosity::none;
  scenario.contact.coupling = contact::Coupling::one_way;
  scenario.contact.viscosity = scenario::Contact::Viscosity::none;
  scenario.contact.depth = scenario::Contact::Depth::hertz;
  return one;
}

std::unique_ptr<ProbedBody> make_probed_body(const scenario::Case& one,
                                             const scenario::Family& family,
                                             scene::SpecimenShapes& shapes) {
  auto probed = std::make_unique<ProbedBody>();
  probed->scene = run::build_scene(one, family, shapes);
  const scene::Specimen& specimen = *probed->scene.specimen;
  probed->elastic = std::make_unique<scene::SpringBody>(
      specimen.network, tissue::Kinematics::linear, tissue::ViscousLaw{}, specimen.held);
  probed->highest = highest_mode(*probed->elastic, nullptr);
  return probed;
}

RungOf rung_of(const Scenario& scenario) {
  const Solver& solver = scenario.solver;
  const bool named = solver.model && scenario::rung(*solver.model).meshed();
  const scenario::Rung& rung = named ? scenario::rung(*solver.model) : scenario::strongest;
  return {rung.of, solver.volume.value_or(rung.volume)};
}

Damping damping_of(const scenario::Case& one, Viscosity form) {
  const scenario::Tissue& tissue = one.scenario.tissue;
  const material::Tissue& material = one.materials.tissue;
  Damping damping;
  const auto value = [&](const std::optional<double>& given,
                         const std::optional<material::Sourced>& from, double otherwise) {
    if (given) return *given;
    if (from) return from->value;
    damping.assumed = true;
    return otherwise;
  };
  tissue::ViscousLaw& law = damping.law;
  law.kind = form;
  switch (form) {
    case Viscosity::none: break;
    case Viscosity::nodal_drag: law.drag = value(tissue.drag, material.drag, 100.0); break;
    case Viscosity::kelvin_voigt:
      law.time = value(tissue.retardation_time, material.retardation_time, 0.1);
      break;
    case Viscosity::standard_linear_solid: {
      const double ratio = value(tissue.instantaneous_ratio, material.instantaneous_ratio, 2.0);
      law.branches.push_back(
          {value(tissue.relaxation_time, material.relaxation_time, 0.1), ratio - 1.0});
      break;
    }
    case Viscosity::prony:
      for (const scenario::Branch& branch : tissue.branches)
        law.branches.push_back({branch.relaxation_time, branch.ratio});
  }
  return damping;
}

std::optional<ContactSpring> contact_spring(const ProbedBody& probed) {
  const scene::Scene& scene = probed.scene;
  if (scene.scenario.uniform()) return std::nullopt;
  const scene::Specimen& specimen = *scene.specimen;
  const double depth = scene::deepest_travel(scene.scenario, scene.law());
  contact::Patch patch;
  patch.at = scene::first_touch(scene).at;
  patch.position = specimen.surface->position(patch.at);
  patch.normal = specimen.surface->normal(patch.at);
  patch.axis = patch.normal.unitOrthogonal();
  patch.a = patch.b = contact::hertz::contact_radius(depth, scene.finger.sphere_radius);
  contact::Spread load;
  contact::Spreader(*specimen.surface).spread(patch, load);
  ContactSpring spring;
  spring.stiffness = scene.finger.force_factor *
                     contact::hertz::stiffness(depth, scene.law().radius, scene.law().modulus);
  spring.weights = integrate::Vector::Zero(3 * probed.nodes());
  for (std::size_t j = 0; j < load.vertices.size(); ++j) {
    const int node = specimen.skin[as_index(load.vertices[j])];
    for (int c = 0; c < 3; ++c)
      if (specimen.held[as_index(3 * node + c)] == 0)
        spring.weights[3 * node + c] = -load.shares[j] * patch.normal[c];
  }
  return spring;
}

}  // namespace palpate::stability
