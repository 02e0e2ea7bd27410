// Resolves a scenario and its materials into plain values.
#include "scenario/resolved.h"

#include <utility>

#include "base/text.h"
#include "base/units.h"

namespace palpate::scenario {

bool asks_for_steps(const Solver& solver) {
  return solver.substeps || solver.allow_unstable || solver.start != PlainSolver{}.start ||
         solver.damping != PlainSolver{}.damping;
}

namespace {

void fill(std::optional<double>& value, const std::optional<material::Sourced>& from) {
  if (!value && from) value = from->value;
}

// Whether the model uses the Poisson's ratios of regions; springs without a volume term do not.
bool honours_ratios(const Solver& solver) {
  return !solver.model || !traits(*solver.model).independent() ||
         solver.volume.value_or(Solver::Volume::none) != Solver::Volume::none;
}

// A value is missing only if viscosity is not computed and the material has none.
tissue::ViscousLaw viscous_law(const Tissue& tissue) {
  tissue::ViscousLaw law;
  law.kind = tissue.viscosity;
  switch (tissue.viscosity) {
    case tissue::Viscosity::none: break;
    case tissue::Viscosity::nodal_drag: law.drag = tissue.drag.value_or(0.0); break;
    case tissue::Viscosity::kelvin_voigt: law.time = tissue.retardation_time.value_or(0.0); break;
    case tissue::Viscosity::standard_linear_solid:
      if (tissue.relaxation_time && tissue.instantaneous_ratio)
        law.branches.push_back({*tissue.relaxation_time, *tissue.instantaneous_ratio - 1.0});
      break;
    case tissue::Viscosity::prony:
      for (const Branch& branch : tissue.branches)
        law.branches.push_back({branch.relaxation_time, branch.ratio});
  }
  return law;
}

Resolved::Contact resolve_contact(const Scenario& asked, const Found& found) {
  using Viscosity = Contact::Viscosity;
  const Contact& contact = asked.contact;
  const bool linear = asked.solver.kinematics == Solver::Kinematics::linear;
  return {contact,
          found.viscosity_matters ? contact.viscosity.value_or(Viscosity::none) : Viscosity::none,
          contact.depth.value_or(found.depth_matters ? Contact::Depth::neo_hookean
                                                     : Contact::Depth::hertz),
          contact.direction.value_or(linear ? Contact::Direction::surface
                                            : Contact::Direction::sphere)};
}

// Whether the mesh's motion cannot reach the force of a press, whatever the integrator, so that it
// is computed for pictures alone.
bool motion_is_for_show(const Scenario& asked) {
  const Solver& solver = asked.solver;
  if (solver.kinematics != Solver::Kinematics::linear || solver.rings || asks_for_steps(solver))
    return false;
  return asked.contact.coupling == contact::Coupling::one_way ||
         (asked.contact.coupling == contact::Coupling::consistent &&
          asked.tissue.viscosity == tissue::Viscosity::kelvin_voigt);
}

Resolved::Solver resolve_solver(const Scenario& asked, const ModelTraits& traits,
                                const Found& found) {
  using Integrator = Solver::Integrator;
  const bool drag = asked.tissue.viscosity == tissue::Viscosity::nodal_drag;
  // A uniform test is its law of time; inertia comes with an integrator that is named.
  const bool law_alone = asked.uniform() ? !asks_for_steps(asked.solver)
                                         : !found.inertia_matters || motion_is_for_show(asked);
  const bool still = traits.meshed() && (asked.contact.coupling == contact::Coupling::resolved ||
                                         (!drag && law_alone));
  return {asked.solver, traits.of, asked.solver.volume.value_or(traits.volume),
          asked.solver.integrator.value_or(still ? Integrator::quasi_static
                                                 : Integrator::central_difference)};
}

// Whether a region's material has another law of time than the tissue. A region that gives a
// modulus of its own and no material has none.
bool relaxes_otherwise(const Region& region, const material::Tissue& own, const Tissue& tissue) {
  if (region.young_modulus && region.material == Region{}.material) return false;
  const auto other = [](const std::optional<material::Sourced>& value,
                        const std::optional<double>& used) {
    return used && !(value && value->value == *used);
  };
  switch (tissue.viscosity) {
    case tissue::Viscosity::kelvin_voigt:
      return other(own.retardation_time, tissue.retardation_time);
    case tissue::Viscosity::standard_linear_solid:
      return other(own.relaxation_time, tissue.relaxation_time) ||
             other(own.instantaneous_ratio, tissue.instantaneous_ratio);
    case tissue::Viscosity::none:
    case tissue::Viscosity::nodal_drag:
    case tissue::Viscosity::prony: break;
  }
  return false;
}

}  // namespace

Scenario filled(const Case& one) {
  Scenario all = one.scenario;
  const material::Tissue& material = one.materials.tissue;
  fill(all.tissue.density, material.density);
  fill(all.tissue.young_modulus, material.young_modulus);
  fill(all.tissue.poisson_ratio, material.poisson_ratio);
  switch (all.tissue.viscosity) {
    case tissue::Viscosity::nodal_drag: fill(all.tissue.drag, material.drag); break;
    case tissue::Viscosity::kelvin_voigt:
      fill(all.tissue.retardation_time, material.retardation_time);
      break;
    case tissue::Viscosity::standard_linear_solid:
      fill(all.tissue.relaxation_time, material.relaxation_time);
      fill(all.tissue.instantaneous_ratio, material.instantaneous_ratio);
      break;
    case tissue::Viscosity::none:
    case tissue::Viscosity::prony: break;
  }
  for (std::size_t i = 0; i < all.regions.size(); ++i) {
    const material::Tissue& other = one.materials.regions[i];
    fill(all.regions[i].density, other.density);
    fill(all.regions[i].young_modulus, other.young_modulus);
    if (honours_ratios(all.solver)) fill(all.regions[i].poisson_ratio, other.poisson_ratio);
  }
  if (const auto& rubber = one.materials.finger) {
    fill(all.finger.density, rubber->density);
    if (all.finger.rigid()) return all;
    fill(all.finger.young_modulus, rubber->young_modulus);
    fill(all.finger.poisson_ratio, rubber->poisson_ratio);
  }
  return all;
}

Resolved resolve(const Case& one, Model model, const Found& found) {
  const Scenario all = filled(one);
  const Tissue& tissue = all.tissue;
  const auto base = all.uniform() ? tissue::Base::frictionless : tissue::Base::bonded;
  Resolved resolved{all,
                    {tissue,
                     {*tissue.density, *tissue.young_modulus, *tissue.poisson_ratio},
                     viscous_law(tissue),
                     tissue.base.value_or(base)},
                    {},
                    {all.finger, all.finger.density.value_or(0.0), {}},
                    resolve_contact(all, found),
                    resolve_solver(all, traits(model), found)};
  for (std::size_t i = 0; i < all.regions.size(); ++i) {
    const Region& region = all.regions[i];
    resolved.regions.push_back(
        {region,
         {*region.density, *region.young_modulus,
          region.poisson_ratio.value_or(*tissue.poisson_ratio)},
         relaxes_otherwise(one.scenario.regions[i], one.materials.regions[i], tissue)});
  }
  if (all.finger.young_modulus && all.finger.poisson_ratio && !all.finger.rigid())
    resolved.finger.elastic = {*all.finger.young_modulus, *all.finger.poisson_ratio};
  // A lower modulus of their contacts lets several spheres stand for one. Bodies in a mesh have no
  // such modulus, and the one presses.
  if (traits(model).solid && all.finger.spheres > 1 &&
      all.finger.calibration == finger::Calibration::force)
    resolved.finger.replaced = std::exchange(resolved.finger.spheres, 1);
  return resolved;
}

Scenario answered(const Case& one, const Resolved& resolved) {
  Scenario all = filled(one);
  all.solver.model = resolved.solver.model;
  all.solver.integrator = resolved.solver.integrator;
  all.contact.viscosity = resolved.contact.viscosity;
  all.contact.depth = resolved.contact.depth;
  return all;
}

std::string viscosity_text(const Resolved::Tissue& tissue) {
  using tissue::Viscosity;
  switch (tissue.viscosity) {
    case Viscosity::none: break;
    case Viscosity::nodal_drag:
      return "nodal drag, d/m " + quantity_text(tissue.law.drag, unit::per_second);
    case Viscosity::kelvin_voigt:
      return "Kelvin-Voigt, retardation time " + quantity_text(tissue.law.time, unit::s);
    case Viscosity::standard_linear_solid:
      return "standard linear solid, relaxation time " +
             quantity_text(tissue.law.longest_time(), unit::s) + ", E_0 / E_inf " +
             number_text(tissue.law.instantaneous_ratio());
    case Viscosity::prony: {
      std::string text = "Prony series, relaxation";
      for (const Branch& branch : tissue.branches)
        text += (&branch == tissue.branches.data() ? " time " : "; time ") +
                quantity_text(branch.relaxation_time, unit::s) + ", ratio " +
                number_text(branch.ratio);
      return text;
    }
  }
  return "none";
}

}  // namespace palpate::scenario
