// Bisection for methods with a limit; trials at growing steps for the others.
#include "stability/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <stdexcept>

#include "base/index.h"
#include "base/numerics.h"
#include "base/text.h"
#include "contact/hertz.h"
#include "contact/patch.h"
#include "integrate/implicit.h"
#include "mechanics/stepper.h"
#include "run/refined_mesh.h"
#include "scene/first_touch.h"

namespace palpate::stability {

using integrate::Vector;

Vector scattered(const integrate::Body& body) {
  Vector vector = Vector::Zero(body.mass().size());
  std::uint64_t state = 1;  // of a linear congruential generator
  for (Eigen::Index d = 0; d < vector.size(); ++d) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    if (body.held()[as_index(d)] == 0)
      vector[d] = static_cast<double>(state >> 11) / 9007199254740992.0 - 0.5;
  }
  return vector;
}

BodyMode highest_mode(const integrate::Body& body, const ContactSpring* contact) {
  Vector scale = body.mass().cwiseSqrt().cwiseInverse();
  for (Eigen::Index d = 0; d < scale.size(); ++d)
    if (body.held()[as_index(d)] != 0) scale[d] = 0.0;
  Vector force;
  const auto multiply = [&](const Vector& x, Vector& image) {
    const Vector u = scale.cwiseProduct(x);
    body.stiffness().multiply(u, force);
    if (contact != nullptr)
      force += contact->stiffness * contact->weights.dot(u) * contact->weights;
    image = scale.cwiseProduct(force);
  };
  const Vector start = scattered(body).cwiseProduct(body.mass().cwiseSqrt());
  const EigenPair found = largest_eigenpair(start, 1e-9, multiply);
  return {std::sqrt(std::max(found.value, 0.0)), scale.cwiseProduct(found.vector)};
}

BodyMode lowest_mode(const integrate::Body& body) {
  integrate::State state;
  state.displacement = Vector::Zero(body.mass().size());
  state.velocity = state.displacement;
  state.memory = body.memory_at(state.displacement);
  integrate::Implicit statics(body, integrate::Implicit::Inertia::none);
  statics.begin(state, 0.0, integrate::MemoryRule::at_once);
  if (!statics.linearise(state.displacement, state.displacement))
    throw std::domain_error("the body is not held");
  // M^1/2 K^-1 M^1/2, whose largest eigenvalue is 1 / omega^2
  const Vector root_mass = body.mass().cwiseSqrt();
  const auto multiply = [&](const Vector& x, Vector& image) {
    statics.response(root_mass.cwiseProduct(x), image);
    image = root_mass.cwiseProduct(image).eval();
  };
  const EigenPair found =
      largest_eigenpair(root_mass.cwiseProduct(scattered(body)), 1e-9, multiply);
  return {1.0 / std::sqrt(found.value), found.vector.cwiseQuotient(root_mass)};
}

using integrate::Vector;

void LaggedDifference::step(integrate::State& state, const Vector& load) {
  const double dt = time_step_;
  if (state.force.size() == 0) body_->look(state);
  damping_ = body_->drag().cwiseProduct(state.velocity);
  if (body_->has_dashpots()) {
    body_->dashpot_force(state.displacement, state.velocity, dashpots_);
    damping_ += dashpots_;
  }
  state.velocity += dt * (load - state.force - damping_).cwiseQuotient(body_->mass());
  const auto held = body_->held();
  for (std::size_t d = 0; d < held.size(); ++d)
    if (held[d] != 0) state.velocity[static_cast<Eigen::Index>(d)] = 0.0;
  state.displacement += dt * state.velocity;
  state.time += dt;
  body_->arrive(state, {dt, integrate::MemoryRule::exact});
}

Moved move(const FreeMotion& motion, double time_step, double enough) {
  const scene::SpringBody& body = *motion.body;
  integrate::State state;
  state.displacement = Vector::Zero(body.mass().size());
  state.velocity = state.displacement;
  state.memory = body.memory_at(state.displacement);

  // The stroke moves an undamped body by about a micrometre in the first step.
  Vector rest = scattered(body);
  rest *= 0.3 / std::sqrt(rest.dot(body.mass().cwiseProduct(rest)));
  Vector shape = motion.mode.shape + rest;
  shape *= 1e-6 / shape.cwiseAbs().maxCoeff();
  const Vector stroke = body.mass().cwiseProduct(shape) / (time_step * time_step);
  const Vector nothing = Vector::Zero(shape.size());

  LaggedDifference by_lag(body, time_step);
  mechanics::Stepper stepper(*motion.scene, body);
  if (!motion.lagged) stepper.set_step(time_step);

  Moved moved;
  std::array<double, 4> greatest{};
  double first = 0.0;
  Vector load = stroke;
  Vector load_after = stroke;
  for (int i = 0; i < motion.steps; ++i) {
    if (i > 0) load = nothing;
    if (motion.contact != nullptr)
      load -= motion.contact->stiffness * motion.contact->weights.dot(state.displacement) *
              motion.contact->weights;
    load_after = i == 0 ? stroke : nothing;
    if (motion.lagged) {
      by_lag.step(state, load);
    } else if (stepper.step(state, load, load_after, integrate::MemoryRule::exact)) {
      moved.ending =
          std::isfinite(state.displacement.sum()) ? Ending::cannot_step : Ending::not_finite;
      return moved;
    }
    double energy = body.stored(state) + body.kinetic(state);
    if (motion.contact != nullptr) {
      const double sunk = motion.contact->weights.dot(state.displacement);
      energy += 0.5 * motion.contact->stiffness * sunk * sunk;
    }
    moved.steps = i + 1;
    moved.after = energy;
    if (!std::isfinite(energy)) {
      moved.ending = Ending::not_finite;
      return moved;
    }
    if (i == 0) first = energy;
    if (energy > enough * first) {
      moved.ending = Ending::grows;
      return moved;
    }
    double& most = greatest[as_index(4 * i / motion.steps)];
    most = std::max(most, energy);
  }
  moved.before = greatest[1];
  moved.after = greatest[3];
  // The energy of a motion that has decayed to rounding errors is not compared.
  const bool dead = moved.after <= 1e-24 * std::max(first, greatest[0]);
  if (!dead && moved.after > motion.growth * moved.before) moved.ending = Ending::grows;
  return moved;
}

void choose_length(FreeMotion& motion, double damping_ratio) {
  // For a time step that is e (relative) above the limit, one root is -1 - d: over half of n steps
  // the energy grows by exp(n d). Undamped, d = sqrt(8 e), and e = 0.0005 gives a factor of 1e11 in
  // 400 steps. With heavy centred damping, d is about 2 e / zeta: n = 10 zeta gives exp(20 e), 1.05
  // at e = 0.0025. With damping that lags or leads, d = 2 e for every zeta.
  constexpr double most = 40000.0;
  motion.steps = 400;
  if (!motion.lagged && motion.centred)
    motion.steps = static_cast<int>(std::min(400.0 + 10.0 * damping_ratio, most));
  motion.growth = damping_ratio > 0.05 ? 1.05 : 2.0;
}

std::optional<double> bisect_limit(const std::function<bool(double)>& stable, double start,
                                   double most, double resolution) {
  double low = start;
  double high = start;
  if (stable(start)) {
    do {
      low = high;
      high *= 2.0;
      if (high > most) return std::nullopt;
    } while (stable(high));
  } else {
    do {
      high = low;
      low *= 0.5;
      if (low < 1e-9 * start) return 0.0;
    } while (!stable(low));
  }
  return numerics::change({low, high}, resolution, stable).middle();
}

using scenario::Scenario;
using scenario::Solver;
using tissue::Viscosity;

scenario::Case bare(scenario::Case one, scenario::Model model, tissue::Volume volume) {
  Scenario& scenario = one.scenario;
  scenario.solver.model = model;
  scenario.solver.volume = volume;
  scenario.solver.kinematics = Solver::Kinematics::linear;
  scenario.solver.integrator = Solver::Integrator::central_difference;
  scenario.solver.start = integrate::Start::consistent;
  scenario.solver.time_step.reset();
  scenario.solver.substeps.reset();
  scenario.solver.rings.reset();
  scenario.solver.allow_unstable = true;
  scenario.tissue.viscosity = Viscosity::none;
  scenario.contact.coupling = contact::Coupling::one_way;
  scenario.contact.viscosity = scenario::Contact::Viscosity::none;
  scenario.contact.depth = scenario::Contact::Depth::hertz;
  return one;
}

std::unique_ptr<ProbedBody> make_probed_body(const scenario::Case& one,
                                             const scenario::Family& family,
                                             scene::SpecimenShapes& shapes) {
  auto probed = std::make_unique<ProbedBody>();
  probed->scene = run::build_scene(one, family, shapes);
  const scene::Specimen& specimen = *probed->scene.specimen;
  probed->elastic = std::make_unique<scene::SpringBody>(
      specimen.network, tissue::Kinematics::linear, tissue::ViscousLaw{}, specimen.held);
  probed->highest = highest_mode(*probed->elastic, nullptr);
  return probed;
}

ModelAndVolume model_and_volume(const Scenario& scenario) {
  const Solver& solver = scenario.solver;
  const bool named = solver.model && scenario::traits(*solver.model).meshed();
  const scenario::ModelTraits& traits =
      named ? scenario::traits(*solver.model) : scenario::strongest;
  return {traits.of, solver.volume.value_or(traits.volume)};
}

Damping damping_of(const scenario::Case& one, Viscosity form) {
  const scenario::Tissue& tissue = one.scenario.tissue;
  const material::Tissue& material = one.materials.tissue;
  Damping damping;
  const auto value = [&](const std::optional<double>& given,
                         const std::optional<material::Sourced>& from, double otherwise) {
    if (given) return *given;
    if (from) return from->value;
    damping.assumed = true;
    return otherwise;
  };
  tissue::ViscousLaw& law = damping.law;
  law.kind = form;
  switch (form) {
    case Viscosity::none: break;
    case Viscosity::nodal_drag: law.drag = value(tissue.drag, material.drag, 100.0); break;
    case Viscosity::kelvin_voigt:
      law.time = value(tissue.retardation_time, material.retardation_time, 0.1);
      break;
    case Viscosity::standard_linear_solid: {
      const double ratio = value(tissue.instantaneous_ratio, material.instantaneous_ratio, 2.0);
      law.branches.push_back(
          {value(tissue.relaxation_time, material.relaxation_time, 0.1), ratio - 1.0});
      break;
    }
    case Viscosity::prony:
      for (const scenario::Branch& branch : tissue.branches)
        law.branches.push_back({branch.relaxation_time, branch.ratio});
  }
  return damping;
}

std::optional<ContactSpring> contact_spring(const ProbedBody& probed) {
  const scene::Scene& scene = probed.scene;
  if (scene.scenario.uniform()) return std::nullopt;
  const scene::Specimen& specimen = *scene.specimen;
  const double depth = scene::deepest_travel(scene.scenario, scene.law());
  contact::Patch patch;
  patch.at = scene::first_touch(scene).at;
  patch.position = specimen.surface->position(patch.at);
  patch.normal = specimen.surface->normal(patch.at);
  patch.axis = patch.normal.unitOrthogonal();
  patch.a = patch.b = contact::hertz::contact_radius(depth, scene.finger.sphere_radius);
  contact::Spread load;
  contact::Spreader(*specimen.surface).spread(patch, load);
  ContactSpring spring;
  spring.stiffness = scene.finger.force_factor *
                     contact::hertz::stiffness(depth, scene.law().radius, scene.law().modulus);
  spring.weights = integrate::Vector::Zero(3 * probed.nodes());
  for (std::size_t j = 0; j < load.vertices.size(); ++j) {
    const int node = specimen.outer_surface[as_index(load.vertices[j])];
    for (int c = 0; c < 3; ++c)
      if (specimen.held[as_index(3 * node + c)] == 0)
        spring.weights[3 * node + c] = -load.shares[j] * patch.normal[c];
  }
  return spring;
}

namespace {

// Ratio of omega^2 of a mode that changes its sign in every step to that of the relaxed tissue.
double alternating_ratio(const tissue::ViscousLaw& law, double time_step) {
  double ratio = 1.0;
  for (const tissue::Branch& branch : law.branches) {
    const double x = time_step / branch.time;
    // q = e (1 - (2 / x) tanh(x / 2)) with MemoryStep::exact if e and q alternate in sign.
    ratio += branch.ratio * (x > 0.0 ? 2.0 / x * std::tanh(0.5 * x) : 1.0);
  }
  return ratio;
}

// docs/theory.md [explicit_limit] with [branch_limit], left side minus 4; negative if stable.
// `side` is s / 2: 0 for centred damping, 1 if the velocity lags, -1 if it is the new one.
double excess(double time_step, double side, double frequency, const tissue::ViscousLaw& law) {
  const double damping = law.drag + law.time * frequency * frequency;
  return time_step * time_step * frequency * frequency * alternating_ratio(law, time_step) +
         2.0 * side * damping * time_step - 4.0;
}

}  // namespace

std::vector<Method> methods() {
  std::vector<Method> all;
  for (std::size_t i = 0; i < scenario::integrator_table.size(); ++i)
    all.push_back({static_cast<Integrator>(i)});
  all.push_back(lagged);
  return all;
}

std::optional<double> limit_theory(const Method& method, double frequency,
                                   const tissue::ViscousLaw& law) {
  double side = 0.0;
  switch (method.integrator) {
    case Integrator::central_difference: side = method.lags ? 1.0 : 0.0; break;
    case Integrator::semi_implicit_euler: side = -1.0; break;
    case Integrator::backward_difference:
    case Integrator::tr_bdf2:
    case Integrator::quasi_static:
    case Integrator::modal: return std::nullopt;
  }
  const auto over = [&](double time_step) { return excess(time_step, side, frequency, law); };
  double high = 2.0 / frequency;
  while (over(high) < 0.0) high *= 2.0;
  return numerics::root({0.0, high}, over).low;
}

double damping_ratio(double frequency, const tissue::ViscousLaw& law) {
  return 0.5 * (law.drag / frequency + law.time * frequency);
}

std::optional<double> amplification(Integrator integrator, double omega_step) {
  const double x = omega_step;
  switch (integrator) {
    case Integrator::central_difference:
    case Integrator::semi_implicit_euler: return x < 2.0 ? std::optional(1.0) : std::nullopt;
    case Integrator::backward_difference: return 1.0 / std::sqrt(1.0 + x * x);
    case Integrator::tr_bdf2: {
      // y' = i x y: the trapezoidal rule to gamma, then the second-order backward difference.
      const std::complex<double> z(0.0, x);
      const double gamma = 2.0 - std::sqrt(2.0);
      const std::complex<double> middle = (1.0 + 0.5 * gamma * z) / (1.0 - 0.5 * gamma * z);
      const double share = 1.0 / (gamma * (2.0 - gamma));
      const std::complex<double> end = (share * middle - share * (1.0 - gamma) * (1.0 - gamma)) /
                                       (1.0 - (1.0 - gamma) / (2.0 - gamma) * z);
      return std::abs(end);
    }
    case Integrator::modal: return 1.0;
    case Integrator::quasi_static: break;
  }
  return std::nullopt;
}

double growth_beyond(double omega_step) {
  const double half = 0.5 * omega_step * omega_step - 1.0;
  return half + std::sqrt(half * half - 1.0);
}

namespace {

Failure failure_of(Ending ending) {
  switch (ending) {
    case Ending::bounded: break;
    case Ending::grows: return Failure::divergence;
    case Ending::not_finite: return Failure::non_finite;
    case Ending::cannot_step: return Failure::non_finite;
  }
  return Failure::none;
}

constexpr double resolution = 1e-3;  // relative, of a bisected limit
constexpr double farthest = 1000.0;  // times 2 / omega: longest step for methods without a limit

}  // namespace

Measured measure_limit(ProbedBody& probed, const Method& method, const tissue::ViscousLaw& law,
                       const ContactSpring* contact) {
  const scene::Specimen& specimen = *probed.scene.specimen;
  const scene::SpringBody body(specimen.network, tissue::Kinematics::linear, law, specimen.held);
  probed.scene.scenario.solver.integrator = method.integrator;
  const BodyMode with_contact =
      contact != nullptr ? highest_mode(*probed.elastic, contact) : BodyMode{};
  const BodyMode& mode = contact != nullptr ? with_contact : probed.highest;
  FreeMotion motion{.scene = &probed.scene,
                    .body = &body,
                    .lagged = method.lags,
                    .centred = method == Method{},
                    .mode = mode,
                    .contact = contact};
  Measured measured;
  measured.theory = limit_theory(method, mode.frequency, law);
  const double explicit_limit = 2.0 / mode.frequency;
  Ending beyond = Ending::bounded;
  const auto stable = [&](double step) {
    const Moved moved = move(motion, step);
    if (moved.ending != Ending::bounded) beyond = moved.ending;
    return moved.ending == Ending::bounded;
  };
  if (measured.theory) {
    choose_length(motion, damping_ratio(mode.frequency, law));
    measured.limit = bisect_limit(stable, 0.5 * explicit_limit, 2e4 * explicit_limit, resolution);
    measured.failure = measured.limit ? failure_of(beyond) : Failure::none;
    if (!measured.limit) measured.note = "no limit found";
    return measured;
  }
  motion.steps = 100;
  for (double times = method.integrator == Integrator::modal ? farthest : 1.0; times <= farthest;
       times *= 10.0) {
    if (stable(times * explicit_limit)) continue;
    measured.failure = failure_of(beyond);
    measured.limit =
        bisect_limit(stable, times * explicit_limit, 2.0 * times * explicit_limit, resolution);
    if (beyond == Ending::cannot_step) measured.note = "its equations have no solution";
    return measured;
  }
  measured.note = "stable at " + rounded_text(farthest, 4) + " times the explicit limit, " +
                  rounded_text(farthest * explicit_limit, 3) + " s";
  return measured;
}

}  // namespace palpate::stability
