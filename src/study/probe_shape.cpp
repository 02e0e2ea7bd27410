// Failures of shape: inverted tetrahedra, false equilibria, locking.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "integrate/implicit.h"
#include "run/stepper.h"
#include "scenario/words.h"
#include "study/survey.h"

namespace palpate::study {
namespace {

using integrate::Vector;
using scenario::Solver;

// The free skin node nearest to the middle of the top.
int top_node(const Variant& variant) {
  const scene::Specimen& specimen = *variant.scene.specimen;
  Vec3 middle = 0.5 * (specimen.low + specimen.high);
  middle.z() = specimen.high.z();
  int nearest = specimen.skin.front();
  double least = std::numeric_limits<double>::infinity();
  for (const int node : specimen.skin) {
    const double distance = (specimen.mesh.nodes[static_cast<std::size_t>(node)] - middle).norm();
    if (specimen.held[static_cast<std::size_t>(3 * node + 2)] != 0 || distance >= least) continue;
    nearest = node;
    least = distance;
  }
  return nearest;
}

double volume(const geometry::TetMesh& mesh, const std::array<int, 4>& corners, int moved,
              double down) {
  std::array<Vec3, 4> x;
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = mesh.nodes[static_cast<std::size_t>(corners[i])];
    if (corners[i] == moved) x[i].z() -= down;
  }
  return (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6.0;
}

// How far a node alone may go down until the first tetrahedron is flat, m: volumes are linear in
// it.
double flat_at(const geometry::TetMesh& mesh, int node) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& corners : mesh.tetrahedra) {
    if (std::find(corners.begin(), corners.end(), node) == corners.end()) continue;
    const double rest = volume(mesh, corners, node, 0.0);
    const double slope = (rest - volume(mesh, corners, node, 1e-3)) / 1e-3;  // m^2
    if (slope / rest > 0.0) least = std::min(least, rest / slope);
  }
  return least;
}

// An inverted network has no force that turns it back: pushed so far down and let go, it settles
// elsewhere.
void probe_inversion(Survey& survey) {
  if (!survey.go_on("inversion")) return;
  const auto variant = survey.variant({Solver::Model::mass_spring, Solver::Volume::none});
  const scene::Specimen& specimen = *variant->scene.specimen;
  const int node = top_node(*variant);
  const double theory = flat_at(specimen.mesh, node);
  Vector displacement = Vector::Zero(3 * variant->nodes());
  const auto upright = [&](double down) {
    displacement[3 * node + 2] = -down;
    return !tissue::inverted(specimen.mesh, displacement);
  };
  FailureRow row;
  row.failure = Failure::inversion;
  row.rung = "any";
  row.measure = "travel of the top's middle node alone until a tetrahedron turns, mm";
  const std::optional<double> turns = bisect_limit(upright, 0.1 * theory, 1e3 * theory, 1e-6);
  row.reached = turns.has_value();
  if (turns) row.measured = 1e3 * *turns;
  row.theory = 1e3 * theory;
  row.note = "the height of the flattest tetrahedron there: no travel of a press may come near it";
  survey.map.failures.push_back(row);

  if (!survey.go_on("false equilibrium")) return;
  const scene::SpringBody body(specimen.network, tissue::Kinematics::nonlinear, {}, specimen.held);
  variant->scene.scenario.solver.kinematics = tissue::Kinematics::nonlinear;
  variant->scene.scenario.solver.integrator = Solver::Integrator::backward_difference;
  // Implicit Euler in long steps loses all motion, and ends where forces balance.
  const double step = 30.0 * 2.0 / variant->highest.frequency;
  const Vector nothing = Vector::Zero(displacement.size());
  for (const double times : {0.5, 1.5, 2.5, 4.0}) {
    integrate::State state;
    state.displacement = nothing;
    state.displacement[3 * node + 2] = -times * theory;
    state.velocity = nothing;
    state.memory = body.memory_at(state.displacement);
    run::Stepper stepper(variant->scene, body);
    stepper.set_step(step);
    std::optional<std::string> wrong;
    for (int i = 0; i < 400 && !wrong; ++i)
      wrong = stepper.step(state, nothing, nothing, integrate::MemoryRule::exact);
    FailureRow left;
    left.failure = Failure::false_equilibrium;
    left.rung = "mass_spring, nonlinear";
    left.integrator = "backward_difference";
    left.setting = times;
    left.setting_unit = "push over the inverting travel, then let go";
    left.measure = "greatest displacement that stays without load, mm";
    left.measured = 1e3 * state.displacement.cwiseAbs().maxCoeff();
    left.theory = 0.0;
    left.reached = !wrong && *left.measured > 10.0 * theory;  // a hundredth of that travel, in mm
    if (wrong)
      left.note = *wrong;
    else if (tissue::inverted(specimen.mesh, state.displacement))
      left.note = "forces balance with tetrahedra inside out: `inverted` says so";
    const bool stuck = left.reached;
    survey.map.failures.push_back(std::move(left));
    if (stuck) break;
  }
}

// The contact's spread of a unit force, or the top's middle node where there is no contact.
Vector pressed(const Variant& variant) {
  if (const auto spring = contact_spring(variant)) return spring->weights;
  Vector weights = Vector::Zero(3 * variant.nodes());
  weights[3 * top_node(variant) + 2] = -1.0;
  return weights;
}

// w.K^-1 w, m/N.
double compliance(const Variant& variant) {
  const Vector weights = pressed(variant);
  integrate::State state;
  state.displacement = Vector::Zero(weights.size());
  state.velocity = state.displacement;
  state.memory = variant.elastic->memory_at(state.displacement);
  integrate::Implicit statics(*variant.elastic, integrate::Implicit::Inertia::none);
  statics.begin(state, 0.0, integrate::MemoryRule::at_once);
  if (!statics.linearise(state.displacement, state.displacement))
    return std::numeric_limits<double>::quiet_NaN();
  return weights.dot(statics.response(weights));
}

// How much stiffer the tissue is under the finger at nu = 0.4995 than at 0.3. Elasticity says, of a
// half-space, (1 - 0.3^2) / (1 - 0.4995^2); a mesh that locks cannot let the tissue flow aside.
void probe_locking(Survey& survey) {
  constexpr std::array ratios{0.3, 0.4995};
  constexpr double much = 1.5;  // over what elasticity says
  for (const auto model : {Solver::Model::mass_spring, Solver::Model::coupled_springs}) {
    for (const auto volume : {Solver::Volume::tetrahedron, Solver::Volume::nodal}) {
      if (!survey.go_on("locking")) return;
      std::array<double, 2> stiffness{};
      for (std::size_t i = 0; i < ratios.size(); ++i) {
        const auto variant = survey.variant({model, volume}, [&](scenario::Scenario& scenario) {
          scenario.tissue.poisson_ratio = ratios[i];
        });
        stiffness[i] = 1.0 / compliance(*variant);
      }
      FailureRow row;
      row.failure = Failure::locking;
      row.rung = std::string(scenario::words::word(scenario::words::models, model)) + ", volume " +
                 scenario::words::word(scenario::words::volumes, volume);
      row.setting = ratios[1];
      row.setting_unit = "Poisson's ratio";
      row.measure = "stiffness where it is pressed over that at 0.3";
      row.measured = stiffness[1] / stiffness[0];
      row.theory = (1.0 - ratios[0] * ratios[0]) / (1.0 - ratios[1] * ratios[1]);
      row.reached = !(*row.measured < much * *row.theory);
      row.note = "theory is a half-space's; half as much again counts as locked";
      survey.map.failures.push_back(std::move(row));
    }
  }
}

}  // namespace

void probe_shape(Survey& survey) {
  for (const auto& probe : {probe_inversion, probe_locking})
    if (!survey.map.interrupted) probe(survey);
}

}  // namespace palpate::study
