// Builds a scene from a case: mesh, springs, supports, time steps.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "contact/hertz.h"
#include "contact/patch.h"
#include "geometry/shapes.h"
#include "scenario/integrators.h"
#include "scenario/programme.h"
#include "scene/first_touch.h"
#include "scene/places.h"
#include "scene/refining_press.h"
#include "scene/scene.h"
#include "scene/specimen_mesh.h"
#include "scene/specimen_shape.h"
#include "tissue/coupled.h"

namespace palpate::scene {
namespace {

constexpr int most_modal_nodes = 1000;  // finding all modes takes time with the cube of nodes

// k sum_j w_j^2 / m_j (1/s^2) of the contact at a depth (m), as if one sphere pressed with the
// whole force, and sum_j w_j^2 / m_j (1/kg); of the wide patch if `widest_spacing` (m) is above 0.
struct PressedNodes {
  double frequency_squared, looseness;
};
PressedNodes contact_frequency_squared(const Scene& scene, double depth, double widest_spacing) {
  const Specimen& specimen = *scene.specimen;
  contact::Spreader spreader(*specimen.surface);
  contact::Spread load;
  contact::Patch patch =
      first_patch(scene, contact::hertz::contact_radius(depth, scene.finger.sphere_radius));
  if (widest_spacing > 0.0) patch = contact::wide_patch(patch, {patch.a, patch.b}, widest_spacing);
  spreader.spread(patch, load);
  double sum = 0.0;
  for (std::size_t j = 0; j < load.vertices.size(); ++j)
    sum += load.shares[j] * load.shares[j] /
           specimen.network.node_mass[as_index(specimen.outer_surface[as_index(load.vertices[j])])];
  return {sum * scene.finger.force_factor *
              contact::hertz::stiffness(depth, scene.law().radius, scene.law().modulus),
          sum};
}

// The rate at the deepest contact of the loading history for `series`. With inertia, the largest
// rate on the way there, because the wide patch narrows as the contact becomes softer
// [contact_limit].
ContactRate contact_rate(const Scene& scene) {
  if (scene.scenario.uniform()) return {};
  const double deepest = deepest_travel(scene.scenario, scene.law());
  if (!inertia_reaches_force(scene.scenario)) {
    if (scene.scenario.contact.coupling != contact::Coupling::series) return {};
    return {.squared = contact_frequency_squared(scene, deepest, 0.0).frequency_squared};
  }
  // The mesh reduces the compliance of the contact by up to 0.47 of its value at the travel, and a
  // contact whose surface lags by half the travel has 1 / sqrt(1.5) (0.82) of that value
  // [contact_limit]. A sixth of the dashpot C = D k^2 acts on the mesh: 0.4^2 from the wide patch's
  // three radii.
  constexpr double stiffened = 3.0;
  constexpr double damped = 1.2;
  const double spacing = contact::SurfaceSpacing(*scene.specimen->surface)
                             .at({.at = first_touch(scene).at, .position = {}, .beyond = {}});
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
  const scenario::Resolved::Solver& solver = scene.scenario.solver;
  const TimePlan& plan = scene.specimen->plan;
  if (plan.stable() || solver.allow_unstable) return;
  const double needed = std::ceil(plan.time_step / (0.9 * *plan.limit));
  throw InputError(place_of(family.document, "solver.substeps"),
                   "`substeps` of " + std::to_string(plan.substeps) + " makes steps of " +
                       rounded_text(1e3 * plan.substep) + " ms, above the stability limit of " +
                       rounded_text(1e3 * *plan.limit) + " ms (case " + scene.name +
                       "); set `solver.substeps = \"auto\"` (" + rounded_text(needed) +
                       " here), or `solver.allow_unstable = true` to see it fail");
}

// Where the force needs the mesh's whole motion, `modal` keeps all modes.
void refuse_large_modal(const Scene& scene, const scenario::Family& family) {
  const int nodes = scene.specimen->network.nodes();
  const scenario::Resolved::Solver& solver = scene.scenario.solver;
  if (solver.integrator != scenario::Solver::Integrator::modal ||
      scenario::lowest_modes_serve(scene.scenario))
    return;
  const std::string why =
      "`modal` keeps all modes with a platen, with `rings`, with `curvature_on = \"deformed\"`, "
      "where the tissue relaxes and the contact does not, and with couplings that read the mesh's "
      "motion";
  if (solver.modes)
    throw InputError(place_of(family.document, "solver.modes"), why + "; remove `modes`");
  if (nodes > most_modal_nodes)
    throw InputError(place_of(family.document, "solver.integrator"),
                     why + ", up to " + std::to_string(most_modal_nodes) +
                         " nodes, and this mesh has " + std::to_string(nodes) +
                         "; use fewer cells or another integrator");
}

// The substances of the tissue and of the scenario's regions, in the order of the mesh's numbers.
std::vector<scenario::Resolved::Substance> substances_of(const scenario::Resolved& scenario) {
  std::vector<scenario::Resolved::Substance> all{scenario.tissue};
  all.insert(all.end(), scenario.regions.begin(), scenario.regions.end());
  return all;
}

std::vector<double> densities_of(const scenario::Resolved& scenario) {
  std::vector<double> densities;
  for (const auto& one : substances_of(scenario)) densities.push_back(one.density);
  return densities;
}

}  // namespace

std::vector<tissue::Isotropic> tissues_of(const scenario::Resolved& scenario) {
  std::vector<tissue::Isotropic> tissues;
  for (const auto& one : substances_of(scenario))
    tissues.push_back({one.young_modulus, std::min(one.poisson_ratio, most_poisson_ratio)});
  return tissues;
}

namespace {

// Makes the network of springs for one or several tissues.
struct SpringMaker {
  const scenario::Resolved* scenario;
  const geometry::TetMesh* mesh;
  const tissue::SpringFit* fit;  // null for `van_gelder` and coupled springs
  std::vector<double> densities;

  [[nodiscard]] bool coupled() const { return scenario::traits(scenario->solver.model).coupled(); }
  [[nodiscard]] tissue::Volume volume() const { return scenario->solver.volume; }

  // Independent springs. finish() then multiplies them by `factor` and adds the volume term.
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

// Sets the specimen's springs and their measured E and nu, those with the tissue everywhere.
void make_springs(const SpringMaker& maker, const std::vector<tissue::Isotropic>& tissues,
                  const std::function<tissue::Uniaxial(const tissue::Network&)>& measure,
                  Specimen& specimen) {
  const std::vector<tissue::Isotropic> alike(tissues.size(), tissues.front());
  const bool several = std::ranges::any_of(tissues, [&](const auto& one) {
    return one.young_modulus != tissues.front().young_modulus ||
           one.poisson_ratio != tissues.front().poisson_ratio;
  });
  if (maker.coupled()) {
    specimen.network = maker.elements(tissues);
    // Linear finite elements pass the patch test: the network's E and nu are those of the tissue.
    specimen.measured.young_modulus = tissues.front().young_modulus;
    specimen.measured.poisson_ratio = tissues.front().poisson_ratio;
    return;
  }
  specimen.network = maker.springs(tissues);
  tissue::Network alone = several ? maker.springs(alike) : specimen.network;
  double factor = 1.0;
  const bool fitted = maker.scenario->solver.stiffness == tissue::StiffnessRule::fitted;
  if (fitted) {
    // The fit makes neighbourhoods isotropic; the factor gives the specimen as a whole the modulus
    // that its springs should have in uniaxial compression [fitted].
    const double wanted = maker.volume() == tissue::Volume::none
                              ? tissues.front().young_modulus
                              : tissue::spring_modulus(tissues.front());
    specimen.measured = measure(alone);
    factor = wanted / specimen.measured.young_modulus;
    if (maker.volume() == tissue::Volume::none) {
      // The stiffness of all springs times a factor changes the modulus by it, and not the ratio.
      specimen.measured.young_modulus = wanted;
      return maker.finish(specimen.network, tissues, factor);
    }
  }
  const tissue::Network bare = alone;
  maker.finish(alone, alike, factor);
  specimen.measured = measure(alone);
  if (fitted) {
    // The volume term changes the modulus, so the factor is corrected; the modulus is nearly
    // proportional to it.
    constexpr int rounds = 3;
    for (int i = 0; i < rounds; ++i) {
      factor *= tissues.front().young_modulus / specimen.measured.young_modulus;
      alone = bare;
      maker.finish(alone, alike, factor);
      specimen.measured = measure(alone);
    }
  }
  maker.finish(specimen.network, tissues, factor);
}

std::unique_ptr<Specimen> make_specimen(const scenario::Resolved& scenario,
                                        const std::string& folder, SpecimenShapes& shapes) {
  auto specimen = std::make_unique<Specimen>();
  const SpecimenShape& shape = shapes.shape(scenario, folder);
  specimen->mesh = shape.mesh;
  specimen->refined = shape.refined;
  const scenario::ModelTraits& traits = scenario::traits(scenario.solver.model);
  specimen->law = scenario.tissue.law;
  if (scenario.solver.kinematics == scenario::Solver::Kinematics::nonlinear)
    specimen->kinematics =
        traits.coupled() ? tissue::Kinematics::squared : tissue::Kinematics::nonlinear;
  specimen->base = scenario.tissue.base;
  const Box box = box_of(specimen->mesh.nodes);
  specimen->low = box.low;
  specimen->high = box.high;
  const double top = specimen->high.z();
  const double top_area = shape.top_area;
  const Vec3& up = scenario.tissue.base_up;
  specimen->base_height = shape.base_level - geometry::reach_along(specimen->mesh.nodes, up).first;
  if (scenario.uniform() && top_area <= 0.0)
    throw MeshError(
        "the specimen has no flat upper end for a platen; `creep`, `relax` and `compress` need a "
        "shape with flat ends, such as `cuboid` or `ligament`");
  const bool platens =
      scenario.uniform() || std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape);
  const bool fitted =
      traits.independent() && scenario.solver.stiffness == tissue::StiffnessRule::fitted;
  make_springs(
      {&scenario, &specimen->mesh, fitted ? &shapes.fit(scenario, folder) : nullptr,
       densities_of(scenario)},
      tissues_of(scenario),
      [&](const tissue::Network& network) {
        return platens ? tissue::uniaxial_test(network, specimen->mesh, tissue::Base::frictionless,
                                               top, top_area)
                       : tissue::traction_test(network, specimen->mesh);
      },
      *specimen);
  if (scenario.uniform()) {
    specimen->pressed = tissue::uniaxial_test(specimen->network, specimen->mesh, specimen->base,
                                              top, top_area, scenario::upper_platen(scenario));
    specimen->held_between_platens = tissue::held_between_platens(
        specimen->mesh, specimen->base, top, scenario::upper_platen(scenario));
  }
  specimen->held = tissue::held_by_base(specimen->mesh, specimen->base, specimen->base_height, up);
  specimen->outer_surface = shape.outer_surface;
  specimen->warning = shape.warning;
  specimen->straightened = shape.straightened;
  specimen->surface.emplace(shape.surface);
  return specimen;
}

}  // namespace

double Scene::thickness() const { return specimen ? specimen->height() : choice.touch.thickness; }

namespace {

constexpr double least_cells = 3.0;

// The places where the finger presses, at most `apart` (m) from each other along slides.
std::vector<Vec3> places(const Scene& scene, double apart) {
  std::vector<Vec3> all{pressed_place(scene)};
  for (const scenario::Step& step : scene.scenario.steps) {
    const auto* slide = std::get_if<scenario::Slide>(&step);
    if (slide == nullptr) continue;
    const Vec3 move = slide->way();
    const Vec3 start = all.back();
    const int pieces = std::max(1, static_cast<int>(std::ceil(slide->by / apart)));
    for (int i = 1; i <= pieces; ++i) all.emplace_back(start + move * i / pieces);
  }
  return all;
}

// The side of a cell within `radius` (m) of a place, seen from above, or else of the nearest cell.
double cell_at(const geometry::Surface& outer_surface, const Vec3& place, double radius) {
  double sum = 0.0;
  int count = 0;
  double nearest = std::numeric_limits<double>::infinity();
  double area_there = 0.0;
  for (std::size_t t = 0; t < outer_surface.triangles.size(); ++t) {
    const Vec3 twice = geometry::twice_area(outer_surface, static_cast<int>(t));
    if (twice.z() <= 0.0) continue;
    Vec3 centre = Vec3::Zero();
    for (const int v : outer_surface.triangles[t])
      centre += outer_surface.vertices[as_index(v)] / 3.0;
    const double distance = (centre - place).head<2>().norm();
    if (distance < nearest) {
      nearest = distance;
      area_there = 0.5 * twice.norm();
    }
    if (distance > radius) continue;
    sum += 0.5 * twice.norm();
    ++count;
  }
  return std::sqrt(2.0 * (count > 0 ? sum / count : area_there));
}

// Fewer cells under the contact than `resolved` needs.
void refuse_unresolved(const Scene& scene) {
  if (scene.scenario.uniform() || scene.scenario.contact.coupling != contact::Coupling::resolved)
    return;
  const double cells = cells_per_contact_radius(scene);
  if (cells >= least_cells) return;
  throw MeshError(
      "`resolved` needs 3 cells along the contact radius, and the mesh has " +
      rounded_text(cells, 2) + " at the largest displacement of " +
      quantity_text(deepest_travel(scene.scenario, scene.law()), unit::mm) +
      "; give `tissue.mesh` more cells or a `grading`, or set `contact.coupling = \"consistent\"`");
}

// The contact of the finger with a flat layer as thick as the specimen.
void set_layer(Scene& scene) {
  const Finger& finger = scene.finger;
  // With calibration "force" the spheres share the layer law of the single sphere they replace.
  const bool as_one = scene.scenario.finger.calibration == finger::Calibration::force;
  scene.layer = {.radius = as_one ? finger.whole.radius : finger.sphere_radius,
                 .modulus = as_one ? finger.whole.modulus : finger.sphere_modulus,
                 .thickness = geometry::extent(*parametric(scene.scenario.tissue.shape)).z(),
                 .law = layer_law(layers_of(scene.scenario, 1.0 - finger.compliance_share))};
}

// The relaxation of the contact's modulus: the tissue's behind an elastic finger [relaxation];
// empty (elastic) if the contact does not include viscosity.
contact::Relaxation contact_relaxation(const Scene& scene) {
  const scenario::Resolved& scenario = scene.scenario;
  if (!scenario::viscous_contact(scenario) || scenario.uniform()) return {};
  const contact::Relaxation tissue = relaxation_of(scenario.tissue.law);
  return tissue.elastic() ? tissue : contact::behind_finger(tissue, finger_share_on_body(scene));
}

void set_depth_ratio(Scene& scene, const scenario::Family& family) {
  using contact::DepthRatio;
  if (scene.scenario.contact.depth != scenario::Contact::Depth::neo_hookean) return;
  scene.depth_ratio = scene.choice.expected.depth_ratio;
  if (!scene.depth_ratio)
    throw InputError(place_of(family.document, "contact.depth"),
                     "`neo_hookean` is known for flat tissue of one kind, at least " +
                         rounded_text(DepthRatio::thinnest) +
                         " finger radii thick and two contact radii from every edge; write `depth "
                         "= \"hertz\"`, or set `solver.model = \"solid\"`");
}

void set_specimen(Scene& scene, const scenario::Family& family, SpecimenShapes& shapes) {
  const scenario::Resolved& scenario = scene.scenario;
  scene.specimen = make_specimen(scenario, family.folder, shapes);
  // Flat layers have an exact law, and the mesh gives the effect of the sides.
  if (!scenario.uniform() && scenario.contact.coupling == contact::Coupling::consistent &&
      std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape) &&
      !scenario.regions.empty() && all_slabs(scenario))
    set_layer(scene);
  scene.specimen->plan = plan_time(scenario, *scene.specimen, contact_rate(scene));
  refuse_unstable(scene, family);
  refuse_large_modal(scene, family);
  // Finds a finger that passes beside its specimen before the first case runs.
  if (!scenario.uniform()) {
    const geometry::SmoothSurface& surface = *scene.specimen->surface;
    refuse_held(scenario, base_level(scenario, surface.surface()),
                surface.position(first_touch(scene).at));
  }
  refuse_unresolved(scene);
}

// Refuses a press that would push its specimen aside: it has no equilibrium.
void refuse_sliding(const Scene& scene, const scenario::Family& family) {
  constexpr double steepest = 3.0;  // degrees; less is the uncertainty of a triangulated surface
  const SurfaceTouch& touch = scene.choice.touch;
  if (scene.scenario.uniform() || scene.scenario.tissue.base != tissue::Base::frictionless ||
      scenario::traits(scene.scenario.solver.model).formula() || !touch.known() ||
      touch.inclination() <= steepest)
    return;
  throw InputError(
      place_of(family.document, "tissue.base"),
      "the finger presses on a surface that is inclined by " +
          rounded_text(touch.inclination(), 2) +
          " degrees, and on a frictionless base nothing keeps the specimen from sliding away; set "
          "`tissue.base = \"bonded\"`, or press where the surface is level");
}

// Refuses a model that cannot compute the scene.
void refuse_beyond(const Scene& scene, const scenario::Family& family, SpecimenShapes& shapes) {
  const scenario::Resolved& scenario = scene.scenario;
  if (scenario.uniform()) return;
  const SurfaceTouch& touch = scene.choice.touch;
  const auto reason = beyond(scenario.solver.model, scenario, touch);
  if (!reason) return;
  if (touch.nowhere) {
    if (std::holds_alternative<scenario::SurfaceFile>(scenario.tissue.shape))
      (void)shapes.surface(scenario, family.folder).must();
    if (!touch.beside.empty()) throw KeyError(touch.beside, *reason);
    throw MeshError(*reason);
  }
  throw InputError(place_of(family.document, "solver.model"),
                   "`" + std::string(scenario::traits(scenario.solver.model).word) +
                       "` cannot compute this scene: " + *reason +
                       "; set `solver.model = \"auto\"`, which takes one that can");
}

}  // namespace

double cells_per_contact_radius(const Scene& scene) {
  const double depth = deepest_travel(scene.scenario, scene.law());
  const double radius = contact::hertz::contact_radius(depth, scene.finger.sphere_radius);
  double widest = 0.0;
  for (const Vec3& place : places(scene, radius))
    widest = std::max(widest, cell_at(scene.specimen->surface->surface(), place, radius));
  return radius / widest;
}

Scene build(const scenario::Case& one, const scenario::Family& family, SpecimenShapes& shapes,
            Choice choice) {
  using scenario::Model;
  Scene scene;
  scene.name = one.name;
  scene.choice = std::move(choice);
  scene.scenario = scene.choice.chosen;
  const scenario::Resolved& scenario = scene.scenario;
  if (!scenario.uniform()) scene.finger = make_finger(scenario);
  scene.relaxation = contact_relaxation(scene);
  refuse_beyond(scene, family, shapes);
  refuse_sliding(scene, family);
  if (!scenario.uniform()) set_depth_ratio(scene, family);
  if (std::holds_alternative<scenario::SurfaceFile>(scenario.tissue.shape))
    scene.of_file = shapes.surface(scenario, family.folder).must();
  refuse_misplaced(scenario, family, shapes);
  switch (scenario.solver.model) {
    case Model::hertz: break;
    case Model::layer: set_layer(scene); break;
    case Model::mass_spring:
    case Model::coupled_springs: set_specimen(scene, family, shapes); break;
    case Model::solid: scene.solid = make_solid_body(scene, family.folder); break;
  }
  if (std::holds_alternative<scenario::AsMeshed>(scenario.tissue.shape)) {
    if (scene.specimen) refuse_outside(scenario, scene.specimen->surface->surface(), family);
    if (scene.solid) refuse_outside(scenario, scene.solid->outer_surface->surface(), family);
  }
  return scene;
}

const Forecast* Choice::forecast(scenario::Model model) const {
  for (const Forecast& forecast : forecasts)
    if (forecast.model == model && forecast.cannot.empty()) return &forecast;
  return nullptr;
}

std::string Choice::shortfall(std::optional<double> mesh_error) const {
  const Forecast* forecast = taken();
  const double error = forecast != nullptr ? forecast->known(mesh_error, forecast->model) : 0.0;
  if (given || !(error > chosen.solver.tolerance)) return "";
  return "no model is expected to be within the tolerance of " +
         percent_text(chosen.solver.tolerance) + ": `" + scenario::traits(forecast->model).word +
         "` comes nearest with " + error_text(error) +
         (chosen.meshed() && !refines(chosen) ? "; a finer `tissue.mesh` may help" : "");
}

Choice given_choice(const scenario::Case& one, scenario::Model model, SpecimenShapes& shapes) {
  Choice choice;
  choice.given = true;
  choice.chosen = scenario::resolve(one, model);
  place_in_scene(choice.chosen, one.folder, shapes);
  if (choice.chosen.uniform()) return choice;
  choice.touch = surface_touch(choice.chosen, one.folder, shapes);
  choice.expected = estimate(choice.chosen, choice.touch);
  return choice;
}

contact::Relaxation relaxation_of(const tissue::ViscousLaw& law) {
  contact::Relaxation relaxation;
  relaxation.retardation_time = law.time;
  for (const tissue::Branch& branch : law.branches)
    relaxation.branches.push_back({branch.time, branch.ratio});
  return relaxation;
}

double finger_share_on_body(const Scene& scene) {
  const double share = scene.finger.compliance_share;
  const Estimates& found = scene.choice.expected;
  if (share <= 0.0 || share >= 1.0 || !std::isfinite(found.size)) return share;
  const scenario::Resolved& scenario = scene.scenario;
  if (!std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape) ||
      found.chi > contact::last_layer_chi(layers_of(scenario, 1.0))) {
    const double stiffer = 1.0 + found.size / (1.0 - share);
    return stiffer > 0.0 ? share * stiffer / (1.0 - share + share * stiffer) : share;
  }
  // The force of tissue that is `softness` times as compliant, over that of a rigid half-space.
  const auto force = [&](double softness) {
    const double compliance = share + softness * (1.0 - share);
    const contact::Layer layer = layers_of(scenario, softness * (1.0 - share) / compliance);
    const contact::LayerResolution resolution =
        contact::layer_resolution(2.0 * found.chi / layer.top(), layer.top());
    return share / compliance * contact::LayerEquation(layer, resolution).force_factor(found.chi);
  };
  const tissue::ViscousLaw& law = scenario.tissue.law;
  const double at_once = law.branches.empty() ? 0.0 : 1.0 / law.instantaneous_ratio();
  const auto share_by = [&](double ratio) {  // of the forces at once and at rest
    return std::clamp(1.0 - (1.0 - 1.0 / ratio) / (1.0 - at_once), 0.0, 1.0);  // but for rounding
  };
  const double ratio = force(at_once) / force(1.0);
  if (!scenario::traits(scenario.solver.model).solid) return share_by(ratio);
  // The ball of the finger, which `solid` computes, is stiffer than a half-space.    [ball]
  const double at_rest = share_by(ratio);
  const double then = at_rest / (at_rest + (1.0 - at_rest) * at_once);
  const double ball = found.ball / share;
  return share_by(ratio * (1.0 + ball * then) / (1.0 + ball * at_rest));
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
  std::ranges::sort(slabs, [](const Layered& one, const Layered& other) {
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
  return std::ranges::all_of(scenario.regions, [](const auto& region) {
    return std::holds_alternative<scenario::Slab>(region.part);
  });
}

bool several_tissues(const scenario::Resolved& scenario) {
  return std::ranges::any_of(scenario.regions, [&](const auto& region) {
    return std::holds_alternative<scenario::Inclusion>(region.part) ||
           region.young_modulus != scenario.tissue.young_modulus ||
           region.poisson_ratio != scenario.tissue.poisson_ratio;
  });
}

namespace {

constexpr double gravity = 9.80665;  // m/s^2, standard

// (2 - nu) / G of one body, 1/Pa.                                      docs/theory.md [cattaneo]
double shear_term(const contact::Elastic& body) {
  return (2.0 - body.poisson_ratio) * 2.0 * (1.0 + body.poisson_ratio) / body.young_modulus;
}

}  // namespace

Finger make_finger(const scenario::Resolved& scenario) {
  const scenario::Resolved::Finger& asked = scenario.finger;
  const contact::Elastic tissue{scenario.tissue.young_modulus, scenario.tissue.poisson_ratio};
  const double lambda_1 = asked.elastic ? asked.elastic->compliance() : 0.0;
  const double lambda_2 = tissue.compliance();
  const double modulus = contact::hertz::effective_modulus(lambda_1, lambda_2);

  Finger finger;
  const double volume = 4.0 / 3.0 * std::numbers::pi * asked.radius * asked.radius * asked.radius;
  if (asked.spheres == 1) {
    finger.sphere_radius = asked.radius;
    finger.centres = {Vec3::Zero()};
  } else {
    const finger::Layer layer =
        finger::pack(geometry::fingertip(volume), asked.density, asked.spheres);
    finger.sphere_radius = layer.radius;
    finger.centres = layer.centres;
  }
  const double factor = finger::modulus_factor(asked.calibration, asked.spheres);
  finger.sphere_modulus = modulus * factor;
  finger.force_factor = factor / finger::modulus_factor(finger::Calibration::force, asked.spheres);
  finger.whole = {asked.radius, modulus};
  finger.compliance_share = lambda_1 / (lambda_1 + lambda_2);
  finger.shear_compliance = shear_term(tissue) + (asked.elastic ? shear_term(*asked.elastic) : 0.0);
  // The calibration scales the tangential stiffness of a sphere like its normal force.
  finger.shear_compliance /= factor;
  if (asked.weight == scenario::PlainFinger::Weight::apart)
    finger.weight = asked.density * volume * gravity;
  return finger;
}

const geometry::SmoothSurface* Scene::outer_surface() const {
  if (specimen) return &*specimen->surface;
  return solid ? solid->outer_surface.get() : nullptr;
}

}  // namespace palpate::scene
