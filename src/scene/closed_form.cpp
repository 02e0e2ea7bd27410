// What a scene without a mesh is made of, and what it shares with one that has a mesh.
#include "scene/scene.h"

#include "scene/specimen_mesh.h"

namespace palpate::scene {

tissue::ViscousLaw viscous_law(const scenario::Tissue& tissue) {
  tissue::ViscousLaw law;
  law.kind = tissue.viscosity;
  // A value is missing only where nothing flows and the material has none.
  switch (tissue.viscosity) {
    case tissue::Viscosity::none: break;
    case tissue::Viscosity::nodal_drag: law.drag = tissue.drag.value_or(0.0); break;
    case tissue::Viscosity::kelvin_voigt: law.time = tissue.retardation_time.value_or(0.0); break;
    case tissue::Viscosity::standard_linear_solid:
      if (tissue.relaxation_time && tissue.instantaneous_ratio)
        law.branches.push_back({*tissue.relaxation_time, *tissue.instantaneous_ratio - 1.0});
      break;
    case tissue::Viscosity::prony:
      for (const scenario::Branch& branch : tissue.branches)
        law.branches.push_back({branch.relaxation_time, branch.ratio});
  }
  return law;
}

tissue::Base base_of(const scenario::Scenario& scenario) {
  using Base = scenario::Tissue::Base;
  if (scenario.tissue.base == Base::automatic)
    return scenario.uniform() ? tissue::Base::frictionless : tissue::Base::bonded;
  return scenario.tissue.base == Base::bonded ? tissue::Base::bonded : tissue::Base::frictionless;
}

contact::Relaxation contact_relaxation(const scenario::Scenario& scenario, const Finger& finger) {
  if (!scenario.viscous_contact() || scenario.uniform()) return {};
  const tissue::ViscousLaw law = viscous_law(scenario.tissue);
  contact::Relaxation relaxation;
  relaxation.retardation_time = law.time;
  for (const tissue::Branch& branch : law.branches)
    relaxation.branches.push_back({branch.time, branch.ratio});
  return contact::behind_finger(relaxation, finger.compliance_share);
}

contact::LayerBase layer_base(const scenario::Scenario& scenario) {
  return base_of(scenario) == tissue::Base::bonded ? contact::LayerBase::bonded
                                                   : contact::LayerBase::frictionless;
}

contact::LayerContact make_layer(const scenario::Scenario& scenario, const Finger& finger) {
  const contact::Layer layer{.poisson_ratio = *scenario.tissue.poisson_ratio,
                             .base = layer_base(scenario),
                             .share = 1.0 - finger.compliance_share};
  // Spheres that press as one keep that one's layer, each a part of its force.
  const bool as_one = scenario.finger.calibration == finger::Calibration::force;
  return {.radius = as_one ? finger.whole.radius : finger.sphere_radius,
          .modulus = as_one ? finger.whole.modulus : finger.sphere_modulus,
          .thickness = geometry::extent(*parametric(scenario.tissue.shape)).z(),
          .law = contact::LayerLaw(layer)};
}

}  // namespace palpate::scene
