// Probes for failures of shape: inverted tetrahedra, false equilibria, locking.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "integrate/implicit.h"
#include "mechanics/stepper.h"
#include "scenario/words.h"
#include "stability/survey.h"

namespace palpate::stability {
namespace {

using integrate::Vector;
using scenario::Solver;

// The node of the surface nearest to the middle of the top that is free to move vertically.
int top_node(const ProbedBody& probed) {
  const scene::Specimen& specimen = *probed.scene.specimen;
  Vec3 middle = 0.5 * (specimen.low + specimen.high);
  middle.z() = specimen.high.z();
  int nearest = specimen.skin.front();
  double least = std::numeric_limits<double>::infinity();
  for (const int node : specimen.skin) {
    const double distance = (specimen.mesh.nodes[as_index(node)] - middle).norm();
    if (specimen.held[as_index(3 * node + 2)] != 0 || distance >= least) continue;
    nearest = node;
    least = distance;
  }
  return nearest;
}

// m^3, with the node `moved` displaced downwards by `down` (m).
double volume(const geometry::TetMesh& mesh, const std::array<int, 4>& corners, int moved,
              double down) {
  std::array<Vec3, 4> x;
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = mesh.nodes[as_index(corners[i])];
    if (corners[i] == moved) x[i].z() -= down;
  }
  return (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6.0;
}

// The downward displacement of one node (m) at which the first tetrahedron becomes flat.
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

// No force turns an inverted tetrahedron of springs back: after such a displacement and release,
// the network comes to rest in another state.
void probe_inversion(Survey& survey) {
  survey.go_on("inversion");
  const auto probed = survey.make_body({Solver::Model::mass_spring, Solver::Volume::none});
  const scene::Specimen& specimen = *probed->scene.specimen;
  const int node = top_node(*probed);
  const double theory = flat_at(specimen.mesh, node);
  Vector displacement = Vector::Zero(3 * probed->nodes());
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

  survey.go_on("false equilibrium");
  const scene::SpringBody body(specimen.network, tissue::Kinematics::nonlinear, {}, specimen.held);
  probed->scene.scenario.solver.kinematics = Solver::Kinematics::nonlinear;
  probed->scene.scenario.solver.integrator = Solver::Integrator::backward_difference;
  // Implicit Euler with long time steps damps all motion and ends where forces balance.
  const double step = 30.0 * 2.0 / probed->highest.frequency;
  const Vector nothing = Vector::Zero(displacement.size());
  for (const double times : {0.5, 1.5, 2.5, 4.0}) {
    integrate::State state;
    state.displacement = nothing;
    state.displacement[3 * node + 2] = -times * theory;
    state.velocity = nothing;
    state.memory = body.memory_at(state.displacement);
    mechanics::Stepper stepper(probed->scene, body);
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
    left.reached = !wrong && *left.measured > 10.0 * theory;  // in mm: 1 % of the inverting travel
    if (wrong)
      left.note = *wrong;
    else if (tissue::inverted(specimen.mesh, state.displacement))
      left.note = "forces balance with tetrahedra inside out: `inverted` says so";
    const bool stuck = left.reached;
    survey.map.failures.push_back(std::move(left));
    if (stuck) break;
  }
}

// Nodal forces of a unit force: on the contact or, in a uniform test, on the top's middle node.
Vector pressed(const ProbedBody& probed) {
  if (const auto spring = contact_spring(probed)) return spring->weights;
  Vector weights = Vector::Zero(3 * probed.nodes());
  weights[3 * top_node(probed) + 2] = -1.0;
  return weights;
}

// w.K^-1 w, m/N; NaN if K cannot be factorised.
double compliance(const ProbedBody& probed) {
  const Vector weights = pressed(probed);
  integrate::State state;
  state.displacement = Vector::Zero(weights.size());
  state.velocity = state.displacement;
  state.memory = probed.elastic->memory_at(state.displacement);
  integrate::Implicit statics(*probed.elastic, integrate::Implicit::Inertia::none);
  statics.begin(state, 0.0, integrate::MemoryRule::at_once);
  if (!statics.linearise(state.displacement, state.displacement))
    return std::numeric_limits<double>::quiet_NaN();
  return weights.dot(statics.response(weights));
}

// The stiffness under the finger at nu = 0.4995 divided by that at 0.3. For an elastic half-space
// the ratio is (1 - 0.3^2) / (1 - 0.4995^2); it is larger if the mesh locks.
void probe_locking(Survey& survey) {
  constexpr std::array ratios{0.3, 0.4995};
  constexpr double much = 1.5;  // times the ratio of the half-space
  for (const scenario::Rung& model : scenario::ladder) {
    if (!model.meshed() || model.solid) continue;
    for (const auto volume : {Solver::Volume::tetrahedron, Solver::Volume::nodal}) {
      survey.go_on("locking");
      std::array<double, 2> stiffness{};
      for (std::size_t i = 0; i < ratios.size(); ++i) {
        const auto probed = survey.make_body({model.of, volume}, [&](scenario::Scenario& scenario) {
          scenario.tissue.poisson_ratio = ratios[i];
        });
        stiffness[i] = 1.0 / compliance(*probed);
      }
      FailureRow row;
      row.failure = Failure::locking;
      row.rung = model.word + std::string(", volume ") +
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
  for (const auto& probe : {probe_inversion, probe_locking}) probe(survey);
}

}  // namespace palpate::stability
