// Bisection for methods with a limit; trials at growing steps for the others.
#include "stability/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
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
#include "tissue/network.h"

namespace palpate::stability {

using integrate::Vector;

namespace {

// Pseudo-random numbers, 0 for held degrees of freedom.
Vector scattered(const integrate::Body& body) {
  Vector vector = tissue::scattered(body.mass().size());
  for (Eigen::Index d = 0; d < vector.size(); ++d)
    if (body.held()[as_index(d)] != 0) vector[d] = 0.0;
  return vector;
}

// From M^-1/2 (K + k w w^T) M^-1/2, to a relative residual of 1e-9. The body is linear without
// branches; `contact` can be null.
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

}  // namespace

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

  mechanics::Stepper stepper(*motion.scene, body);
  stepper.set_step(time_step);

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
    if (stepper.step(state, load, load_after, integrate::MemoryRule::exact)) {
      moved.failure = Failure::non_finite;
      moved.cannot_step = std::isfinite(state.displacement.sum());
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
      moved.failure = Failure::non_finite;
      return moved;
    }
    if (i == 0) first = energy;
    if (energy > enough * first) {
      moved.failure = Failure::divergence;
      return moved;
    }
    double& most = greatest[as_index(4 * i / motion.steps)];
    most = std::max(most, energy);
  }
  moved.before = greatest[1];
  moved.after = greatest[3];
  // The energy of a motion that has decayed to rounding errors is not compared.
  const bool dead = moved.after <= 1e-24 * std::max(first, greatest[0]);
  if (!dead && moved.after > motion.growth * moved.before) moved.failure = Failure::divergence;
  return moved;
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
  const contact::Patch patch =
      scene::first_patch(scene, contact::hertz::contact_radius(depth, scene.finger.sphere_radius));
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

// Sets `steps` and `growth` so that a time step 0.25 % above the limit is seen to be unstable.
void choose_length(FreeMotion& motion, double damping_ratio) {
  // For a time step that is e (relative) above the limit, one root is -1 - d: over half of n steps
  // the energy grows by exp(n d). Undamped, d = sqrt(8 e), and e = 0.0005 gives a factor of 1e11 in
  // 400 steps. With heavy centred damping, d is about 2 e / zeta: n = 10 zeta gives exp(20 e), 1.05
  // at e = 0.0025. With damping that lags or leads, d = 2 e for every zeta.
  constexpr double most = 40000.0;
  motion.steps = 400;
  if (motion.centred) motion.steps = static_cast<int>(std::min(400.0 + 10.0 * damping_ratio, most));
  motion.growth = damping_ratio > 0.05 ? 1.05 : 2.0;
}

constexpr double resolution = 1e-3;  // relative, of a bisected limit
constexpr double farthest = 1000.0;  // times 2 / omega: longest step for methods without a limit

}  // namespace

LimitRow measure_limit(ProbedBody& probed, const Method& method, const tissue::ViscousLaw& law,
                       const ContactSpring* contact) {
  const scene::Specimen& specimen = *probed.scene.specimen;
  const scene::SpringBody body(specimen.network, tissue::Kinematics::linear, law, specimen.held);
  probed.scene.scenario.solver.integrator = method.integrator;
  probed.scene.scenario.solver.damping = method.damping();
  const BodyMode with_contact =
      contact != nullptr ? highest_mode(*probed.elastic, contact) : BodyMode{};
  const BodyMode& mode = contact != nullptr ? with_contact : probed.highest;
  FreeMotion motion{.scene = &probed.scene,
                    .body = &body,
                    .centred = method == Method{},
                    .mode = mode,
                    .contact = contact};
  LimitRow row;
  row.theory = limit_theory(method, mode.frequency, law);
  const double explicit_limit = 2.0 / mode.frequency;
  Moved beyond;  // the limit
  const auto stable = [&](double step) {
    const Moved moved = move(motion, step);
    if (moved.failure != Failure::none) beyond = moved;
    return moved.failure == Failure::none;
  };
  if (row.theory) {
    choose_length(motion, damping_ratio(mode.frequency, law));
    row.measured = bisect_limit(stable, 0.5 * explicit_limit, 2e4 * explicit_limit, resolution);
    row.failure = row.measured ? beyond.failure : Failure::none;
    if (!row.measured) row.note = "no limit found";
    return row;
  }
  motion.steps = 100;
  for (double times = method.integrator == Integrator::modal ? farthest : 1.0; times <= farthest;
       times *= 10.0) {
    if (stable(times * explicit_limit)) continue;
    row.failure = beyond.failure;
    row.measured =
        bisect_limit(stable, times * explicit_limit, 2.0 * times * explicit_limit, resolution);
    if (beyond.cannot_step) row.note = "its equations have no solution";
    return row;
  }
  row.note = "stable at " + rounded_text(farthest, 4) + " times the explicit limit, " +
             rounded_text(farthest * explicit_limit, 3) + " s";
  return row;
}

namespace {

// The exact motion during one frame under a constant force.
struct Frame {
  double keep;          // factor of the velocity, exp(-b T / m)
  double glide;         // s, displacement per initial velocity
  double push, thrust;  // m/N and m/(s N), displacement and velocity per force

  explicit Frame(const Device& device) {
    const double time = device.sampled.frame;
    const double x = device.sampled.damping * time / device.mass;
    keep = std::exp(-x);
    // mean = (1 - e^-x) / x and rest = (1 - mean) / x, for small x by their series
    const double mean = x > 1e-4 ? -std::expm1(-x) / x : 1.0 - x / 2.0 + x * x / 6.0;
    const double rest = x > 1e-4 ? (1.0 - mean) / x : 0.5 - x / 6.0 + x * x / 24.0;
    glide = time * mean;
    push = time * time / device.mass * rest;
    thrust = time / device.mass * mean;
  }
  void pass(double force, double& place, double& speed) const {
    place += glide * speed + push * force;
    speed = keep * speed + thrust * force;
  }
};

}  // namespace

bool wall_gains_energy(const Device& device, double stiffness) {
  const Frame frame(device);
  const contact::SampledDevice& sampled = device.sampled;
  // At a stiffness that is e (relative) above the bound the energy grows at the rate e b / m: by
  // exp(6 e) from the second to the fourth quarter, 1.02 at e = 0.0033.
  const double settling = device.mass / (sampled.damping * sampled.frame);
  const int frames = static_cast<int>(std::clamp(12.0 * settling, 2000.0, 1e7));
  std::array<double, 4> greatest{};
  double place = 1e-3;
  double before = place;
  double speed = 0.0;
  const double first = 0.5 * stiffness * place * place;
  for (int i = 0; i < frames; ++i) {
    const double force =
        -stiffness * place - sampled.virtual_damping * (place - before) / sampled.frame;
    before = place;
    frame.pass(force, place, speed);
    const double energy = 0.5 * device.mass * speed * speed + 0.5 * stiffness * place * place;
    if (!(energy < 1e9 * first)) return true;
    double& most = greatest[as_index(4LL * i / frames)];
    most = std::max(most, energy);
  }
  return greatest[3] > 1e-20 * first && greatest[3] > 1.02 * greatest[1];
}

double chatter_share(const Device& device, double stiffness, const Push& push) {
  const Frame frame(device);
  double place = 0.0;
  double speed = 0.0;
  bool touching = false;
  int flips = 0;
  for (int i = 0; i < push.frames; ++i) {
    const bool touches = place > 0.0;
    if (2 * i >= push.frames && touches != touching) ++flips;
    touching = touches;
    frame.pass(push.force - (touches ? stiffness * place : 0.0), place, speed);
  }
  return 2.0 * flips / push.frames;
}

}  // namespace palpate::stability
