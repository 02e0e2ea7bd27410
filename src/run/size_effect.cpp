// Presses a coarse mesh of the body, and the formula in the same place.
#include "run/size_effect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/numerics.h"
#include "base/symmetric_solver.h"
#include "base/text.h"
#include "mechanics/pressed_mesh.h"
#include "meshing/tetgen_body.h"
#include "scenario/programme.h"
#include "scene/first_touch.h"
#include "scene/refining_press.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"
#include "tissue/network.h"

namespace palpate::run {
namespace {

constexpr int coarse_nodes = 150;

// Ratios at which bodies are pressed; between them the change is interpolated.
constexpr std::array ratios{0.0, 0.25, 0.4, 0.47, scene::most_poisson_ratio};

scenario::Mesh coarse(const scenario::Resolved& scenario, const scene::SurfaceTouch& touch) {
  if (std::holds_alternative<scenario::MeshFile>(scenario.tissue.mesh)) {
    scenario::Mesh mesh = scenario.tissue.mesh;
    scenario::refinement(mesh).refine = false;
    return mesh;
  }
  const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape);
  if (box == nullptr || !scenario.regions.empty()) {
    scenario::Tetgen mesh;
    mesh.nodes = coarse_nodes;
    return mesh;
  }
  scenario::Mirrored mesh;
  const double cell = std::cbrt(box->size[0] * box->size[1] * box->size[2] / coarse_nodes);
  for (std::size_t axis = 0; axis < 3; ++axis)
    mesh.cells[axis] = std::clamp(static_cast<int>(std::lround(box->size[axis] / cell)), 2, 20);
  // Cells about as long as the way to the nearest boundary under the finger.
  const double near = std::min(touch.to_edge, touch.thickness);
  const double wide = *std::ranges::max_element(box->size);
  mesh.grading = std::clamp(wide / (2.0 * near), 1.0, 30.0);
  if (mesh.grading > 1.5) mesh.cells = {6, 6, 5};
  return mesh;
}

// The trial: a rigid finger at a travel that is rounded up to a power of sqrt(2).
scenario::Resolved trial_of(const scenario::Resolved& scenario, const scene::SurfaceTouch& touch,
                            double ratio) {
  scenario::Resolved trial = scene::refining_press(scenario);
  trial.tissue.mesh = coarse(scenario, touch);
  trial.tissue.poisson_ratio = ratio;
  if (!each_presses(scenario)) trial.finger.spheres = 1;
  const contact::CurvatureLaw law = trial.contact.law;
  trial.contact = {};
  trial.contact.law = law;
  // On a flat the finger is pressed where it comes nearest to a side.
  if (const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape)) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [x, y] : scenario::finger_places(scenario, *box)) {
      const double side = std::min({x, box->size[0] - x, y, box->size[1] - y});
      if (side >= nearest) continue;
      nearest = side;
      trial.finger.x = x;
      trial.finger.y = y;
    }
    trial.steps.resize(1);
  }
  auto& indent = std::get<scenario::Indent>(trial.steps.front());
  const double radius = trial.finger.radius;
  indent.to = {radius * std::exp2(std::ceil(2.0 * std::log2(indent.to.value / radius)) / 2.0),
               false};
  return trial;
}

// All that the press depends on.
std::string key_of(const scenario::Resolved& trial, const scene::SurfaceTouch& touch) {
  std::string key = scene::shape_key(trial) + scene::refining_key(trial);
  for (const double number :
       {touch.curvature.kappa_1, touch.curvature.kappa_2, touch.curvature.normal.x(),
        touch.curvature.normal.y(), static_cast<double>(trial.contact.law)})
    key += " " + number_text(number);
  return key;
}

// The force of the formula, N, with the curvature of a flat where none is known; 0 where it has
// none.
double formula(const scene::Scene& scene, const scene::SurfaceTouch& touch, double travel) {
  const auto law = contact::contact_law(scene.scenario.contact.law,
                                        {scene.finger.sphere_radius, scene.finger.sphere_modulus},
                                        touch.curvature, scene.layer ? &*scene.layer : nullptr);
  if (!law) return 0.0;
  const auto [depth, normal] = touch.pressed(scene.finger.sphere_radius, travel);
  if (depth > law->point.last_depth()) return 0.0;
  return static_cast<double>(scene.finger.centres.size()) * normal.z() * law->point.force(depth);
}

// The depth of the contact over the displacement where the force is 1 + change times that of the
// formula, which goes with the power 3/2 of the depth.
double depth_share(double change) { return std::pow(1.0 + change, 2.0 / 3.0); }

// The volume with the kinetic energy of the body where what it yields beyond the formula changes at
// unit speed, m^3; 0 where it is stiffer, and where spheres dent it for each other.
double moving_volume(const integrate::Vector& moved, double yields, const scene::Scene& scene) {
  const std::vector<double>& masses = scene.specimen->network.node_mass;
  double sum = 0.0;
  for (std::size_t n = 0; n < masses.size(); ++n)
    sum += masses[n] * moved.segment<3>(3 * static_cast<Eigen::Index>(n)).squaredNorm();
  return sum / (scene.scenario.tissue.density * yields * yields);
}

// By how much of what it yields the body is behind its static displacement under a force that grows
// evenly, when a wave of the speed sqrt(E/rho) has gone `way` (m) since its beginning. A mode of
// the frequency w is behind by sin(w T)/(w T), for which 1/(1 + (w T/4)^2) stands: one solution
// with the inertia of T/4 has all modes. At 1 nothing has moved.
double lag(const integrate::Vector& moved, double work, double way, const scene::Scene& scene) {
  constexpr double part = 1.0 / 4.0;
  constexpr double missed = 0.0125;  // the largest difference of both, from w T = 14 on
  constexpr double tolerance = 1e-4;
  const scene::Specimen& specimen = *scene.specimen;
  const scenario::Resolved::Tissue& tissue = scene.scenario.tissue;
  BlockMatrix matrix = tissue::stiffness_matrix(specimen.network);
  integrate::Vector push = matrix * moved;
  integrate::Vector inertia(push.size());                                               // N/m
  const double rate = std::sqrt(tissue.young_modulus / tissue.density) / (part * way);  // 1/s
  for (Eigen::Index d = 0; d < push.size(); ++d) {
    if (specimen.held[as_index(d)] != 0) push[d] = 0.0;
    inertia[d] = rate * rate * specimen.network.node_mass[as_index(d / 3)];
  }
  matrix.add_to_diagonal(inertia);
  SymmetricSolver solver(tolerance);
  if (!solver.prepare(std::move(matrix), specimen.held)) return 1.0;
  const std::vector<integrate::Vector> right{push};
  std::vector<integrate::Vector> slower(1);
  if (!solver.solve(right, slower)) return 1.0;
  return std::clamp(push.dot(moved - slower.front()) / work + missed, 0.0, 1.0);
}

SizeEffect press(const scenario::Resolved& trial, double way, const std::string& folder,
                 const scene::SurfaceTouch& touch, scene::SpecimenShapes& shapes) {
  scenario::Family family;
  family.folder = folder;
  scene::Choice choice;
  choice.given = true;
  choice.chosen = trial;
  choice.touch = touch;
  const scene::Scene scene = scene::build({}, family, shapes, choice);
  mechanics::PressedMesh mesh(scene);
  mechanics::Touch pressed;
  const Vec3 first = scene::first_touch(scene).finger;
  SizeEffect found;
  for (const Vec3& place : finger_way(trial)) {
    // On a coarse mesh the contact may have no solution at the full depth.
    const double deepest = scene::deepest_travel(trial, scene.law());
    for (double travel = deepest; travel > 0.1 * deepest; travel *= 0.5) {
      if (mesh.try_out(first + place - travel * Vec3::UnitZ(), pressed)) continue;
      const mechanics::SphereContact* contact = pressed.deepest();
      if (contact == nullptr) continue;
      const double simple = formula(scene, touch, travel);
      const double softer = simple > 0.0 ? pressed.normal_force() / simple - 1.0 : 0.0;
      const double change = touch.known() ? softer : 0.0;
      if (found.nodes == 0 || std::abs(change) > std::abs(found.change)) found.change = change;
      if (found.nodes == 0 || std::abs(softer) > std::abs(found.softer)) found.softer = softer;
      found.error = std::max(found.error, mechanics::mesh_error(*contact));
      const double indented = touch.pressed(scene.finger.sphere_radius, travel).depth;
      const double yields = (1.0 - depth_share(softer)) * indented;
      mesh.set_step(1.0);
      if (yields > 0.0 && !each_presses(scene.scenario) && !mesh.move(pressed)) {
        const integrate::Vector moved = mesh.displacement();
        found.moving = std::max(found.moving, moving_volume(moved, yields, scene));
        found.lag = std::max(found.lag, lag(moved, pressed.pressed() * yields, way, scene));
      }
      found.nodes = scene.specimen->network.nodes();
      break;
    }
  }
  return found;
}

// The surface of a body of several parts may have more nodes than a coarse mesh.
SizeEffect coarsest_press(scenario::Resolved trial, double way, const std::string& folder,
                          const scene::SurfaceTouch& touch, scene::SpecimenShapes& shapes) {
  constexpr int most_nodes = 8 * coarse_nodes;
  for (;;) {
    auto* mesh = std::get_if<scenario::Tetgen>(&trial.tissue.mesh);
    try {
      return press(trial, way, folder, touch, shapes);
    } catch (const meshing::Needles&) {
      throw;
    } catch (const MeshError&) {
      if (mesh == nullptr || mesh->nodes >= most_nodes) throw;
      mesh->nodes *= 2;
    }
  }
}

}  // namespace

bool each_presses(const scenario::Resolved& scenario) {
  return scenario.finger.spheres > 1 && scenario.finger.calibration == finger::Calibration::mass;
}

std::vector<Vec3> finger_way(const scenario::Resolved& scenario) {
  std::vector<Vec3> found{Vec3::Zero()};
  for (const scenario::Step& step : scenario.steps)
    if (const auto* slide = std::get_if<scenario::Slide>(&step)) {
      const Vec3 way = slide->way();
      const Vec3 start = found.back();
      found.emplace_back(start + 0.5 * way);
      found.emplace_back(start + way);
    }
  return found;
}

SizeEffect size_effect(const scenario::Resolved& scenario, const std::string& folder,
                       const scene::SurfaceTouch& touch, double seconds,
                       scene::SpecimenShapes& shapes) {
  const double wanted = scene::deepest_travel(scenario, scene::make_finger(scenario).whole);
  if (!(wanted > 0.0)) return {};
  const double ratio = std::min(scenario.tissue.poisson_ratio, ratios.back());
  // Of a wave while the finger moves, m. Rounded down, so that like presses share it.
  const double speed = std::sqrt(scenario.tissue.young_modulus / scenario.tissue.density);
  const double way = std::isfinite(seconds)
                         ? std::exp2(std::floor(2.0 * std::log2(seconds * speed)) / 2.0)
                         : seconds;
  const auto above = std::lower_bound(ratios.begin() + 1, ratios.end(), ratio);
  const double share = (ratio - *(above - 1)) / (*above - *(above - 1));
  const auto at = [&](double known) {
    const scenario::Resolved trial = trial_of(scenario, touch, known);
    const auto& numbers = shapes.kept_numbers(
        key_of(trial, touch) + " " + number_text(way), [&]() -> scene::SpecimenShapes::Numbers {
          const SizeEffect found = coarsest_press(trial, way, folder, touch, shapes);
          return {found.change, found.error, found.softer,
                  found.moving, found.lag,   static_cast<double>(found.nodes)};
        });
    // Effects of size grow with the radius of the contact.
    const double narrower =
        std::sqrt(wanted / std::get<scenario::Indent>(trial.steps.front()).to.value);
    // What the body yields over the depth of the contact; a change cannot reach -1.
    const double yields = narrower * (1.0 / depth_share(numbers[2]) - 1.0);
    return SizeEffect{narrower * numbers[0],
                      narrower * numbers[1],
                      1.0 / ((1.0 + yields) * std::sqrt(1.0 + yields)) - 1.0,
                      numbers[3],
                      numbers[4],
                      static_cast<int>(numbers[5])};
  };
  const SizeEffect low = share < 1.0 ? at(*(above - 1)) : SizeEffect{};
  const SizeEffect high = share > 0.0 ? at(*above) : low;
  if (share >= 1.0) return high;
  if (low.nodes == 0 || high.nodes == 0) return {};
  return {(1.0 - share) * low.change + share * high.change,
          (1.0 - share) * low.error + share * high.error,
          (1.0 - share) * low.softer + share * high.softer,
          (1.0 - share) * low.moving + share * high.moving,
          (1.0 - share) * low.lag + share * high.lag,
          high.nodes};
}

double yields(const SizeEffect& size) {
  return std::max(0.0, 1.0 - depth_share(size.softer)) / (1.0 + size.softer);
}

double swing(const SizeEffect& size, const scene::Estimates& estimates,
             const scene::SurfaceTouch& touch, const scenario::Resolved::Tissue& tissue) {
  const double change = estimates.tissue_share * size.softer;
  if (!(change < 0.0 && size.moving > 0.0 && estimates.rate > 0.0)) return 0.0;
  const double compliance =
      contact::Elastic{tissue.young_modulus, tissue.poisson_ratio}.compliance();
  // All along the normal; a^2 goes with the indentation.
  const double upright = touch.curvature.normal.z();
  const double indented = upright * estimates.travel;
  const double force = 4.0 / 3.0 * estimates.tissue_share / compliance * std::sqrt(upright) *
                       estimates.contact_radius * indented * (1.0 + change);
  const double depth = indented * depth_share(change);
  const double body = force / (indented - depth);  // N/m
  // The contact is stiffer under the force with the swing. A swing grows with less than the square
  // of the contact's stiffness, which goes with the third root of the force: the sequence
  // converges.
  constexpr double settled = 1e-3;
  double before = 0.0;
  double found = 0.0;
  do {
    before = found;
    const double contact = 1.5 * force / depth * std::cbrt(1.0 + found);                    // N/m
    const double frequency = std::sqrt((contact + body) / (tissue.density * size.moving));  // rad/s
    const double started = std::min(1.0, frequency * estimates.travel / estimates.rate);
    found = contact / force * contact / (contact + body) * upright * estimates.rate / frequency *
            started;
  } while (found - before > settled * found);
  // A body that lags behind has yielded less, and never moves towards the finger: the force is at
  // most that of the contact in series with what it yields in time.
  const double yielded = (1.0 - size.lag) * (indented - depth);
  const double most = numerics::root({1.0, 1.0 / (1.0 + change)}, [&](double force_ratio) {
                        const double root = std::cbrt(force_ratio);
                        return depth * root * root + yielded * force_ratio - indented;
                      }).high;
  return std::min(found, most - 1.0);
}

}  // namespace palpate::run
