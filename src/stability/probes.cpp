// Probes for failures of shape, of time steps and of touch.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "integrate/implicit.h"
#include "mechanics/stepper.h"
#include "scenario/words.h"
#include "stability/measure.h"

namespace palpate::stability {
namespace {

using integrate::Vector;
using scenario::Solver;

// The node of the surface nearest to the middle of the top that is free to move vertically.
int top_node(const ProbedBody& probed) {
  const scene::Specimen& specimen = *probed.scene.specimen;
  Vec3 middle = 0.5 * (specimen.low + specimen.high);
  middle.z() = specimen.high.z();
  int nearest = specimen.outer_surface.front();
  double least = std::numeric_limits<double>::infinity();
  for (const int node : specimen.outer_surface) {
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
    if (std::ranges::find(corners, node) == corners.end()) continue;
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
  row.model = "any";
  row.measure = "displacement of the top's middle node alone until a tetrahedron turns, mm";
  const std::optional<double> turns = bisect_limit(upright, 0.1 * theory, 1e3 * theory, 1e-6);
  row.reached = turns.has_value();
  if (turns) row.measured = 1e3 * *turns;
  row.theory = 1e3 * theory;
  row.note =
      "the height of the flattest tetrahedron there: no displacement of a press may come near it";
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
    left.model = "mass_spring, nonlinear";
    left.integrator = "backward_difference";
    left.setting = times;
    left.setting_unit = "push over the inverting displacement, then let go";
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
  for (const scenario::ModelTraits& model : scenario::model_table) {
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
      row.model = model.word + std::string(", volume ") +
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

namespace {

using scenario::Solver;

std::string model_word(const Survey& survey) { return scenario::traits(survey.given.model).word; }

// Growth of the amplitude per step at 0.95 and 1.05 of the limit, undamped.
void probe_divergence(Survey& survey) {
  ProbedBody& own = *survey.own;
  own.scene.scenario.solver.integrator = Solver::Integrator::central_difference;
  const FreeMotion motion{
      .scene = &own.scene, .body = own.elastic.get(), .mode = own.highest, .steps = 4000};
  const double limit = 2.0 / own.highest.frequency;
  for (const double share : {0.95, 1.05}) {
    survey.go_on("divergence");
    FailureRow row;
    row.failure = Failure::divergence;
    row.model = model_word(survey);
    row.integrator = "central_difference";
    row.setting = share;
    row.setting_unit = "time step over 2/omega_max";
    row.measure = "growth of the amplitude in a step";
    const Moved early = move(motion, share * limit, 1e8);
    row.reached = early.failure == Failure::divergence;
    if (row.reached) {
      const Moved late = move(motion, share * limit, 1e40);
      row.measured =
          std::exp(0.5 * std::log(late.after / early.after) / (late.steps - early.steps));
      row.theory = growth_beyond(2.0 * share);
    } else {
      row.measured = std::pow(early.after / early.before, 1.0 / motion.steps);
      row.theory = 1.0;
    }
    survey.map.failures.push_back(std::move(row));
  }
}

// Number of steps at twice the limit until the energy is not finite.
void probe_overflow(Survey& survey) {
  survey.go_on("overflow");
  ProbedBody& own = *survey.own;
  own.scene.scenario.solver.integrator = Solver::Integrator::central_difference;
  const FreeMotion motion{
      .scene = &own.scene, .body = own.elastic.get(), .mode = own.highest, .steps = 4000};
  const double step = 4.0 / own.highest.frequency;
  const Moved early = move(motion, step, 1e8);
  const Moved late = move(motion, step, std::numeric_limits<double>::infinity());
  FailureRow row;
  row.failure = Failure::non_finite;
  row.model = model_word(survey);
  row.integrator = "central_difference";
  row.setting = 2.0;
  row.setting_unit = "time step over 2/omega_max";
  row.measure = "steps until energy is no number";
  row.reached = late.failure == Failure::non_finite;
  row.measured = late.steps;
  // E_n = E_1 s^(2 (n - 1)) exceeds the largest double.
  const double room = std::log(std::numeric_limits<double>::max()) - std::log(early.after);
  row.theory = early.steps + std::ceil(0.5 * room / std::log(growth_beyond(4.0)));
  survey.map.failures.push_back(std::move(row));
}

// The factor by which one step changes the amplitude of a body released in its lowest mode.
double amplitude_kept(const Survey& survey, const BodyMode& lowest, double time_step, int steps) {
  const scene::SpringBody& body = *survey.own->elastic;
  mechanics::Stepper stepper(survey.own->scene, body);
  stepper.set_step(time_step);
  integrate::State state;
  state.displacement = 1e-6 / lowest.shape.cwiseAbs().maxCoeff() * lowest.shape;
  state.velocity = integrate::Vector::Zero(state.displacement.size());
  state.memory = body.memory_at(state.displacement);
  const integrate::Vector nothing = state.velocity;
  std::array<double, 4> greatest{};
  for (int i = 0; i < steps; ++i) {
    if (stepper.step(state, nothing, nothing, integrate::MemoryRule::exact))
      return std::numeric_limits<double>::quiet_NaN();
    double& most = greatest[as_index(4 * i / steps)];
    most = std::max(most, body.stored(state) + body.kinetic(state));
  }
  // From the first quarter to the last one.
  return std::pow(greatest[3] / greatest[0], 0.5 / (0.75 * steps));
}

void probe_drift(Survey& survey) {
  ProbedBody& own = *survey.own;
  const BodyMode lowest = lowest_mode(*own.elastic);
  const double explicit_step = 0.9 * 2.0 / own.highest.frequency;
  for (const Method& method : methods()) {
    // Statics have no amplitude; `modal` propagates modes exactly, from rest.
    if (!about(method.integrator).inertia || method.integrator == Integrator::modal || method.lags)
      continue;
    survey.go_on("drift");
    const bool limited = method.explicit_steps();
    const double step = limited ? explicit_step : survey.one->scenario.output.interval;
    own.scene.scenario.solver.integrator = method.integrator;
    FailureRow row;
    row.failure = Failure::drift;
    row.model = model_word(survey);
    row.integrator = method.name();
    row.setting = 1e6 * step;
    row.setting_unit = "us, the time step";
    row.measure = "amplitude of the lowest mode after an undamped step over before";
    row.measured = amplitude_kept(survey, lowest, step, limited ? 4000 : 40);
    row.theory = amplification(method.integrator, lowest.frequency * step);
    // 1e-6 per step is a thousandth of the amplitude in a thousand steps.
    row.reached = !(std::abs(*row.measured - 1.0) < 1e-6);
    survey.map.failures.push_back(std::move(row));
  }
}

}  // namespace

void probe_time(Survey& survey) {
  for (const auto& probe : {probe_divergence, probe_overflow, probe_drift}) probe(survey);
}

namespace {

// A hand pushes on a wall with the stiffness of the contact, through a device whose damping is
// `share` times the bound of Colgate and Brown for frames of 1 ms.
void probe_chatter(Survey& survey, double stiffness) {
  for (const double share : {2.0, 0.25}) {
    survey.go_on("chatter");
    Device device;
    device.sampled.damping = share * contact::needed_damping(stiffness, device.sampled);
    FailureRow row;
    row.failure = Failure::chatter;
    row.model = "device";
    row.integrator = "zero_order_hold";
    row.setting = share;
    row.setting_unit = "device damping over K T / 2, frames of 1 ms";
    row.measure = "share of frames in which the contact comes or goes";
    row.measured = chatter_share(device, stiffness, {});
    if (share > 1.0) row.theory = 0.0;
    row.reached = *row.measured > 0.0;
    row.note = "K = " + std::to_string(std::lround(stiffness)) + " N/m, pushed by 1 N";
    survey.map.failures.push_back(std::move(row));
  }
}

}  // namespace

void probe_touch(Survey& survey) {
  const auto spring = contact_spring(*survey.own);
  if (!spring) return;
  probe_chatter(survey, spring->stiffness);
}

}  // namespace palpate::stability
