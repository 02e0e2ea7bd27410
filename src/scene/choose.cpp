// The questions of the ladder, in order; the first that settles it ends the list.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "contact/hertz.h"
#include "scene/scene.h"
#include "scene/specimen_mesh.h"

namespace palpate::scene {
namespace {

using Model = scenario::Solver::Model;

// The viscous time over the time that the fastest press takes.
double time_ratio(const scenario::Scenario& scenario, double travel) {
  double viscous = 0.0;
  if (scenario.tissue.viscosity == tissue::Viscosity::kelvin_voigt)
    viscous = *scenario.tissue.retardation_time;
  if (scenario.tissue.viscosity == tissue::Viscosity::standard_linear_solid)
    viscous = *scenario.tissue.relaxation_time;
  double rate = 0.0;
  for (const scenario::Step& step : scenario.steps)
    if (const auto* indent = std::get_if<scenario::Indent>(&step))
      rate = std::max(rate, indent->rate);
  return travel > 0.0 ? viscous * rate / travel : 0.0;
}

// How near the finger comes to a side of a cuboid on its way, m; negative beside it.
double nearest_side(const scenario::Scenario& scenario, const scenario::Cuboid& box) {
  double x = scenario.finger.x.value_or(0.5 * box.size[0]);
  double y = scenario.finger.y.value_or(0.5 * box.size[1]);
  const auto side = [&] { return std::min({x, box.size[0] - x, y, box.size[1] - y}); };
  double nearest = side();
  for (const scenario::Step& step : scenario.steps) {
    const auto* slide = std::get_if<scenario::Slide>(&step);
    if (slide == nullptr) continue;
    const double angle = slide->direction * std::numbers::pi / 180.0;
    x += slide->by * std::cos(angle);
    y += slide->by * std::sin(angle);
    nearest = std::min(nearest, side());
  }
  return nearest;
}

}  // namespace

std::optional<TopCurvature> top_curvature(const scenario::Shape& shape) {
  if (std::holds_alternative<scenario::Cuboid>(shape)) return TopCurvature{};
  if (const auto* half = std::get_if<scenario::HalfSpace>(&shape)) {
    const double across = half->curvature_2.value_or(half->curvature);
    if (half->curvature >= across) return TopCurvature{half->curvature, across};
    return TopCurvature{across, half->curvature, Vec3::UnitY()};
  }
  if (const auto* cylinder = std::get_if<scenario::Cylinder>(&shape))
    return TopCurvature{1.0 / cylinder->radius, 0.0};
  if (const auto* ellipsoid = std::get_if<scenario::Ellipsoid>(&shape)) {
    // z = c sqrt(1 - x^2/a^2 - y^2/b^2) curves with c/a^2 and c/b^2 at its top.
    const Vec3 half = 0.5 * ellipsoid->size;
    const double x = half.z() / (half.x() * half.x());
    const double y = half.z() / (half.y() * half.y());
    return x >= y ? TopCurvature{x, y} : TopCurvature{y, x, Vec3::UnitY()};
  }
  return std::nullopt;
}

std::optional<std::string> beyond_hertz(const scenario::Scenario& scenario) {
  if (!scenario.regions.empty()) return "it has regions of other tissues";
  const auto top = top_curvature(scenario.tissue.shape);
  if (!top) return "no formula gives the curvature of its shape";
  const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape);
  if (box != nullptr && nearest_side(scenario, *box) < 0.0)
    return "the finger leaves the specimen's top";
  if (top->kappa_1 == 0.0 && top->kappa_2 == 0.0) return std::nullopt;
  if (scenario.finger.spheres > 1) return "several spheres press a curved surface";
  if (scenario.finger.x || scenario.finger.y) return "the finger may stand off the curved top";
  for (const scenario::Step& step : scenario.steps)
    if (std::holds_alternative<scenario::Slide>(step))
      return "the finger slides over a curved surface";
  return std::nullopt;
}

double deepest_travel(const scenario::Scenario& scenario, const contact::SphereLaw& law) {
  double travel = 0.0;
  for (const scenario::Step& step : scenario.steps)
    if (const auto* indent = std::get_if<scenario::Indent>(&step))
      travel = std::max(travel, indent->to.second ? contact::hertz::depth(indent->to.value,
                                                                          law.radius, law.modulus)
                                                  : indent->to.value);
  return travel;
}

Choice choose(const scenario::Scenario& scenario) {
  Choice choice;
  if (scenario.solver.model != Model::automatic) {
    choice.model = scenario.solver.model;
    return choice;
  }
  const auto ask = [&](const char* asked, const char* measure, double number, double threshold,
                       const char* yes, const char* no) {
    const bool hertz = number < threshold;
    choice.questions.push_back({asked, measure, number, threshold, hertz ? yes : no});
    return hertz;
  };
  choice.model = Model::mass_spring;
  if (!ask("a uniform test?", "steps that load the end faces", scenario.uniform() ? 1 : 0, 0.5,
           "no: a finger presses", "yes: only a specimen can creep or relax"))
    return choice;
  if (std::holds_alternative<scenario::HalfSpace>(scenario.tissue.shape)) {
    choice.questions.push_back({"a specimen that has a mesh?", "shapes with an end", 0, 1,
                                "no: a half_space goes on for ever, hertz is all there is"});
    choice.model = Model::hertz;
    return choice;
  }

  const contact::Elastic tissue{*scenario.tissue.young_modulus, *scenario.tissue.poisson_ratio};
  const double lambda_2 = tissue.compliance();
  const double lambda_1 =
      scenario.finger.material == "rigid"
          ? 0.0
          : contact::Elastic{*scenario.finger.young_modulus, *scenario.finger.poisson_ratio}
                .compliance();
  const contact::SphereLaw law{scenario.finger.radius,
                               contact::hertz::effective_modulus(lambda_1, lambda_2)};
  const double travel = deepest_travel(scenario, law);
  if (scenario.contact.coupling == contact::Coupling::one_way && !beyond_hertz(scenario)) {
    choice.questions.push_back({"does the force know the mesh?", "coupling is one_way", 0, 1,
                                "no: it is eq. (2) alone, hertz says the same"});
    choice.model = Model::hertz;
    return choice;
  }
  if (const auto reason = beyond_hertz(scenario)) {
    choice.questions.push_back(
        {"a scene that a formula knows?", "reasons against", 1, 1, "no: " + *reason});
    return choice;
  }
  const double tolerance = scenario.solver.tolerance;
  if (ask("rigid tissue?", "lambda_2 / (lambda_1 + lambda_2)", lambda_2 / (lambda_1 + lambda_2),
          std::min(tolerance, 0.02), "yes: only the finger deforms, hertz is enough",
          "no: the tissue deforms")) {
    choice.model = Model::hertz;
    return choice;
  }
  const auto shape = parametric(scenario.tissue.shape);
  const Vec3 size = shape ? geometry::extent(*shape)
                          : Vec3(Vec3::Constant(std::numeric_limits<double>::infinity()));
  const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape);
  const double side =
      box != nullptr ? nearest_side(scenario, *box) : 0.5 * std::min(size[0], size[1]);
  const double near = std::min(size[2], side);
  // The finite thickness adds c1 chi to the force, c1 at most 1.127 (bonded, nu = 1/2).
  const double thickness = 1.127 * std::sqrt(law.radius * travel) / near;
  if (!ask("half-space?", "1.127 sqrt(R h) / nearest support or side", thickness, tolerance,
           "yes: the specimen's size changes the force by less than the tolerance",
           "no: thickness and sides matter"))
    return choice;
  if (!ask("time dependent?", "viscous time * rate / travel", time_ratio(scenario, travel), 0.01,
           "no: slow against the tissue's own time", "yes: the tissue's viscosity takes part"))
    return choice;
  choice.model = Model::hertz;
  return choice;
}

}  // namespace palpate::scene
