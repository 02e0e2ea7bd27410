// Explicit: the force from what is. Implicit: one scalar equation inside each linearisation.
#include "run/contact_step.h"

#include <cmath>
#include <utility>

#include "contact/hertz.h"

namespace palpate::run {
namespace {

using integrate::State;
using integrate::Vector;

double sinking(const Vector& displacement, int node) { return -displacement[3 * node + 2]; }

double read(const contact::Reading& reading, const Vector& displacement) {
  double sum = 0.0;
  for (std::size_t i = 0; i < reading.nodes.size(); ++i)
    sum += reading.weights[i] * sinking(displacement, reading.nodes[i]);
  return sum;
}

constexpr const char* no_balance =
    "no penetration balances the contact: the layer is too thin for this coupling";

}  // namespace

void SelfSinking::begin(double time_step) {
  // Kelvin-Voigt: tau s' + s = g F. The standard linear solid gives 1/r at once and the rest
  // with its creep time tau r, r = E_0 / E_inf                          docs/theory.md (12)
  if (law_.kind == tissue::Viscosity::kelvin_voigt) {
    share_ = 1.0;
    step_ = tissue::MemoryStep::exact(time_step, law_.time);
  } else if (law_.kind == tissue::Viscosity::standard_linear_solid) {
    const double ratio = 1.0 + law_.branch;
    share_ = 1.0 - 1.0 / ratio;
    step_ = tissue::MemoryStep::exact(time_step, law_.time * ratio);
  }
}

double SelfSinking::past() const {
  return share_ * (step_.keep * delayed_ + step_.begin * before_);
}

double SelfSinking::slope() const { return 1.0 - share_ + share_ * step_.end; }

void SelfSinking::finish(double elastic) {
  delayed_ = step_.keep * delayed_ + step_.begin * before_ + step_.end * elastic;
  before_ = elastic;
}

Method make_method(const scene::Scene& scene, const scene::SpringBody& body, double time_step) {
  using Integrator = scenario::Solver::Integrator;
  using Inertia = integrate::Implicit::Inertia;
  switch (scene.scenario.solver.integrator) {
    case Integrator::central_difference:
      return integrate::CentralDifference(body, time_step, scene.scenario.solver.start);
    case Integrator::backward_difference:
      return integrate::Implicit(body, Inertia::backward_difference);
    case Integrator::quasi_static: return integrate::Implicit(body, Inertia::none);
    case Integrator::modal: break;
  }
  return integrate::Modal(body);
}

ContactStepper::ContactStepper(const scene::Scene& scene, const scene::SpringBody& body)
    : scene_(&scene),
      body_(&body),
      contact_(scene::make_contact(scene)),
      self_(scene.specimen->law) {}

void ContactStepper::begin(double time_step) {
  const bool fixed_step = method_ && std::holds_alternative<integrate::CentralDifference>(*method_);
  if (!method_ || (fixed_step && time_step != time_step_))
    method_.emplace(make_method(*scene_, *body_, time_step));
  if (time_step != time_step_) responses_.clear();
  time_step_ = time_step;
  self_.begin(time_step);
}

Vector ContactStepper::load_of(const contact::Spread& spread, double force) const {
  Vector load = Vector::Zero(body_->mass().size());
  for (std::size_t j = 0; j < spread.nodes.size(); ++j)
    load[3 * spread.nodes[j] + 2] = -force * spread.shares[j];
  return load;
}

std::optional<std::string> ContactStepper::touch_mesh(const Vector& displacement, double travel,
                                                      Touch& touch) {
  // The patch of the step before: it changes by less than a step's travel.
  const contact::Reading reading = contact_.at(touch.contact_radius);
  const auto depth =
      contact::penetration(scene_->law, travel - read(reading, displacement) + self_.past(),
                           -reading.self * self_.slope());
  if (!depth) return no_balance;
  touch.travel = travel;
  touch.indentation = *depth;
  touch.force = contact::hertz::force(*depth, scene_->law.radius, scene_->law.modulus);
  touch.contact_radius = contact::hertz::contact_radius(*depth, scene_->law.radius);
  touch.load = load_of(reading.load, touch.force);
  self_.finish(reading.self * touch.force);
  return std::nullopt;
}

template <class Linearised>
std::optional<std::string> ContactStepper::balance(Linearised& method, State& state, double travel,
                                                   Touch& touch) {
  const Vector none = Vector::Zero(body_->mass().size());
  const double settled = 1e-12 * scene_->law.radius;
  Vector displacement = state.displacement;
  method.begin(state, time_step_, integrate::MemoryRule::exact);
  constexpr int most_linearisations = 100;
  for (int i = 0; i < most_linearisations; ++i) {
    if (!body_->linear()) responses_.clear();
    if (!method.linearise(displacement, none)) return "the tangent stiffness is not positive";
    Vector moved;
    double elastic = 0.0;
    Touch next = touch;
    next.travel = travel;
    constexpr int most_patches = 100;
    for (int k = 0; k < most_patches; ++k) {
      const contact::Reading reading = contact_.at(next.contact_radius);
      Vector response = none;
      for (std::size_t j = 0; j < reading.load.nodes.size(); ++j) {
        const int node = reading.load.nodes[j];
        auto known = responses_.find(node);
        if (known == responses_.end()) {
          Vector unit = none;
          unit[3 * node + 2] = -1.0;
          known = responses_.emplace(node, method.response(unit)).first;
        }
        response += reading.load.shares[j] * known->second;
      }
      const double compliance = read(reading, response) - reading.self * self_.slope();
      const auto depth = contact::penetration(
          scene_->law, travel - read(reading, method.base()) + self_.past(), compliance);
      if (!depth) return no_balance;
      const double before = next.contact_radius;
      next.indentation = *depth;
      next.force = contact::hertz::force(*depth, scene_->law.radius, scene_->law.modulus);
      next.contact_radius = contact::hertz::contact_radius(*depth, scene_->law.radius);
      next.load = load_of(reading.load, next.force);
      moved = method.base() + next.force * response;
      elastic = reading.self * next.force;
      if (std::abs(next.contact_radius - before) <= settled) break;
    }
    const double change = (moved - displacement).cwiseAbs().maxCoeff();
    displacement = moved;
    if (!std::isfinite(change)) return "the motion has left the finite numbers";
    if (body_->linear() || change <= settled) {
      method.finish(state, displacement, next.load);
      self_.finish(elastic);
      touch = std::move(next);
      return std::nullopt;
    }
  }
  return "the non-linear equations did not settle in 100 iterations";
}

std::optional<std::string> ContactStepper::step(State& state, double travel, Touch& touch) {
  if (auto* central = std::get_if<integrate::CentralDifference>(&*method_)) {
    central->step(state, touch.load);
    return touch_mesh(state.displacement, travel, touch);
  }
  if (auto* implicit = std::get_if<integrate::Implicit>(&*method_))
    return balance(*implicit, state, travel, touch);
  return balance(std::get<integrate::Modal>(*method_), state, travel, touch);
}

}  // namespace palpate::run
