// Case to scene: mesh, springs, supports, time steps.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/text.h"
#include "base/units.h"
#include "contact/hertz.h"
#include "finger/sphere.h"
#include "geometry/cuboid.h"
#include "geometry/mesh_check.h"
#include "geometry/mesh_files.h"
#include "geometry/tetgen.h"
#include "scene/scene.h"

namespace palpate::scene {
namespace {

constexpr double gravity = 9.80665;     // m/s^2, standard
constexpr double meshing_time = 120.0;  // s, that TetGen may take
constexpr int most_modal_nodes = 1000;  // an eigen-decomposition grows with the cube

geometry::TetMesh make_mesh(const scenario::Scenario& scenario, const std::string& folder) {
  const auto& size = std::get<scenario::Cuboid>(scenario.tissue.shape).size;
  const Vec3 box(size[0], size[1], size[2]);
  geometry::TetMesh mesh;
  std::string name;
  if (const auto* kuhn = std::get_if<scenario::Kuhn>(&scenario.tissue.mesh)) {
    mesh = geometry::cuboid(box, kuhn->cells, geometry::CellPattern::kuhn);
    name = "the kuhn mesh";
  } else if (const auto* mirrored = std::get_if<scenario::Mirrored>(&scenario.tissue.mesh)) {
    mesh = geometry::cuboid(box, mirrored->cells, geometry::CellPattern::mirrored);
    name = "the mirrored mesh";
  } else if (const auto* tetgen = std::get_if<scenario::Tetgen>(&scenario.tissue.mesh)) {
    mesh = geometry::tetgen_cuboid(box, tetgen->nodes, meshing_time);
    name = "TetGen's mesh";
  } else {
    const auto& file = std::get<scenario::MeshFile>(scenario.tissue.mesh);
    const auto path = std::filesystem::path(folder) / file.file;
    mesh = geometry::read_node_ele(path.string(), parse_quantity("1 " + file.unit, unit::mm));
    name = "the mesh of " + file.file;
  }
  geometry::check(mesh, name, box.prod());
  return mesh;
}

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

// k_c sum_j w_j^2 / m_j at the deepest contact of the programme, where the mesh is read back.
double contact_frequency_squared(const Scene& scene) {
  if (scene.scenario.uniform() || scene.scenario.contact.coupling != contact::Coupling::series)
    return 0.0;
  const double depth = deepest_travel(scene.scenario, scene.law);
  const contact::Reading reading =
      make_contact(scene).at(contact::hertz::contact_radius(depth, scene.law.radius));
  double sum = 0.0;
  for (std::size_t j = 0; j < reading.load.nodes.size(); ++j)
    sum += reading.load.shares[j] * reading.load.shares[j] /
           scene.specimen->network.node_mass[static_cast<std::size_t>(reading.load.nodes[j])];
  return sum * contact::hertz::stiffness(depth, scene.law.radius, scene.law.modulus);
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

std::unique_ptr<Specimen> make_specimen(const scenario::Scenario& scenario,
                                        const std::string& folder) {
  auto specimen = std::make_unique<Specimen>();
  specimen->mesh = make_mesh(scenario, folder);
  specimen->law = make_law(scenario.tissue);
  specimen->kinematics = scenario.solver.kinematics;
  specimen->base = make_base(scenario);
  specimen->network =
      tissue::make_network(specimen->mesh, *scenario.tissue.density,
                           tissue::spring_stiffness(scenario.solver.stiffness, specimen->mesh,
                                                    *scenario.tissue.young_modulus));
  specimen->top_height = std::get<scenario::Cuboid>(scenario.tissue.shape).size[2];
  specimen->top.emplace(specimen->mesh, specimen->top_height);
  specimen->top_area = specimen->top->area();
  const auto test = [&](tissue::Base base) {
    return tissue::uniaxial_test(specimen->network, specimen->mesh, base, specimen->top_height,
                                 specimen->top_area);
  };
  specimen->measured = test(tissue::Base::frictionless);
  if (scenario.solver.stiffness == tissue::StiffnessRule::fitted) {
    // The fit makes the neighbourhoods isotropic; one factor more gives the specimen as a whole the
    // tissue's modulus under uniaxial load.
    const double factor = *scenario.tissue.young_modulus / specimen->measured.young_modulus;
    for (double& stiffness : specimen->network.stiffness) stiffness *= factor;
    specimen->measured = test(tissue::Base::frictionless);
  }
  specimen->pressed =
      specimen->base == tissue::Base::frictionless ? specimen->measured : test(specimen->base);
  specimen->held = tissue::held_by_base(specimen->mesh, specimen->base);
  specimen->held_between_platens =
      tissue::held_between_platens(specimen->mesh, specimen->base, specimen->top_height);
  return specimen;
}

}  // namespace

contact::FlatContact make_contact(const Scene& scene) {
  const Specimen& specimen = *scene.specimen;
  const auto& size = std::get<scenario::Cuboid>(scene.scenario.tissue.shape).size;
  const double nu = specimen.measured.poisson_ratio;
  return {*specimen.top, specimen.network.rest, Vec3(0.5 * size[0], 0.5 * size[1], size[2]),
          scene.scenario.contact.coupling, specimen.measured.young_modulus / (1.0 - nu * nu)};
}

Scene build(const scenario::Case& one, const scenario::Family& family) {
  Scene scene;
  scene.name = one.name;
  scene.scenario = one.scenario;
  scene.choice = choose(one.scenario);
  if (!one.scenario.uniform()) {
    const scenario::Finger& asked = one.scenario.finger;
    const bool rigid = asked.material == "rigid";
    finger::Sphere sphere;
    sphere.radius = asked.radius;
    sphere.density = asked.density.value_or(0.0);
    if (!rigid) sphere.elastic = {*asked.young_modulus, *asked.poisson_ratio};
    const contact::Elastic tissue{*one.scenario.tissue.young_modulus,
                                  *one.scenario.tissue.poisson_ratio};
    const double lambda_1 = rigid ? 0.0 : sphere.elastic.compliance();
    const double lambda_2 = tissue.compliance();
    scene.law = {contact::hertz::effective_radius(sphere.radius, 0.0),
                 contact::hertz::effective_modulus(lambda_1, lambda_2)};
    scene.finger_share = lambda_1 / (lambda_1 + lambda_2);
    if (asked.weight == scenario::Finger::Weight::apart)
      scene.finger_weight = sphere.mass() * gravity;
  }
  if (scene.choice.model == scenario::Solver::Model::hertz) return scene;
  scene.specimen = make_specimen(one.scenario, family.folder);
  scene.specimen->plan = plan_time(one.scenario, *scene.specimen, contact_frequency_squared(scene));
  refuse_unstable(scene, family);
  refuse_large_modal(scene, family);
  return scene;
}

}  // namespace palpate::scene
