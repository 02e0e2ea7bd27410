// Case to scene: mesh, springs, supports, time steps.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/text.h"
#include "contact/hertz.h"
#include "contact/patch.h"
#include "contact/ring.h"
#include "contact/wide_patch.h"
#include "scenario/integrators.h"
#include "scene/contact_resolution.h"
#include "scene/first_touch.h"
#include "scene/scene.h"
#include "scene/specimen_mesh.h"
#include "scene/specimen_shape.h"
#include "tissue/coupled.h"

namespace palpate::scene {
namespace {

constexpr int most_modal_nodes = 1000;  // an eigen-decomposition grows with the cube

// k sum_j w_j^2 / m_j of the contact at a depth (m), as if one sphere pressed with all of the
// finger's force; and sum_j w_j^2 / m_j alone, 1/kg.
struct PressedNodes {
  double frequency_squared, looseness;
};
PressedNodes contact_frequency_squared(const Scene& scene, double depth, double widest_spacing) {
  const Specimen& specimen = *scene.specimen;
  contact::Spreader spreader(*specimen.surface);
  contact::Spread load;
  contact::Patch patch;
  patch.at = first_touch(scene).at;
  patch.position = specimen.surface->position(patch.at);
  patch.normal = specimen.surface->normal(patch.at);
  patch.axis = patch.normal.unitOrthogonal();
  patch.a = patch.b = contact::hertz::contact_radius(depth, scene.finger.sphere_radius);
  if (widest_spacing > 0.0) patch = contact::wide_patch(patch, {patch.a, patch.b}, widest_spacing);
  spreader.spread(patch, load);
  double sum = 0.0;
  for (std::size_t j = 0; j < load.vertices.size(); ++j)
    sum += load.shares[j] * load.shares[j] /
           specimen.network.node_mass[static_cast<std::size_t>(
               specimen.skin[static_cast<std::size_t>(load.vertices[j])])];
  return {sum * scene.finger.force_factor *
              contact::hertz::stiffness(depth, scene.law().radius, scene.law().modulus),
          sum};
}

// Where the mesh is read back: at the deepest contact of the programme; with inertia the most on
// the way there, because the wide patch narrows as fast as the contact softens.  docs/theory.md
// (76)
ContactRate contact_rate(const Scene& scene) {
  if (scene.scenario.uniform()) return {};
  const double deepest = deepest_travel(scene.scenario, scene.law());
  if (!inertia_reaches_force(scene.scenario)) {
    if (scene.scenario.contact.coupling != contact::Coupling::series) return {};
    return {.squared = contact_frequency_squared(scene, deepest, 0.0).frequency_squared};
  }
  // The mesh softens the contact by up to 0.47 of its compliance at the travel, and where the mesh
  // lags by half the travel the contact itself has 1 / sqrt(1.5) of it: 1 / (0.82 - 0.47). Of the
  // dashpot C = D k^2 the mesh knows a sixth: 0.4^2 by the wide patch's three radii.
  constexpr double stiffened = 3.0;
  constexpr double damped = 1.2;
  const double spacing = contact::RingReader(*scene.specimen->surface)
                             .spacing({.at = first_touch(scene).at, .position = {}, .beyond = {}});
  ContactRate most;
  for (double depth = deepest; depth > 1e-3 * deepest; depth *= 0.5) {
    const auto [squared, looseness] = contact_frequency_squared(scene, depth, spacing);
    most.squared = std::max(most.squared, stiffened * squared);
    most.damping = std::max(most.damping,
                            damped * radiation_compliance(scene) * squared * squared / looseness);
  }
  return most;
}

void refuse_unstable(const Scene& scene, const scenario::Family& family) {
  const scenario::Solver& solver = scene.scenario.solver;
  const TimePlan& plan = scene.specimen->plan;
  if (!scenario::explicit_steps(solver.integrator) || plan.stable() || solver.allow_unstable)
    return;
  const double needed = std::ceil(plan.time_step / (0.9 * plan.limit));
  throw InputError(scenario::place_of(family.document, "solver.substeps"),
                   "`substeps` of " + std::to_string(plan.substeps) + " makes steps of " +
                       rounded_text(1e3 * plan.substep) + " ms, above the stability limit of " +
                       rounded_text(1e3 * plan.limit) + " ms (case " + scene.name +
                       "); set `solver.substeps = \"auto\"` (" + rounded_text(needed) +
                       " here), or `solver.allow_unstable = true` to see it fail");
}

void refuse_large_modal(const Scene& scene, const scenario::Family& family) {
  const int nodes = scene.specimen->network.nodes();
  if (scene.scenario.solver.integrator != scenario::Solver::Integrator::modal ||
      nodes <= most_modal_nodes)
    return;
  throw InputError(scenario::place_of(family.document, "solver.integrator"),
                   "`modal` takes meshes of up to " + std::to_string(most_modal_nodes) +
                       " nodes, this one has " + std::to_string(nodes) +
                       "; use fewer cells or another integrator");
}

// The properties of the tissue and of the scenario's regions, in the order of the mesh's numbers.
std::vector<double> by_region(const scenario::Scenario& scenario,
                              std::optional<double> scenario::Tissue::*of_tissue,
                              std::optional<double> scenario::Substance::*of_region) {
  std::vector<double> values{*(scenario.tissue.*of_tissue)};
  for (const scenario::Region& region : scenario.regions)
    values.push_back(*(scenario::substance(region).*of_region));
  return values;
}

// Elastic, of the tissue and of the regions. Near nu = 1/2 a mesh would have no answer: it takes
// 0.4995 there.
std::vector<tissue::Isotropic> tissues_of(const scenario::Scenario& scenario) {
  const auto moduli =
      by_region(scenario, &scenario::Tissue::young_modulus, &scenario::Substance::young_modulus);
  std::vector<double> ratios{*scenario.tissue.poisson_ratio};
  for (const scenario::Region& region : scenario.regions)
    ratios.push_back(scenario::substance(region).poisson_ratio.value_or(ratios.front()));
  std::vector<tissue::Isotropic> tissues;
  for (std::size_t i = 0; i < moduli.size(); ++i)
    tissues.push_back({moduli[i], std::min(ratios[i], most_poisson_ratio)});
  return tissues;
}

void measure_size(Specimen& specimen) {
  specimen.low = specimen.high = specimen.mesh.nodes.front();
  for (const Vec3& node : specimen.mesh.nodes) {
    specimen.low = specimen.low.cwiseMin(node);
    specimen.high = specimen.high.cwiseMax(node);
  }
}

// What a network of springs makes of one or several tissues.
struct SpringMaker {
  const scenario::Solver* solver;
  const geometry::TetMesh* mesh;
  const tissue::SpringFit* fit;  // where the solver wants it
  std::vector<double> densities;
  bool slabs;  // all regions are layers from side to side

  [[nodiscard]] bool coupled() const {
    return solver->model == scenario::Solver::Model::coupled_springs;
  }
  [[nodiscard]] tissue::Volume volume() const {
    using Volume = scenario::Solver::Volume;
    switch (solver->volume) {
      case Volume::none: return tissue::Volume::none;
      case Volume::tetrahedron: return tissue::Volume::tetrahedron;
      case Volume::nodal: return tissue::Volume::nodal;
      case Volume::automatic: break;
    }
    return coupled() ? tissue::Volume::nodal : tissue::Volume::none;
  }

  // Independent springs first; `factor` is what they are multiplied with before the volume term.
  [[nodiscard]] tissue::Network springs(const std::vector<tissue::Isotropic>& tissues) const {
    std::vector<double> moduli;
    for (const tissue::Isotropic& one : tissues)
      moduli.push_back(volume() == tissue::Volume::none ? one.young_modulus
                                                        : tissue::spring_modulus(one));
    return tissue::make_network(*mesh, densities,
                                fit != nullptr ? tissue::fitted_stiffness(*mesh, *fit, moduli)
                                               : tissue::van_gelder_stiffness(*mesh, moduli));
  }
  void finish(tissue::Network& network, const std::vector<tissue::Isotropic>& tissues,
              double factor) const {
    for (double& stiffness : network.stiffness) stiffness *= factor;
    if (volume() != tissue::Volume::none) tissue::add_volume(network, *mesh, tissues, volume());
  }
  [[nodiscard]] tissue::Network elements(const std::vector<tissue::Isotropic>& tissues) const {
    tissue::Network network = tissue::make_network(
        *mesh, densities, std::vector<double>(geometry::edges(*mesh).size(), 0.0));
    tissue::couple(network, *mesh, tissues, volume(), own_share);
    return network;
  }
};

// Gives the specimen its springs, and says what E and nu they have, were all of it the tissue.
void make_springs(const SpringMaker& maker, const std::vector<tissue::Isotropic>& tissues,
                  const std::function<tissue::Uniaxial(const tissue::Network&)>& measure,
                  Specimen& specimen) {
  const std::vector<tissue::Isotropic> alike(tissues.size(), tissues.front());
  const bool several = std::any_of(tissues.begin(), tissues.end(), [&](const auto& one) {
    return one.young_modulus != tissues.front().young_modulus ||
           one.poisson_ratio != tissues.front().poisson_ratio;
  });
  // Layers from side to side are in the contact's own law.
  const bool beside_law = several && !maker.slabs;
  if (maker.coupled()) {
    specimen.network = maker.elements(tissues);
    if (beside_law) specimen.one_tissue = maker.elements(alike);
    // The linear finite element passes the patch test: its E and nu are the tissue's.
    specimen.measured.young_modulus = tissues.front().young_modulus;
    specimen.measured.poisson_ratio = tissues.front().poisson_ratio;
    return;
  }
  specimen.network = maker.springs(tissues);
  tissue::Network alone = several ? maker.springs(alike) : specimen.network;
  double factor = 1.0;
  if (maker.solver->stiffness == tissue::StiffnessRule::fitted) {
    // The fit makes the neighbourhoods isotropic; one factor more gives the specimen as a whole the
    // modulus that the springs should have under uniaxial load.
    const double wanted = maker.volume() == tissue::Volume::none
                              ? tissues.front().young_modulus
                              : tissue::spring_modulus(tissues.front());
    factor = wanted / measure(alone).young_modulus;
  }
  const tissue::Network bare = alone;
  maker.finish(alone, alike, factor);
  specimen.measured = measure(alone);
  if (maker.solver->stiffness == tissue::StiffnessRule::fitted &&
      maker.volume() != tissue::Volume::none) {
    // With the volume term beside them the springs' factor is found again: the modulus nearly
    // follows it.
    constexpr int rounds = 3;
    for (int i = 0; i < rounds; ++i) {
      factor *= tissues.front().young_modulus / specimen.measured.young_modulus;
      alone = bare;
      maker.finish(alone, alike, factor);
      specimen.measured = measure(alone);
    }
  }
  maker.finish(specimen.network, tissues, factor);
  if (beside_law) specimen.one_tissue = std::move(alone);
}

std::unique_ptr<Specimen> make_specimen(const scenario::Scenario& scenario,
                                        const std::string& folder, SpecimenShapes& shapes) {
  auto specimen = std::make_unique<Specimen>();
  const SpecimenShape& shape = shapes.shape(scenario, folder);
  specimen->mesh = shape.mesh;
  specimen->law = viscous_law(scenario.tissue);
  specimen->kinematics = scenario.solver.kinematics;
  if (scenario.solver.model == scenario::Solver::Model::coupled_springs &&
      specimen->kinematics == tissue::Kinematics::nonlinear)
    specimen->kinematics = tissue::Kinematics::squared;
  specimen->base = base_of(scenario);
  measure_size(*specimen);
  const double top = specimen->high.z();
  const double top_area = shape.top_area;
  specimen->base_height = scenario.tissue.base_height.value_or(
      shape.bottom_area > 0.0 ? 0.0 : 0.1 * specimen->height());
  if (scenario.uniform() && top_area <= 0.0)
    throw MeshError(
        "the specimen has no flat upper end for a platen; `creep` and `relax` need a shape with "
        "flat ends, such as `cuboid` or `ligament`");
  const bool platens =
      scenario.uniform() || std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape);
  const bool fitted = scenario.solver.model == scenario::Solver::Model::mass_spring &&
                      scenario.solver.stiffness == tissue::StiffnessRule::fitted;
  make_springs(
      {&scenario.solver, &specimen->mesh, fitted ? &shapes.fit(scenario, folder) : nullptr,
       by_region(scenario, &scenario::Tissue::density, &scenario::Substance::density),
       all_slabs(scenario)},
      tissues_of(scenario),
      [&](const tissue::Network& network) {
        return platens ? tissue::uniaxial_test(network, specimen->mesh, tissue::Base::frictionless,
                                               top, top_area)
                       : tissue::traction_test(network, specimen->mesh);
      },
      *specimen);
  if (scenario.uniform()) {
    specimen->pressed =
        tissue::uniaxial_test(specimen->network, specimen->mesh, specimen->base, top, top_area);
    specimen->held_between_platens =
        tissue::held_between_platens(specimen->mesh, specimen->base, top);
  }
  specimen->held = tissue::held_by_base(specimen->mesh, specimen->base, specimen->base_height);
  specimen->skin = shape.skin;
  specimen->surface.emplace(shape.surface);
  return specimen;
}

}  // namespace

double Scene::thickness() const {
  if (specimen) return specimen->height();
  const auto shape = parametric(scenario.tissue.shape);
  return shape ? geometry::extent(*shape).z() : std::numeric_limits<double>::infinity();
}

namespace {

void set_layer(Scene& scene, SpecimenShapes& shapes) {
  const contact::Layer layer = layers_of(scene.scenario, 1.0 - scene.finger.compliance_share);
  scene.layer = make_layer(scene.scenario, scene.finger, shapes.layer_law(layer));
  // Pressure maps alone look around the contact.
  if (scene.scenario.output.pressure_maps) scene.layer_sinking = shapes.layer_sinking(layer);
}

}  // namespace

Scene build(const scenario::Case& one, const scenario::Family& family) {
  SpecimenShapes shapes;
  return build(one, family, shapes);
}

Scene build(const scenario::Case& one, const scenario::Family& family, SpecimenShapes& shapes) {
  return build(one, family, shapes, choose(one.scenario));
}

Scene build(const scenario::Case& one, const scenario::Family& family, SpecimenShapes& shapes,
            Choice choice) {
  using Model = scenario::Solver::Model;
  Scene scene;
  scene.name = one.name;
  scene.choice = std::move(choice);
  scene.scenario = scene.choice.chosen;
  const scenario::Scenario& scenario = scene.scenario;
  if (!scenario.uniform()) scene.finger = make_finger(scenario);
  const auto refuse = [&](const char* model, const std::optional<std::string>& reason) {
    if (reason)
      throw InputError(scenario::place_of(family.document, "solver.model"),
                       std::string("`") + model + "` does not know this scene: " + *reason +
                           "; set `solver.model = \"coupled_springs\"`");
  };
  scene.relaxation = contact_relaxation(scenario, scene.finger);
  if (scenario.solver.model == Model::hertz) {
    refuse("hertz", beyond_hertz(scenario));
    if (scenario.contact.depth == scenario::Contact::Depth::neo_hookean) {
      scene.deep = contact::deep_law(*scenario.tissue.poisson_ratio);
      if (!scene.deep)
        throw InputError(scenario::place_of(family.document, "contact.depth"),
                         "`neo_hookean` is known for a Poisson's ratio of 0.27 to 0.5, and the "
                         "tissue's is " +
                             rounded_text(*scenario.tissue.poisson_ratio) +
                             "; write `depth = \"hertz\"`");
    }
    return scene;
  }
  if (scenario.solver.model == Model::layer) {
    refuse("layer", beyond_layer(scenario));
    set_layer(scene, shapes);
    return scene;
  }
  scene.specimen = make_specimen(scenario, family.folder, shapes);
  if (!scenario.uniform() && scenario.contact.coupling == contact::Coupling::consistent &&
      std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape)) {
    set_layer(scene, shapes);
    scene.specimen->sinking =
        shapes.layer_sinking(layers_of(scenario, 1.0, &scene.specimen->measured));
  }
  scene.specimen->plan = plan_time(scenario, *scene.specimen, contact_rate(scene));
  refuse_unstable(scene, family);
  refuse_large_modal(scene, family);
  // A finger that passes beside its specimen is found before the first case runs.
  if (!scenario.uniform()) (void)first_touch(scene);
  refuse_unresolved(scene);
  return scene;
}

}  // namespace palpate::scene
