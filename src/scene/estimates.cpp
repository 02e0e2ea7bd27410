// Estimates by closed forms, or by fits to converged results where there is none.
#include "scene/estimates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/numerics.h"
#include "contact/hertz.h"
#include "scenario/programme.h"
#include "scene/scene.h"
#include "scene/specimen_mesh.h"

namespace palpate::scene {
namespace {

using scenario::Model;

constexpr double infinite = std::numeric_limits<double>::infinity();

// The smallest distances of the finger from the four sides of a cuboid on its path, m.
std::array<double, 4> sides(const scenario::Resolved& scenario, const scenario::Cuboid& box) {
  std::array<double, 4> least{infinite, infinite, infinite, infinite};
  for (const auto& [x, y] : scenario::finger_places(scenario, box)) {
    const std::array<double, 4> now{x, box.size[0] - x, y, box.size[1] - y};
    for (std::size_t i = 0; i < 4; ++i) least[i] = std::min(least[i], now[i]);
  }
  return least;
}

// A free side at the distance b reduces the force by the fraction 0.4 a/b exp(-k b/H), with
// k = 2.4 - 3.4 (nu - 0.33): fitted to coupled springs on blocks, b/H 0.25 to 3, nu 0.33 and 0.49.
double side_effect(const scenario::Resolved& scenario, const scenario::Cuboid& box, double a) {
  const double k = 2.4 - 3.4 * (scenario.tissue.poisson_ratio - 0.33);
  double sum = 0.0;
  for (const double b : sides(scenario, box))
    sum += b <= a ? 1.0 : 0.4 * a / b * std::exp(-k * b / box.size[2]);
  return std::min(sum, 1.0);
}

double fastest_rate(const scenario::Resolved& scenario) {
  double rate = 0.0;
  for (const scenario::Step& step : scenario.steps) {
    if (const auto* indent = std::get_if<scenario::Indent>(&step))
      rate = std::max(rate, indent->rate);
    if (const auto* retract = std::get_if<scenario::Retract>(&step))
      rate = std::max(rate, retract->rate);
  }
  return rate;
}

// The change by thickness and sides together, or by the thickness and the base of a curved body,
// which yields like a spring behind Hertz's contact: F / F_Hertz = rho with
// rho^(2/3) + 2/3 x rho = 1, x the base's tangent compliance over Hertz's. docs/theory.md (68)
void change_by_size(const SurfaceTouch& touch, Estimates& found) {
  found.narrow = std::min(0.99, found.sides);
  found.by_size_error = doubt_of_sides * found.sides;
  if (touch.footing && touch.known()) {
    const Footing::Compliance base = touch.footing->under(touch.position, touch.curvature.normal);
    const double a = found.tissue_share * found.contact_radius;
    const double x = std::min(1e3, a * (base.sinking + base.rocking));
    const double root = numerics::root(1.0, {0.0, 1.0}, [&](double r) {  // of rho, the third
      return numerics::Tangent{r * r + 2.0 / 3.0 * x * r * r * r - 1.0, 2.0 * r + 2.0 * x * r * r};
    });
    found.narrow = 1.0 - root * root * root;
    // Chosen so that they cover.                        tests/accuracy/standing_bodies.py
    found.by_size_error =
        0.004 +
        a * (base.sinking + 0.7 * base.rocking / ((1.0 + found.thickness) * (1.0 - found.narrow)));
  }
  found.by_size = (1.0 + found.thickness) * (1.0 - found.narrow) - 1.0;
}

// The change of the half-space's force where size_is_fitted(), docs/theory.md (68). Fitted to
// coupled springs on random bodies.                      tests/accuracy/curved_bodies.py
void fit_size(const scenario::Resolved& scenario, const SurfaceTouch& touch, Estimates& found) {
  if (!size_is_fitted(scenario, touch)) return;
  const bool ellipsoid = std::holds_alternative<scenario::Ellipsoid>(scenario.tissue.shape);
  const double nu = scenario.tissue.poisson_ratio;
  const double q = (1.0 - 2.0 * nu) / (1.0 - nu);
  const Vec3& size = touch.size;
  const double along_x = size.z() / size.x(), along_y = size.z() / size.y();
  const double share = found.tissue_share * found.contact_radius / size.z();
  const double change = ellipsoid ? 2.09 - 0.17 * q - 1.40 * (along_x + along_y)
                                  : 0.39 - 0.05 * q - 0.48 * along_y * along_y;
  found.by_size = std::max(-0.99, share * change);
  const double open = ellipsoid ? 0.15 * (along_x + along_y) : 0.1 * (1.0 + along_y * along_y);
  found.by_size_error = 0.004 + share * open;
  found.narrow = std::max(0.0, 1.0 - (1.0 + found.by_size) / (1.0 + found.thickness));
}

// In a ramp of duration T, Kelvin-Voigt increases the force by tau F'/F = 3/2 tau/T, and a branch
// of ratio b by about b x (1 - exp(-1/x)), x = tau/T.
double viscous_effect(const scenario::Resolved::Tissue& tissue, double duration) {
  if (duration <= 0.0) return 0.0;
  const tissue::ViscousLaw& law = tissue.law;
  double sum = 1.5 * law.time / duration;
  for (const tissue::Branch& branch : law.branches) {
    const double x = branch.time / duration;
    sum += branch.ratio * x * -std::expm1(-1.0 / x);
  }
  return sum;
}

// The radiation of a vibrating footing (Lysmer's analogue), pi a^2 rho c v with
// c = 3.4 v_s / (pi (1 - nu)), over Hertz's force.
double inertia_effect(const scenario::Resolved::Tissue& tissue, const contact::SphereLaw& law,
                      double travel, double rate) {
  const double nu = tissue.poisson_ratio;
  const double shear_speed = std::sqrt(tissue.young_modulus / (2.0 * (1.0 + nu) * tissue.density));
  const double speed = 3.4 * shear_speed / (std::numbers::pi * (1.0 - nu));
  const double force = contact::hertz::force(travel, law.radius, law.modulus);
  if (force <= 0.0) return 0.0;
  return std::numbers::pi * law.radius * travel * tissue.density * speed * rate / force;
}

// Of one layer for 3e-7 of the effect of its thickness, in a fifth of the operations that a law
// needs.
contact::LayerResolution resolution(const contact::Layer& layer, double greatest_ratio) {
  if (!layer.below.empty()) return contact::layer_resolution(greatest_ratio);
  return {.points = 6 + static_cast<int>(std::ceil(4.0 * greatest_ratio)),
          .waves = 24 + static_cast<int>(std::ceil(10.0 * greatest_ratio))};
}

// The layers under the finger, from the top.
std::vector<contact::Stratum> strata(const scenario::Resolved::Tissue& tissue,
                                     const contact::Layer& layer, double thickness) {
  const double shear = tissue.young_modulus / (1.0 + layer.poisson_ratio);
  std::vector<contact::Stratum> all{
      {layer.top() * thickness, tissue.young_modulus, tissue.poisson_ratio}};
  for (const contact::Sublayer& below : layer.below)
    all.push_back({below.thickness * thickness,
                   below.stiffness * shear * (1.0 + below.poisson_ratio), below.poisson_ratio});
  return all;
}

// Sets the effect of the depth, from the other estimates.
void press_deep(const scenario::Resolved& scenario, const SurfaceTouch& touch,
                const contact::SphereLaw& law, Estimates& found) {
  const scenario::Resolved::Tissue& tissue = scenario.tissue;
  const auto* box = std::get_if<scenario::Cuboid>(&tissue.shape);
  contact::DeepPress press{.radius = scenario.finger.radius,
                           .effective_radius = law.radius,
                           .thickness = touch.thickness,
                           .poisson_ratio = tissue.poisson_ratio,
                           .tissue_share = found.tissue_share};
  const contact::Layer layer = layers_of(scenario, found.tissue_share);
  press.base = layer.base;
  if (box != nullptr) {
    const std::array<double, 4> all = sides(scenario, *box);
    press.half_width = *std::min_element(all.begin(), all.end());
    // A side at the distance w has w / cos t in the direction t, up to 45 degrees.
    constexpr double over_directions = 0.750;  // mean of cos^3 t
    double cubes = 0.0;
    for (const double side : all) cubes += 0.25 * over_directions / (side * side * side);
    press.side_distance = 1.0 / std::cbrt(cubes);
  } else if (touch.size.allFinite()) {
    press.half_width = press.side_distance = 0.5 * touch.size.head<2>().minCoeff();
  }
  if (!layer.below.empty()) {
    press.tissues = contact::Tissues::layers;
    const std::vector<contact::Stratum> all = strata(tissue, layer, touch.thickness);
    press.thickness = contact::effective_thickness(all);
    press.skin = all.front().thickness;
    press.bending_length = contact::bending_length(all);
    press.force_over_hertz = 1.0 + found.thickness;
  } else if (several_tissues(scenario)) {
    press.tissues = contact::Tissues::inclusion;
  }
  found.depth_ratio = contact::depth_ratio(press);
  std::optional<contact::DepthRatio> near = found.depth_ratio;
  if (!near) {
    const double least = 1.0 / (1.0 + contact::DepthRatio::most_curved);
    const double most = 1.0 / (1.0 + contact::DepthRatio::least_curved);
    press.effective_radius = press.radius * std::clamp(law.radius / press.radius, least, most);
    press.thickness = std::max(press.thickness, contact::DepthRatio::thinnest * press.radius);
    press.half_width = std::max(press.half_width, found.contact_radius);
    near = contact::depth_ratio(press);
  }
  if (!near) return;
  found.deep = near->value(found.travel) - 1.0;
  found.deep_error = near->error(found.travel);
}

}  // namespace

bool size_is_fitted(const scenario::Resolved& scenario, const SurfaceTouch& touch) {
  constexpr double level = 3.0;  // degrees
  return (std::holds_alternative<scenario::Ellipsoid>(scenario.tissue.shape) ||
          std::holds_alternative<scenario::Cylinder>(scenario.tissue.shape)) &&
         scenario.tissue.base == tissue::Base::bonded && !scenario.tissue.base_height &&
         !several_tissues(scenario) && touch.known() && touch.inclination() <= level;
}

Estimates estimate(const scenario::Resolved& scenario, const SurfaceTouch& touch) {
  Estimates found;
  const scenario::Resolved::Tissue& tissue = scenario.tissue;
  const contact::Elastic body{tissue.young_modulus, tissue.poisson_ratio};
  const auto& rubber = scenario.finger.elastic;
  const double lambda_1 = rubber ? rubber->compliance() : 0.0;
  found.tissue_share = body.compliance() / (lambda_1 + body.compliance());
  contact::SphereLaw law{scenario.finger.radius,
                         contact::hertz::effective_modulus(lambda_1, body.compliance())};
  if (touch.known()) {
    const double k_1 = 1.0 / law.radius + touch.curvature.kappa_1;
    const double k_2 = 1.0 / law.radius + touch.curvature.kappa_2;
    if (k_2 > 0.0) {
      found.curvature_ratio = k_1 / k_2;
      law.radius = 1.0 / std::sqrt(k_1 * k_2);
    }
  }
  found.travel = deepest_travel(scenario, law);
  found.rate = fastest_rate(scenario);
  found.contact_radius = contact::hertz::contact_radius(found.travel, law.radius);

  const auto* box = std::get_if<scenario::Cuboid>(&tissue.shape);
  const bool sized = touch.size.allFinite();
  if (sized) {
    const contact::Layer layer = layers_of(scenario, found.tissue_share);
    constexpr double last_chi = 3.0;
    found.chi = found.contact_radius / touch.thickness;
    if (found.chi < last_chi)
      found.thickness =
          contact::LayerEquation(layer, resolution(layer, 2.0 * found.chi / layer.top()))
              .force_factor(found.chi) -
          1.0;
    else
      found.thickness = infinite;
  }
  if (box != nullptr) {
    // The effect of the sides comes from the depth, that is from the softest layer.
    double softest = tissue.young_modulus;
    for (const auto& region : scenario.regions) softest = std::min(softest, region.young_modulus);
    found.sides = found.tissue_share * tissue.young_modulus / softest *
                  side_effect(scenario, *box, found.contact_radius);
  } else if (sized) {
    // A curved body of width w is compressed as a whole, with an effect of the order a / (w/2).
    // An inclined force also shears it on its base: on an ellipsoid the effect grew as 1 / cos^2.
    const double cosine = touch.known() ? std::max(0.1, touch.curvature.normal.z()) : 1.0;
    found.curved_body =
        found.tissue_share * found.contact_radius / (0.5 * touch.size.minCoeff() * cosine * cosine);
  }
  if (const double x = touch.to_edge / found.contact_radius; x == 0.0)
    found.overhang = 0.75;  // as at a corner; which of them is touched is not known
  else if (x < 1.0)
    found.overhang = 0.25 * (1.0 - x) * (1.0 - x) * (2.0 + x);
  change_by_size(touch, found);
  fit_size(scenario, touch, found);
  press_deep(scenario, touch, law, found);
  found.viscous = found.tissue_share *
                  viscous_effect(tissue, found.rate > 0.0 ? found.travel / found.rate : 0.0);
  found.inertia = found.tissue_share * inertia_effect(tissue, law, found.travel, found.rate);
  return found;
}

double SizeRatio::value(double depth) const {
  return 1.0 + change * std::sqrt(std::clamp(depth / deepest, 0.0, 1.0));
}

std::optional<SizeRatio> size_ratio(scenario::Model model, const scenario::Resolved& scenario,
                                    const SurfaceTouch& touch, const Estimates& estimates) {
  const bool box = std::holds_alternative<scenario::Cuboid>(scenario.tissue.shape);
  const bool slides = std::any_of(
      scenario.steps.begin(), scenario.steps.end(),
      [](const scenario::Step& step) { return std::holds_alternative<scenario::Slide>(step); });
  const bool applies = box ? model == Model::layer : model == Model::hertz;
  if (!applies || slides || !touch.size.allFinite() || !(estimates.travel > 0.0)) return {};
  const double change = box ? -estimates.sides : estimates.by_size;
  if (!(std::abs(change) <= SizeRatio::most)) return {};
  // Chosen so that it covers.                                 tests/accuracy/size_ratio.py
  const double error =
      box ? doubt_of_sides * estimates.sides : estimates.by_size_error + 0.1 * std::abs(change);
  return SizeRatio{change, touch.pressed(scenario.finger.radius, estimates.travel).depth, error};
}

double half_space_error(const Estimates& estimates) {
  return std::abs(1.0 / (1.0 + estimates.by_size) - 1.0) + estimates.by_size_error;
}

double uniform_ringing(const scenario::Resolved& scenario) {
  const scenario::Resolved::Tissue& tissue = scenario.tissue;
  const bool jumps = std::any_of(
      scenario.steps.begin(), scenario.steps.end(),
      [](const scenario::Step& step) { return std::holds_alternative<scenario::Creep>(step); });
  if (!jumps || tissue.viscosity == tissue::Viscosity::nodal_drag) return 0.0;
  if (tissue.viscosity != tissue::Viscosity::kelvin_voigt)
    return 1.0 / tissue.law.instantaneous_ratio();
  const auto shape = parametric(tissue.shape);
  if (!shape) return 1.0;
  double softest = tissue.young_modulus;
  double densest = tissue.density;
  for (const auto& region : scenario.regions) {
    softest = std::min(softest, region.young_modulus);
    densest = std::max(densest, region.density);
  }
  const bool stands_up = !std::holds_alternative<geometry::Cuboid>(*shape);  // for the test
  const double height = geometry::extent(*shape)[stands_up ? 1 : 2];
  const double frequency = 0.5 * std::numbers::pi / height * std::sqrt(softest / densest);
  const double periods = frequency * tissue.law.time;
  return 1.0 / std::max(1.0, periods * periods);
}

double bonded_stiffening(const scenario::Resolved& scenario, double poisson_ratio) {
  const auto shape = parametric(scenario.tissue.shape);
  const int ends = (scenario.tissue.base == tissue::Base::bonded ? 1 : 0) +
                   (scenario::upper_platen(scenario) == tissue::Base::bonded ? 1 : 0);
  if (!shape || ends == 0) return 1.0;
  Vec3 size = geometry::extent(*shape);
  const bool stands_up = !std::holds_alternative<geometry::Cuboid>(*shape);  // for the test
  if (stands_up) std::swap(size.y(), size.z());
  const double form = 0.25 * ends * size.x() * size.y() / (size.z() * (size.x() + size.y()));
  const double confined =
      (1.0 - poisson_ratio) / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
  if (form == 0.0 || confined <= 1.0) return 1.0;
  return 1.0 + 1.0 / (1.0 / (2.0 * form * form) + 1.0 / (confined - 1.0));
}

double bonded_mesh_error(const scenario::Resolved& scenario) {
  const double nu = scenario.tissue.poisson_ratio;
  const double stiffening = bonded_stiffening(scenario, nu);
  if (stiffening == 1.0) return 0.0;
  // Fitted to tests/bench/bonded_platens.py.                      docs/theory.md, below (52a)
  const bool lattice = std::holds_alternative<scenario::Kuhn>(scenario.tissue.mesh) ||
                       std::holds_alternative<scenario::Mirrored>(scenario.tissue.mesh);
  const double as_dense = lattice ? 260.0 : 700.0;
  return 0.017 * stiffening / std::sqrt(1.0 - 2.0 * nu) *
         std::pow(as_dense / expected_nodes(scenario.tissue.mesh), 2.0 / 3.0);
}

double expected_nodes(const scenario::Mesh& mesh) {
  const auto of_cells = [](const std::array<int, 3>& cells) {
    return (cells[0] + 1.0) * (cells[1] + 1.0) * (cells[2] + 1.0);
  };
  if (const auto* kuhn = std::get_if<scenario::Kuhn>(&mesh)) return of_cells(kuhn->cells);
  if (const auto* mirrored = std::get_if<scenario::Mirrored>(&mesh))
    return of_cells(mirrored->cells);
  if (const auto* tetgen = std::get_if<scenario::Tetgen>(&mesh)) return tetgen->nodes;
  return 1000.0;  // a ready mesh is read later
}

}  // namespace palpate::scene
