// What a scene without a mesh is made of, and what it shares with one that has a mesh.
#include "scene/scene.h"

#include <algorithm>
#include <utility>

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

contact::Layer layers_of(const scenario::Scenario& scenario, double share,
                         const tissue::Uniaxial* network) {
  const auto& tissue = scenario.tissue;
  contact::Layer layer{.base = layer_base(scenario), .share = share};
  // Without a volume term springs have one Poisson's ratio, whatever the tissue's.
  const bool springs_alone = network != nullptr &&
                             scenario.solver.model == scenario::Solver::Model::mass_spring &&
                             (scenario.solver.volume == scenario::Solver::Volume::none ||
                              scenario.solver.volume == scenario::Solver::Volume::automatic);
  layer.poisson_ratio =
      network != nullptr ? std::min(0.5, network->poisson_ratio) : *tissue.poisson_ratio;
  std::vector<const scenario::Slab*> slabs;
  for (const scenario::Region& region : scenario.regions)
    if (const auto* slab = std::get_if<scenario::Slab>(&region)) slabs.push_back(slab);
  if (slabs.empty()) return layer;
  std::sort(slabs.begin(), slabs.end(),
            [](const auto* one, const auto* other) { return one->top > other->top; });
  const double height = geometry::extent(*parametric(tissue.shape)).z();
  const double own = *tissue.young_modulus / (1.0 + layer.poisson_ratio);
  double reached = slabs.front()->top;
  for (const scenario::Slab* slab : slabs) {
    if (slab->top < reached)
      layer.below.push_back({(reached - slab->top) / height, 1.0, layer.poisson_ratio});
    const double nu = springs_alone ? layer.poisson_ratio
                                    : slab->substance.poisson_ratio.value_or(*tissue.poisson_ratio);
    layer.below.push_back({(slab->top - slab->bottom) / height,
                           *slab->substance.young_modulus / (1.0 + nu) / own, nu});
    reached = slab->bottom;
  }
  if (reached > 0.0) layer.below.push_back({reached / height, 1.0, layer.poisson_ratio});
  return layer;
}

bool all_slabs(const scenario::Scenario& scenario) {
  return std::all_of(scenario.regions.begin(), scenario.regions.end(), [](const auto& region) {
    return std::holds_alternative<scenario::Slab>(region);
  });
}

contact::LayerContact make_layer(const scenario::Scenario& scenario, const Finger& finger,
                                 contact::LayerLaw law) {
  // Spheres that press as one keep that one's layer, each a part of its force.
  const bool as_one = scenario.finger.calibration == finger::Calibration::force;
  return {.radius = as_one ? finger.whole.radius : finger.sphere_radius,
          .modulus = as_one ? finger.whole.modulus : finger.sphere_modulus,
          .thickness = geometry::extent(*parametric(scenario.tissue.shape)).z(),
          .law = std::move(law)};
}

}  // namespace palpate::scene
