// The limit of the time step as a function of one quantity of the scenario at a time.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "stability/measure.h"
#include "stability/sampled_wall.h"
#include "stability/survey.h"

namespace palpate::stability {
namespace {

using scenario::Scenario;
using scenario::Solver;
using tissue::Viscosity;

// The explicit integrators of scenarios, without `lagged`.
std::vector<Method> explicit_methods() {
  std::vector<Method> all = methods();
  std::erase_if(all, [](const Method& one) { return !one.explicit_steps() || one.lags; });
  return all;
}

void along_modulus(Survey& survey) {
  // From 0.1 kPa, softer than brain, to 17 GPa, cortical bone.
  const int points = survey.large() ? 3 : 9;
  for (int i = 0; i < points; ++i) {
    const double modulus = 100.0 * std::pow(1.7e8, static_cast<double>(i) / (points - 1));
    survey.go_on("Young's modulus");
    const auto probed = survey.make_body(
        survey.given, [&](Scenario& scenario) { scenario.tissue.young_modulus = modulus; });
    for (const Method& method : explicit_methods())
      add_limit(survey, *probed, method, {}, {.axis = "young_modulus_Pa", .value = modulus});
  }
}

void along_ratio(Survey& survey) {
  for (const Solver::Volume volume : {Solver::Volume::tetrahedron, Solver::Volume::nodal}) {
    for (const double ratio : {0.0, 0.2, 0.3, 0.4, 0.45, 0.49, 0.499, 0.4995, 0.4999}) {
      if (survey.large() && ratio != 0.3 && ratio != 0.45 && ratio != 0.499) continue;
      survey.go_on("Poisson's ratio");
      const auto probed =
          survey.make_body({scenario::strongest.of, volume},
                           [&](Scenario& scenario) { scenario.tissue.poisson_ratio = ratio; });
      add_limit(survey, *probed, Method{}, {},
                {.axis = "poisson_ratio",
                 .value = ratio,
                 .note = ratio > 0.4995 ? "a mesh takes 0.4995" : ""});
    }
  }
}

// Makes the edges of the mesh about `factor` times as long; false if the mesh cannot be changed.
bool resize(scenario::Mesh& mesh, double factor) {
  const auto cells = [&](auto& lattice) {
    for (int& count : lattice.cells)
      count = std::max(1, static_cast<int>(std::lround(count / factor)));
    return true;
  };
  if (auto* kuhn = std::get_if<scenario::Kuhn>(&mesh)) return cells(*kuhn);
  if (auto* mirrored = std::get_if<scenario::Mirrored>(&mesh)) return cells(*mirrored);
  if (auto* tetgen = std::get_if<scenario::Tetgen>(&mesh)) {
    if (tetgen->edge) *tetgen->edge *= factor;
    tetgen->nodes =
        std::max(20, static_cast<int>(std::lround(tetgen->nodes / (factor * factor * factor))));
    tetgen->tetrahedra.reset();
    return true;
  }
  return false;
}

void along_size(Survey& survey) {
  for (const double factor : {2.0, 1.5, 1.0, 0.75, 0.6}) {
    if (survey.large() && factor < 1.0) break;
    scenario::Mesh mesh = survey.one->scenario.tissue.mesh;
    if (!resize(mesh, factor) && factor != 1.0) continue;
    survey.go_on("element size");
    std::unique_ptr<ProbedBody> probed;
    try {
      probed = survey.make_body(survey.given, [&](Scenario& scenario) {
        if (factor != 1.0) scenario.tissue.mesh = mesh;
      });
    } catch (const MeshError& error) {
      if (factor == 1.0) throw;
      survey.map.sentences.push_back("Elements " + number_text(factor) +
                                     " times as long were excluded: " + error.what() + ".");
      continue;
    }
    const auto& lengths = probed->scene.specimen->network.rest_length;
    add_limit(survey, *probed, Method{}, {},
              {.axis = "shortest_edge_mm",
               .value = 1e3 * *std::min_element(lengths.begin(), lengths.end()),
               .note = std::to_string(probed->nodes()) + " nodes"});
  }
}

void along_damping(Survey& survey) {
  const double omega = survey.own->highest.frequency;
  for (const double zeta : {0.01, 0.1, 1.0, 10.0, 100.0}) {
    if (survey.large() && zeta != 0.1 && zeta != 10.0) continue;
    for (const Method& method : methods()) {
      if (!method.explicit_steps()) continue;
      survey.go_on("damping");
      tissue::ViscousLaw drag;
      drag.kind = Viscosity::nodal_drag;
      drag.drag = 2.0 * zeta * omega;
      add_limit(survey, *survey.own, method, drag, {.axis = "damping_per_s", .value = drag.drag});
      tissue::ViscousLaw voigt;
      voigt.kind = Viscosity::kelvin_voigt;
      voigt.time = 2.0 * zeta / omega;
      add_limit(survey, *survey.own, method, voigt,
                {.axis = "retardation_time_s", .value = voigt.time});
    }
  }
  // A branch that relaxes more slowly than the time step stiffens the body, a faster one does not.
  const Damping own = damping_of(*survey.one, Viscosity::standard_linear_solid);
  for (const double times : {0.03, 0.3, 1.0, 3.0, 30.0}) {
    survey.go_on("damping");
    tissue::ViscousLaw law = own.law;
    law.branches.front().time = times * 2.0 / omega;
    add_limit(survey, *survey.own, Method{}, law,
              {.axis = "relaxation_time_s", .value = law.branches.front().time});
  }
}

void along_contact(Survey& survey) {
  std::optional<ContactSpring> spring = contact_spring(*survey.own);
  if (!spring) return;
  const double stiffness = spring->stiffness;
  for (const double times : {0.1, 1.0, 10.0, 100.0, 1000.0}) {
    if (survey.large() && times != 1.0 && times != 100.0) continue;
    for (const Method& method : explicit_methods()) {
      survey.go_on("contact stiffness");
      spring->stiffness = times * stiffness;
      add_limit(survey, *survey.own, method, {},
                {.axis = "contact_stiffness_N_per_m",
                 .value = spring->stiffness,
                 .note = times == 1.0 ? "the contact at the largest displacement" : "",
                 .contact = &*spring});
    }
  }
}

// The longest frame time with which a device renders the scenario's contact, by device damping.
void along_device(Survey& survey) {
  const std::optional<ContactSpring> spring = contact_spring(*survey.own);
  if (!spring) return;
  for (const double damping : {0.01, 0.03, 0.1, 0.3, 1.0, 3.0}) {
    survey.go_on("device damping");
    Device device;
    device.sampled.damping = damping;
    const auto still = [&](double frame) {
      device.sampled.frame = frame;
      return !wall_gains_energy(device, spring->stiffness);
    };
    LimitRow row;
    row.model = "device";
    row.volume = "none";
    row.integrator = "zero_order_hold";
    row.damping = "device";
    row.axis = "device_damping_N_s_per_m";
    row.value = damping;
    row.theory = 2.0 * damping / spring->stiffness;  // K T / 2 = b
    row.measured = bisect_limit(still, *row.theory, 1e3 * *row.theory, 5e-4);
    row.failure = Failure::divergence;
    row.note = "frame time of a device of 45 g with no hand; theory: Colgate and Brown, any hand";
    survey.map.limits.push_back(std::move(row));
  }
}

}  // namespace

void survey_axes(Survey& survey) {
  for (const auto& axis :
       {along_modulus, along_ratio, along_size, along_damping, along_contact, along_device})
    axis(survey);
}

}  // namespace palpate::stability
