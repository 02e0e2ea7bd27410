// The scalar equation of each coupling, solved with the contact's own radius.
#include "run/touch.h"

#include <cmath>
#include <utility>

#include "contact/hertz.h"

namespace palpate::run {
namespace {

using integrate::State;
using integrate::Vector;

constexpr int most_patches = 100;
constexpr const char* no_balance =
    "no penetration balances the contact: the layer is too thin for this coupling";

// The weighted sinking, m, that a reading takes from a displacement.
double read(const contact::Reading& reading, const Vector& displacement) {
  double sum = 0.0;
  for (std::size_t i = 0; i < reading.nodes.size(); ++i)
    sum -= reading.weights[i] * displacement[3 * reading.nodes[i] + 2];
  return sum;
}

Vector load_of(const contact::Spread& spread, double force, Eigen::Index freedoms) {
  Vector load = Vector::Zero(freedoms);
  for (std::size_t j = 0; j < spread.nodes.size(); ++j)
    load[3 * spread.nodes[j] + 2] = -force * spread.shares[j];
  return load;
}

// Penetration, force and radius for an approach (m) in series with a compliance (m/N).
bool close_gap(const contact::SphereLaw& law, double approach, double compliance, Touch& touch) {
  const auto depth = contact::penetration(law, approach, compliance);
  if (!depth) return false;
  touch.indentation = *depth;
  touch.force = contact::hertz::force(*depth, law.radius, law.modulus);
  touch.contact_radius = contact::hertz::contact_radius(*depth, law.radius);
  return true;
}

}  // namespace

Vector UnitResponses::under(const contact::Spread& spread, Eigen::Index freedoms,
                            const Respond& respond) {
  Vector response = Vector::Zero(freedoms);
  for (std::size_t j = 0; j < spread.nodes.size(); ++j) {
    const int node = spread.nodes[j];
    auto known = known_.find(node);
    if (known == known_.end()) {
      Vector unit = Vector::Zero(freedoms);
      unit[3 * node + 2] = -1.0;
      known = known_.emplace(node, respond(unit)).first;
    }
    response += spread.shares[j] * known->second;
  }
  return response;
}

StaticContact::StaticContact(const scene::Scene& scene, const scene::SpringBody& body)
    : scene_(&scene),
      contact_(scene::make_contact(scene)),
      held_(body.held().begin(), body.held().end()) {
  if (scene.scenario.contact.coupling != contact::Coupling::consistent) return;
  // uniaxial_test() has shown that the network is rigid.
  [[maybe_unused]] const bool factored = factors_.factor(body.stiffness());
  eigen_assert(factored);
}

std::optional<std::string> StaticContact::touch(double travel, Touch& touch) {
  const auto freedoms = static_cast<Eigen::Index>(held_.size());
  const auto respond = [&](Vector load) -> Vector {
    for (std::size_t d = 0; d < held_.size(); ++d)
      if (held_[d] != 0) load[static_cast<Eigen::Index>(d)] = 0.0;
    return factors_.solve(load);
  };
  const double settled = 1e-12 * scene_->law.radius;
  touch.travel = travel;
  for (int k = 0; k < most_patches; ++k) {
    const contact::Reading reading = contact_.at(touch.contact_radius);
    double compliance = 0.0;
    if (!reading.nodes.empty())
      compliance = read(reading, responses_.under(reading.load, freedoms, respond)) - reading.self;
    const double before = touch.contact_radius;
    if (!close_gap(scene_->law, travel, compliance, touch)) return no_balance;
    if (std::abs(touch.contact_radius - before) <= settled) {
      touch.load = load_of(reading.load, touch.force, freedoms);
      return std::nullopt;
    }
  }
  return "the contact radius did not settle in 100 iterations";
}

std::optional<std::string> SeriesContact::step(Stepper& stepper, State& state, double travel,
                                               Touch& touch) {
  if (auto* implicit = std::get_if<integrate::Implicit>(&stepper.method()))
    return balance(*implicit, stepper.time_step(), state, travel, touch);
  if (auto* modal = std::get_if<integrate::Modal>(&stepper.method()))
    return balance(*modal, stepper.time_step(), state, travel, touch);
  if (auto wrong = stepper.step(state, touch.load, touch.load, integrate::MemoryRule::exact))
    return wrong;
  // Explicit: the force follows from what is, over the patch of the step before, which changes by
  // less than a step's travel.
  const contact::Reading reading = contact_.at(touch.contact_radius);
  touch.travel = travel;
  if (!close_gap(scene_->law, travel - read(reading, state.displacement), 0.0, touch))
    return no_balance;
  touch.load = load_of(reading.load, touch.force, state.displacement.size());
  return std::nullopt;
}

template <class Linearised>
std::optional<std::string> SeriesContact::balance(Linearised& method, double time_step,
                                                  State& state, double travel, Touch& touch) {
  const Eigen::Index freedoms = body_->mass().size();
  const Vector none = Vector::Zero(freedoms);
  const double settled = 1e-12 * scene_->law.radius;
  const auto respond = [&](const Vector& load) -> Vector { return method.response(load); };
  if (time_step != responses_step_) responses_.clear();
  responses_step_ = time_step;
  Vector displacement = state.displacement;
  method.begin(state, time_step, integrate::MemoryRule::exact);
  for (int i = 0; i < most_linearisations; ++i) {
    if (!body_->linear()) responses_.clear();
    if (!method.linearise(displacement, none)) return "the tangent stiffness is not positive";
    Vector moved;
    Touch next = touch;
    next.travel = travel;
    for (int k = 0; k < most_patches; ++k) {
      const contact::Reading reading = contact_.at(next.contact_radius);
      const Vector response = responses_.under(reading.load, freedoms, respond);
      const double before = next.contact_radius;
      if (!close_gap(scene_->law, travel - read(reading, method.base()), read(reading, response),
                     next))
        return no_balance;
      next.load = load_of(reading.load, next.force, freedoms);
      moved = method.base() + next.force * response;
      if (std::abs(next.contact_radius - before) <= settled) break;
    }
    const double change = (moved - displacement).cwiseAbs().maxCoeff();
    displacement = moved;
    if (!std::isfinite(change)) return "the motion has left the finite numbers";
    if (body_->linear() || change <= settled_length) {
      method.finish(state, displacement, next.load);
      touch = std::move(next);
      return std::nullopt;
    }
  }
  return "the non-linear equations did not settle in 100 iterations";
}

}  // namespace palpate::run
