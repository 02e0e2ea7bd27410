// Case to scene: mesh, springs, supports, time steps.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "contact/hertz.h"
#include "contact/patch.h"
#include "scene/first_touch.h"
#include "scene/scene.h"
#include "scene/specimen_mesh.h"

namespace palpate::scene {
namespace {

constexpr int most_modal_nodes = 1000;  // an eigen-decomposition grows with the cube

tissue::ViscousLaw make_law(const scenario::Tissue& tissue) {
  tissue::ViscousLaw law;
  law.kind = tissue.viscosity;
  if (law.kind == tissue::Viscosity::kelvin_voigt) law.time = *tissue.retardation_time;
  if (law.kind == tissue::Viscosity::standard_linear_solid) {
    law.time = *tissue.relaxation_time;
    law.branch = *tissue.instantaneous_ratio - 1.0;
  }
  if (law.kind == tissue::Viscosity::nodal_drag) law.drag = *tissue.drag;
  return law;
}

tissue::Base make_base(const scenario::Scenario& scenario) {
  using Base = scenario::Tissue::Base;
  if (scenario.tissue.base == Base::automatic)
    return scenario.uniform() ? tissue::Base::frictionless : tissue::Base::bonded;
  return scenario.tissue.base == Base::bonded ? tissue::Base::bonded : tissue::Base::frictionless;
}

// k_c sum_j w_j^2 / m_j at the deepest contact of the programme, where the mesh is read back, as if
// one sphere pressed with all of the finger's force.
double contact_frequency_squared(const Scene& scene) {
  if (scene.scenario.uniform() || scene.scenario.contact.coupling != contact::Coupling::series)
    return 0.0;
  const Specimen& specimen = *scene.specimen;
  const double depth = deepest_travel(scene.scenario, scene.law());
  contact::Spreader spreader(*specimen.surface);
  contact::Spread load;
  contact::Patch patch;
  patch.at = first_touch(scene).at;
  patch.position = specimen.surface->position(patch.at);
  patch.normal = specimen.surface->normal(patch.at);
  patch.axis = patch.normal.unitOrthogonal();
  patch.a = patch.b = contact::hertz::contact_radius(depth, scene.finger.sphere_radius);
  spreader.spread(patch, load);
  double sum = 0.0;
  for (std::size_t j = 0; j < load.vertices.size(); ++j)
    sum += load.shares[j] * load.shares[j] /
           specimen.network.node_mass[static_cast<std::size_t>(
               specimen.skin[static_cast<std::size_t>(load.vertices[j])])];
  return sum * scene.finger.force_factor *
         contact::hertz::stiffness(depth, scene.law().radius, scene.law().modulus);
}

void refuse_unstable(const Scene& scene, const scenario::Family& family) {
  const scenario::Solver& solver = scene.scenario.solver;
  const TimePlan& plan = scene.specimen->plan;
  if (solver.integrator != scenario::Solver::Integrator::central_difference || plan.stable() ||
      solver.allow_unstable)
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

// The area of the skin's triangles that lie in the plane at height `z`, m^2.
double flat_area(const geometry::Skin& skin, double z, double tolerance) {
  double sum = 0.0;
  for (std::size_t t = 0; t < skin.surface.triangles.size(); ++t) {
    bool inside = true;
    for (const int v : skin.surface.triangles[t])
      inside = inside &&
               std::abs(skin.surface.vertices[static_cast<std::size_t>(v)].z() - z) <= tolerance;
    if (inside) sum += 0.5 * geometry::twice_area(skin.surface, static_cast<int>(t)).norm();
  }
  return sum;
}

void measure_size(Specimen& specimen) {
  specimen.low = specimen.high = specimen.mesh.nodes.front();
  for (const Vec3& node : specimen.mesh.nodes) {
    specimen.low = specimen.low.cwiseMin(node);
    specimen.high = specimen.high.cwiseMax(node);
  }
}

std::unique_ptr<Specimen> make_specimen(const scenario::Scenario& scenario,
                                        const std::string& folder) {
  auto specimen = std::make_unique<Specimen>();
  specimen->mesh = specimen_mesh(scenario, folder);
  specimen->law = make_law(scenario.tissue);
  specimen->kinematics = scenario.solver.kinematics;
  specimen->base = make_base(scenario);
  measure_size(*specimen);
  const std::vector<double> moduli =
      by_region(scenario, &scenario::Tissue::young_modulus, &scenario::Substance::young_modulus);
  const std::vector<double> densities =
      by_region(scenario, &scenario::Tissue::density, &scenario::Substance::density);
  const tissue::StiffnessRule rule = scenario.solver.stiffness;
  specimen->network = tissue::make_network(specimen->mesh, densities,
                                           tissue::spring_stiffness(rule, specimen->mesh, moduli));
  geometry::Skin skin = geometry::skin(specimen->mesh);
  const double top = specimen->high.z();
  const double flat = 1e-9 * geometry::diagonal(specimen->mesh);
  const double top_area = flat_area(skin, top, flat);
  specimen->base_height = scenario.tissue.base_height.value_or(
      flat_area(skin, specimen->low.z(), flat) > 0.0 ? 0.0 : 0.1 * specimen->height());
  if (scenario.uniform() && top_area <= 0.0)
    throw MeshError(
        "the specimen has no flat upper end for a platen; `creep` and `relax` need a shape with "
        "flat ends, such as `cuboid` or `ligament`");
  // What the springs make of the tissue's modulus is asked of a specimen of that tissue alone.
  tissue::Network alone = specimen->network;
  if (moduli.size() > 1)
    alone.stiffness = tissue::spring_stiffness(rule, specimen->mesh,
                                               std::vector<double>(moduli.size(), moduli.front()));
  const bool platens =
      scenario.uniform() || std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape);
  const auto measure = [&] {
    return platens ? tissue::uniaxial_test(alone, specimen->mesh, tissue::Base::frictionless, top,
                                           top_area)
                   : tissue::traction_test(alone, specimen->mesh);
  };
  specimen->measured = measure();
  if (rule == tissue::StiffnessRule::fitted) {
    // The fit makes the neighbourhoods isotropic; one factor more gives the specimen as a whole the
    // tissue's modulus under uniaxial load.
    const double factor = moduli.front() / specimen->measured.young_modulus;
    for (double& stiffness : alone.stiffness) stiffness *= factor;
    for (double& stiffness : specimen->network.stiffness) stiffness *= factor;
    specimen->measured = measure();
  }
  if (moduli.size() > 1) specimen->one_tissue = std::move(alone.stiffness);
  if (scenario.uniform()) {
    specimen->pressed =
        tissue::uniaxial_test(specimen->network, specimen->mesh, specimen->base, top, top_area);
    specimen->held_between_platens =
        tissue::held_between_platens(specimen->mesh, specimen->base, top);
  }
  specimen->held = tissue::held_by_base(specimen->mesh, specimen->base, specimen->base_height);
  specimen->skin = skin.nodes;
  specimen->surface.emplace(std::move(skin.surface));
  return specimen;
}

}  // namespace

double Scene::thickness() const {
  if (specimen) return specimen->height();
  const auto shape = parametric(scenario.tissue.shape);
  return shape ? geometry::extent(*shape).z() : std::numeric_limits<double>::infinity();
}

Scene build(const scenario::Case& one, const scenario::Family& family) {
  Scene scene;
  scene.name = one.name;
  scene.scenario = one.scenario;
  scene.choice = choose(one.scenario);
  if (!one.scenario.uniform()) scene.finger = make_finger(one.scenario);
  if (scene.choice.model == scenario::Solver::Model::hertz) {
    if (const auto reason = beyond_hertz(one.scenario))
      throw InputError(scenario::place_of(family.document, "solver.model"),
                       "`hertz` does not know this scene: " + *reason +
                           "; set `solver.model = \"mass_spring\"`");
    return scene;
  }
  scene.specimen = make_specimen(one.scenario, family.folder);
  scene.specimen->plan = plan_time(one.scenario, *scene.specimen, contact_frequency_squared(scene));
  refuse_unstable(scene, family);
  refuse_large_modal(scene, family);
  // A finger that passes beside its specimen is found before the first case runs.
  if (!one.scenario.uniform()) (void)first_touch(scene);
  return scene;
}

}  // namespace palpate::scene
