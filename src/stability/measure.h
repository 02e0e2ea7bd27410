// Measures one limit of the time step and computes it from theory.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contact/passivity.h"
#include "integrate/body.h"
#include "scenario/integrators.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"
#include "stability/stability.h"
#include "tissue/viscous.h"

namespace palpate::stability {

// A linearised explicit contact: the force -k (w.u), distributed over the nodes with weights w.
struct ContactSpring {
  double stiffness = 0.0;     // N/m
  integrate::Vector weights;  // w: nodal forces of a unit force; 0 for held degrees of freedom
};

struct BodyMode {
  double frequency = 0.0;   // rad/s
  integrate::Vector shape;  // kg^-1/2: the modal mass is 1
};

// From M^1/2 K^-1 M^1/2, to a relative residual of 1e-9. Throws std::domain_error if the body is
// not held and can move without energy.
[[nodiscard]] BodyMode lowest_mode(const integrate::Body& body);

struct FreeMotion {
  const scene::Scene* scene = nullptr;      // its scenario names the integrator
  const scene::SpringBody* body = nullptr;  // the scene's specimen with another viscous law
  bool centred = true;  // the damping force uses the mean velocity of two successive steps
  BodyMode mode;        // shape of the stroke; an irregular part of 0.3 of its size is added
  const ContactSpring* contact = nullptr;
  int steps = 400;
  // The motion counts as growing if the largest energy of its last quarter exceeds that of its
  // second quarter by more than this factor. Undamped modes beat, so that 1 would be too small.
  double growth = 2.0;
};

struct Moved {
  Failure failure = Failure::none;  // divergence, or non_finite: also where a step has no solution
  bool cannot_step = false;         // the method's equations have no solution
  int steps = 0;                    // carried out
  double before = 0.0;              // J, largest energy of the second quarter
  double after = 0.0;  // J, of the last quarter; if the motion was stopped, of the last step
};

// Computes the motion with this time step, s. Stops if the energy is `enough` times the first.
[[nodiscard]] Moved move(const FreeMotion& motion, double time_step, double enough = 1e12);

// The limit between stable and unstable time steps, s, with the relative error `resolution`: from
// `start` by doubling or halving, then by bisection. Nothing if every step up to
// `most` is stable; 0 if no step down to 1e-9 of `start` is.
[[nodiscard]] std::optional<double> bisect_limit(const std::function<bool(double)>& stable,
                                                 double start, double most, double resolution);

struct ProbedBody {
  scene::Scene scene;
  std::unique_ptr<scene::SpringBody> elastic;
  BodyMode highest;

  [[nodiscard]] int nodes() const { return scene.specimen->network.nodes(); }
};

// The case with this model and volume term, linear kinematics, the whole body, and no viscosity.
[[nodiscard]] scenario::Case bare(scenario::Case one, scenario::Model model, tissue::Volume volume);

// Builds the scene and its highest mode; `shapes` keeps the mesh. Throws like scene::build().
[[nodiscard]] std::unique_ptr<ProbedBody> make_probed_body(const scenario::Case& one,
                                                           const scenario::Family& family,
                                                           scene::SpecimenShapes& shapes);

// The scenario's model and volume term, or the model's default term. Coupled springs if the
// scenario names no model or one without a mesh.
struct ModelAndVolume {
  scenario::Solver::Model model;
  scenario::Solver::Volume volume;
  bool operator==(const ModelAndVolume&) const = default;
};
[[nodiscard]] ModelAndVolume model_and_volume(const scenario::Scenario& scenario);

// A form of damping with the values of the scenario, else of its material, else assumed values.
struct Damping {
  tissue::ViscousLaw law;
  bool assumed = false;  // whether a value is assumed
};
[[nodiscard]] Damping damping_of(const scenario::Case& one, tissue::Viscosity form);

// The contact at the largest displacement of the loading history as a spring on the mesh, with the
// force distributed over the nodes by the Hertz pressure; nothing for uniform tests.
[[nodiscard]] std::optional<ContactSpring> contact_spring(const ProbedBody& probed);

using Integrator = scenario::Solver::Integrator;

// A time integration method: an integrator of scenarios, or central differences whose damping force
// `lags`, that is, uses the velocity of the previous step, (u(t) - u(t - dt)) / dt.
struct Method {
  Integrator integrator = Integrator::central_difference;
  bool lags = false;

  bool operator==(const Method&) const = default;
  [[nodiscard]] bool explicit_steps() const { return about(integrator).explicit_steps; }
  [[nodiscard]] scenario::Solver::Damping damping() const {
    return lags ? scenario::Solver::Damping::lagged : scenario::Solver::Damping::centred;
  }
  [[nodiscard]] std::string name() const {
    return lags ? "lagged_velocity" : about(integrator).word;
  }
};
inline constexpr Method lagged{.lags = true};

// Every method: the integrators in the order of their words, then `lagged`.
[[nodiscard]] std::vector<Method> methods();

// The limit of the time step, s, for a body with the highest `frequency` omega (1/s). With
// C = drag + tau omega^2 (1/s) and zeta = C / (2 omega):
//   central_difference   dt omega = 2
//   lagged_velocity      dt omega = 2 (sqrt(1 + zeta^2) - zeta);
//                        with Kelvin-Voigt dt = -tau + sqrt(tau^2 + 4 / omega^2)
//   semi_implicit_euler  dt omega = 2 (sqrt(1 + zeta^2) + zeta)
// each from the root -1 of the characteristic polynomial. A Maxwell branch contributes the fraction
// (2 / x) tanh(x / 2) of its stiffness, x = dt / time, as its memory is exact for linear courses:
//   dt^2 omega^2 (1 + sum of ratio (2 / x) tanh(x / 2)) + ... = 4 + ...
// The limit thus lies between those of the unrelaxed and of the relaxed tissue.
// Nothing for methods without a limit.              docs/theory.md [explicit_limit], [branch_limit]
[[nodiscard]] std::optional<double> limit_theory(const Method& method, double frequency,
                                                 const tissue::ViscousLaw& law);

// The damping ratio of a mode of `frequency` (1/s) by nodal drag and Kelvin-Voigt dashpots.
[[nodiscard]] double damping_ratio(double frequency, const tissue::ViscousLaw& law);

// |A|, the factor by which one step changes the amplitude of an undamped mode, x = omega dt: 1 for
// methods that only shift its phase, 1 / sqrt(1 + x^2) for implicit Euler, |R(i x)| for TR-BDF2.
// Nothing for methods without inertia and beyond a limit.                  docs/theory.md [tr_bdf2]
[[nodiscard]] std::optional<double> amplification(Integrator integrator, double omega_step);

// The factor by which one step of central differences beyond the limit, x = omega dt > 2, increases
// the amplitude of an undamped mode: the larger root of s^2 - (x^2 - 2) s + 1.
[[nodiscard]] double growth_beyond(double omega_step);

// The limit of `method` for the body with the viscous law `law`: measured, by theory, and what
// fails beyond it, with a note. `contact` may be null. `modal`, whose decomposition is repeated in
// every trial, is tried with one time step only.
[[nodiscard]] LimitRow measure_limit(ProbedBody& probed, const Method& method,
                                     const tissue::ViscousLaw& law, const ContactSpring* contact);

// A haptic device on a virtual wall whose force changes once per frame.
// m x'' + b x' = F: the device without a hand.
struct Device {
  double mass = 0.045;  // kg, of a desktop arm according to its data sheet
  contact::SampledDevice sampled;
};

// Whether the energy of the device on a wall of this stiffness (N/m) grows. The force is constant
// during a frame, in which the motion is exact. The wall is bilateral: the motion is linear.
[[nodiscard]] bool wall_gains_energy(const Device& device, double stiffness);

// The fraction of the last `frames` / 2 frames in which contact begins or ends while a hand presses
// with a constant `force` (N) on a wall of this stiffness (N/m) that only pushes.
struct Push {
  double force = 1.0;  // N
  int frames = 20000;
};
[[nodiscard]] double chatter_share(const Device& device, double stiffness, const Push& push);

// The context that the functions of a stability map share while it is measured.
struct Survey {
  const scenario::Case* one = nullptr;
  const scenario::Family* family = nullptr;
  const Told* told = nullptr;
  scene::SpecimenShapes shapes;     // of all bodies
  ModelAndVolume given;             // of the scenario
  std::unique_ptr<ProbedBody> own;  // the scenario's specimen
  StabilityMap map;
  int done = 0;     // measurements
  int planned = 1;  // estimated number of measurements

  // For a large mesh other models are measured without damping only, and axes with fewer settings.
  [[nodiscard]] bool large() const { return own->nodes() > 200; }

  // Call before every measurement: reports `what` to `told`. Throws Stopped.
  void go_on(const std::string& what);

  // The body of the scenario with the model and volume term `on`, after `change`.
  [[nodiscard]] std::unique_ptr<ProbedBody> make_body(
      const ModelAndVolume& on, const std::function<void(scenario::Scenario&)>& change = {});
};

// The parts of the map.
void survey_models(Survey& survey);
void survey_axes(Survey& survey);
void probe_time(Survey& survey);   // divergence, non_finite, drift
void probe_shape(Survey& survey);  // inversion, false equilibrium, locking
void probe_touch(Survey& survey);  // chatter

// The longest step (s) that was stable with central differences and the scenario's own model.
[[nodiscard]] std::optional<double> longest_step(const Survey& survey);

// The findings of the map as sentences, for stdout.
[[nodiscard]] std::vector<std::string> map_sentences(const Survey& survey);

}  // namespace palpate::stability
