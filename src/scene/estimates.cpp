// Estimates by closed forms, or by fits to converged results where there is none.
#include "scene/estimates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/numerics.h"
#include "contact/hertz.h"
#include "contact/patch.h"
#include "contact/platens.h"
#include "scenario/programme.h"
#include "scene/refining_press.h"
#include "scene/scene.h"
#include "scene/specimen_mesh.h"
#include "scene/time_plan.h"

namespace palpate::scene {
namespace {

using scenario::Model;

constexpr double infinite = std::numeric_limits<double>::infinity();

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

// What a branch of a time tau keeps of a force that grows with the power 3/2 of time, y = tau/T:
//   int_0^1 3/2 sqrt(s) exp(-(1 - s)/y) ds
double unrelaxed(double y) {
  constexpr double short_time = 0.02;
  if (y < short_time) return 1.5 * y * (1.0 - 0.5 * y);
  const numerics::GaussRule& rule = numerics::gauss_rule(32);
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double s = 0.5 * (1.0 + rule.nodes[i]);
    sum += 0.5 * rule.weights[i] * 1.5 * std::sqrt(s) * std::exp(-(1.0 - s) / y);
  }
  return sum;
}

// In a ramp of duration T, Kelvin-Voigt increases the force by tau F'/F = 3/2 tau/T, and a branch
// by its ratio times what it keeps.
double viscous_effect(const scenario::Resolved::Tissue& tissue, double duration) {
  if (duration <= 0.0) return 0.0;
  double sum = 1.5 * tissue.law.time / duration;
  for (const tissue::Branch& branch : tissue.law.branches)
    sum += branch.ratio * unrelaxed(branch.time / duration);
  return sum;
}

// The radiation of a vibrating footing (Lysmer's analogue), pi a^2 rho c v with
// c = 3.4 v_s / (pi (1 - nu)), over Hertz's force.
double inertia_effect(const scenario::Resolved::Tissue& tissue, const contact::SphereLaw& law,
                      double travel, double rate) {
  const double nu = tissue.poisson_ratio;
  const double speed = 3.4 * shear_speed(tissue) / (std::numbers::pi * (1.0 - nu));
  const double force = contact::hertz::force(travel, law.radius, law.modulus);
  if (force <= 0.0) return 0.0;
  return std::numbers::pi * law.radius * travel * tissue.density * speed * rate / force;
}

// Quadrature of one layer, good to 3e-7 of the effect of its thickness at a fifth of the cost of
// the default one.
contact::LayerResolution resolution(const contact::Layer& layer, double greatest_ratio) {
  if (!layer.below.empty()) return contact::layer_resolution(greatest_ratio, layer.top());
  return {.points = 6 + static_cast<int>(std::ceil(4.0 * greatest_ratio)),
          .waves = 24 + static_cast<int>(std::ceil(10.0 * greatest_ratio))};
}

// The thickness of the softest of the layers under the finger, m.
double softest_thickness(const scenario::Resolved& scenario, const SurfaceTouch& touch) {
  const contact::Layer layer = layers_of(scenario, 1.0);
  double softest = 1.0 / (1.0 + layer.poisson_ratio);  // shear moduli over E of the tissue
  double thickness = layer.top() * touch.thickness;
  const double own = softest;
  for (const contact::Sublayer& below : layer.below)
    if (below.stiffness * own < softest) {
      softest = below.stiffness * own;
      thickness = below.thickness * touch.thickness;
    }
  return thickness;
}

// What the stretch of layers that bend on softer ones adds to the force at most, per depth, 1/m: a
// plate on a half-space bends over a length that goes with the cubic root of their moduli's ratio.
double stretch_bound(const scenario::Resolved& scenario, const SurfaceTouch& touch) {
  constexpr double counted = 0.02;  // docs/accuracy.md
  const contact::Layer layer = layers_of(scenario, 1.0);
  double most = 0.0;
  double softest = HUGE_VAL;
  for (auto below = layer.below.rbegin(); below != layer.below.rend(); ++below) {
    if (below->stiffness > softest)
      most = std::max(most, std::cbrt(below->stiffness / softest) / below->thickness);
    softest = std::min(softest, below->stiffness);
  }
  if (softest < 1.0) most = std::max(most, std::cbrt(1.0 / softest) / layer.top());
  return counted * most / touch.thickness;
}

// Sets the effect of the depth: by the table on flat tissue of one kind whose edges are not near,
// else bounded.
void press_deep(const scenario::Resolved& scenario, const SurfaceTouch& touch,
                const contact::SphereLaw& law, Estimates& found) {
  const scenario::Resolved::Tissue& tissue = scenario.tissue;
  const bool flat = touch.known() && !touch.curved() && !touch.tilted() &&
                    (std::holds_alternative<scenario::Cuboid>(tissue.shape) ||
                     std::holds_alternative<scenario::HalfSpace>(tissue.shape));
  // Spheres that stand for one have its law, others each their own.
  const bool several =
      scenario.finger.spheres > 1 && scenario.finger.calibration == finger::Calibration::mass;
  double ratio = tissue.poisson_ratio;
  for (const auto& region : scenario.regions) ratio = std::min(ratio, region.poisson_ratio);
  const double radius = several ? make_finger(scenario).sphere_radius : law.radius;
  const double travel = found.tissue_share * found.travel;
  const double bound =
      contact::depth_bound(travel, radius, softest_thickness(scenario, touch), ratio) +
      stretch_bound(scenario, touch) * travel;
  found.deep_bound = bound;
  if (flat && !several && !several_tissues(scenario) && found.edge == 0.0) {
    const contact::Layer layer = layers_of(scenario, found.tissue_share);
    found.depth_ratio = contact::depth_ratio({.radius = scenario.finger.radius,
                                              .thickness = touch.thickness,
                                              .poisson_ratio = tissue.poisson_ratio,
                                              .base = layer.base,
                                              .tissue_share = found.tissue_share,
                                              .half_width = touch.to_edge});
    if (found.depth_ratio) {
      found.deep = found.depth_ratio->value(found.travel) - 1.0;
      // Where its formula ends, no slope of it says what follows.
      const bool beyond = found.travel > found.depth_ratio->last_depth();
      found.deep_error = beyond ? bound : found.depth_ratio->error(found.travel);
      return;
    }
  }
  found.deep_error = bound;
}

// The way from an edge to the nearest of the finger's spheres, m; 0 where one hangs over it.
double nearest_to_edge(const scenario::Resolved& scenario, const SurfaceTouch& touch) {
  double farthest = 0.0;
  if (scenario.finger.spheres > 1)
    for (const Vec3& centre : make_finger(scenario).centres)
      farthest = std::max(farthest, centre.head<2>().norm());
  return std::max(0.0, touch.to_edge - farthest);
}

// The share of Hertz's pressure beyond an edge at x contact radii from the centre is
// (1 - x)^2 (2 + x) / 4; the force, which has none there, is lower by about its square. Up to two
// radii a free end changes the force of a body by up to 31 % more than a coarse mesh sees: counted
// on bars and blocks.                                                   docs/theory.md [edge]
double edge_bound(double x) {
  constexpr double counted = 0.35;
  if (x >= 2.0) return 0.0;
  const double near = counted * (2.0 - std::max(1.0, x));
  if (x >= 1.0) return near;
  const double left = 1.0 - 0.25 * (1.0 - x) * (1.0 - x) * (2.0 + x);
  return near + 1.0 / (left * left) - 1.0;
}

}  // namespace

Estimates estimate(const scenario::Resolved& scenario, const SurfaceTouch& touch, double yields) {
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
  found.yields = yields;
  found.travel = deepest_travel(scenario, law, yields);
  found.rate = fastest_rate(scenario);
  found.contact_radius = contact::hertz::contact_radius(found.travel, law.radius);

  if (std::holds_alternative<scenario::Cuboid>(tissue.shape)) {
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
    found.size = found.thickness;
  }
  if (found.contact_radius > 0.0)
    found.edge = edge_bound(nearest_to_edge(scenario, touch) / found.contact_radius);
  // A ball that is held at its equator yields 1/4 a/R of the depth less than a half-space of its
  // rubber, which has a far field, and the force goes with the power 3/2 of the depth.
  found.ball =
      1.5 * 0.25 * (1.0 - found.tissue_share) * found.contact_radius / scenario.finger.radius;
  press_deep(scenario, touch, law, found);
  found.viscous = found.tissue_share *
                  viscous_effect(tissue, found.rate > 0.0 ? found.travel / found.rate : 0.0);
  found.inertia = found.tissue_share * inertia_effect(tissue, law, found.travel, found.rate);
  // Tissue that a sliding finger reaches is loaded while the contact passes.
  for (const scenario::Step& step : scenario.steps)
    if (const auto* slide = std::get_if<scenario::Slide>(&step))
      found.fresh = std::max(
          found.fresh,
          found.tissue_share * viscous_effect(tissue, 2.0 * found.contact_radius / slide->rate));
  return found;
}

double longest_for_waves(const scenario::Resolved& scenario) {
  const double rate = fastest_rate(scenario);
  if (!(rate > 0.0) || !inertia_reaches_force(scenario)) return infinite;
  const contact::SphereLaw law = make_finger(scenario).whole;
  const double travel = deepest_travel(scenario, law);
  const double longest = std::max(0.5 * shear_speed(scenario.tissue) * travel / rate,
                                  contact::hertz::contact_radius(travel, law.radius));
  return std::exp2(std::floor(2.0 * std::log2(longest)) / 2.0);
}

bool carries_waves(const scenario::Resolved& scenario, const SurfaceTouch& touch,
                   double contact_radius) {
  if (contact::wide_semi_axes * contact_radius > std::min(touch.to_edge, touch.thickness))
    return false;
  if (refines(scenario)) return true;
  double cell = std::cbrt(touch.size.prod() / expected_nodes(scenario.tissue.mesh));
  const auto of_cells = [&](const std::array<int, 3>& cells) {
    for (int axis = 0; axis < 3; ++axis)
      cell = std::max(cell, touch.size[axis] / cells[as_index(axis)]);
  };
  if (const auto* kuhn = std::get_if<scenario::Kuhn>(&scenario.tissue.mesh)) of_cells(kuhn->cells);
  if (const auto* mirrored = std::get_if<scenario::Mirrored>(&scenario.tissue.mesh))
    of_cells(mirrored->cells);
  return cell <= longest_for_waves(scenario);
}

double uniform_ringing(const scenario::Resolved& scenario) {
  const scenario::Resolved::Tissue& tissue = scenario.tissue;
  const bool jumps = std::ranges::any_of(scenario.steps, [](const scenario::Step& step) {
    return std::holds_alternative<scenario::Creep>(step);
  });
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
  const double height = geometry::extent(*shape)[geometry::stands(*shape) ? 2 : 1];
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
  if (!geometry::stands(*shape)) std::swap(size.y(), size.z());
  const double form = 0.25 * ends * size.x() * size.y() / (size.z() * (size.x() + size.y()));
  return contact::bonded_stiffening(form, poisson_ratio);
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
