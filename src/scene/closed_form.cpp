// Laws of a scene without a mesh, some of which scenes with a mesh use too.
#include "scene/scene.h"

#include <algorithm>
#include <utility>

#include "scene/specimen_mesh.h"

namespace palpate::scene {

contact::Relaxation relaxation_of(const tissue::ViscousLaw& law) {
  contact::Relaxation relaxation;
  relaxation.retardation_time = law.time;
  for (const tissue::Branch& branch : law.branches)
    relaxation.branches.push_back({branch.time, branch.ratio});
  return relaxation;
}

contact::Relaxation contact_relaxation(const scenario::Resolved& scenario, const Finger& finger) {
  if (!scenario::viscous_contact(scenario) || scenario.uniform()) return {};
  return contact::behind_finger(relaxation_of(scenario.tissue.law), finger.compliance_share);
}

contact::Layer layers_of(const scenario::Resolved& scenario, double share) {
  const auto& tissue = scenario.tissue;
  contact::Layer layer{.base = tissue.base == tissue::Base::bonded
                                   ? contact::LayerBase::bonded
                                   : contact::LayerBase::frictionless,
                       .share = share};
  layer.poisson_ratio = tissue.poisson_ratio;
  using Layered = std::pair<const scenario::Slab*, const scenario::Resolved::Region*>;
  std::vector<Layered> slabs;
  for (const auto& region : scenario.regions)
    if (const auto* slab = std::get_if<scenario::Slab>(&region.part))
      slabs.emplace_back(slab, &region);
  // The height of a body from a file is not known here: one layer.
  const auto shape = parametric(tissue.shape);
  if (slabs.empty() || !shape) return layer;
  std::sort(slabs.begin(), slabs.end(), [](const Layered& one, const Layered& other) {
    return one.first->top > other.first->top;
  });
  const double height = geometry::extent(*shape).z();
  const double own = tissue.young_modulus / (1.0 + layer.poisson_ratio);
  double reached = slabs.front().first->top;
  for (const auto& [slab, substance] : slabs) {
    if (slab->top < reached)
      layer.below.push_back({(reached - slab->top) / height, 1.0, layer.poisson_ratio});
    const double nu = substance->poisson_ratio;
    layer.below.push_back(
        {(slab->top - slab->bottom) / height, substance->young_modulus / (1.0 + nu) / own, nu});
    reached = slab->bottom;
  }
  if (reached > 0.0) layer.below.push_back({reached / height, 1.0, layer.poisson_ratio});
  return layer;
}

bool all_slabs(const scenario::Resolved& scenario) {
  return std::all_of(scenario.regions.begin(), scenario.regions.end(), [](const auto& region) {
    return std::holds_alternative<scenario::Slab>(region.part);
  });
}

bool several_tissues(const scenario::Resolved& scenario) {
  return std::any_of(scenario.regions.begin(), scenario.regions.end(), [&](const auto& region) {
    return std::holds_alternative<scenario::Lump>(region.part) ||
           region.young_modulus != scenario.tissue.young_modulus ||
           region.poisson_ratio != scenario.tissue.poisson_ratio;
  });
}

contact::LayerContact make_layer(const scenario::Resolved& scenario, const Finger& finger,
                                 contact::LayerLaw law) {
  // With calibration "force" the spheres share the layer law of the single sphere they replace.
  const bool as_one = scenario.finger.calibration == finger::Calibration::force;
  return {.radius = as_one ? finger.whole.radius : finger.sphere_radius,
          .modulus = as_one ? finger.whole.modulus : finger.sphere_modulus,
          .thickness = geometry::extent(*parametric(scenario.tissue.shape)).z(),
          .law = std::move(law)};
}

}  // namespace palpate::scene
