// Steps of `consistent` in which the tissue's inertia reaches the force: docs/theory.md (74).
#include <algorithm>

#include "run/pressed_mesh.h"

namespace palpate::run {

using integrate::MemoryRule;
using integrate::Vector;

// What a load (N) adds to the end of an implicit step. In modes with inertia it acts all along it.
Vector PressedMesh::respond(const Vector& unit) {
  if (auto* implicit = std::get_if<integrate::Implicit>(&stepper_->method()))
    return implicit->response(unit);
  if (auto* staged = std::get_if<integrate::TrBdf2>(&stepper_->method()))
    return staged->response(unit);
  auto& modal = std::get<integrate::Modal>(stepper_->method());
  if (!inertia_) return modal.response(unit);
  // Modes are linear: there is always an answer.
  (void)modal.linearise(state_.displacement, Vector::Zero(unit.size()));
  const Vector alone = modal.base();
  (void)modal.linearise(state_.displacement, unit);
  return modal.base() - alone;
}

// Friction as it acts now, N.
Vector PressedMesh::drag_load(const Touch& touch) const {
  Touch rubbing = touch;
  for (SphereContact& contact : rubbing.contacts) contact.force = 0.0;
  return Contacts::load(rubbing, answer());
}

std::optional<std::string> PressedMesh::step_with_inertia(const Vec3& finger,
                                                          ContactHistory& history, Touch& touch) {
  if (auto* implicit = std::get_if<integrate::Implicit>(&stepper_->method()))
    return step_implicitly(*implicit, finger, history, touch);
  if (auto* staged = std::get_if<integrate::TrBdf2>(&stepper_->method()))
    return step_implicitly(*staged, finger, history, touch);
  if (auto* modal = std::get_if<integrate::Modal>(&stepper_->method()))
    return step_in_modes(*modal, finger, history, touch);
  if (auto wrong = stepper_->step(state_, load_, load_, MemoryRule::exact)) return wrong;
  return meet(finger, {.displacement = &state_.displacement}, history, touch);
}

// The contacts with a mesh in motion; leaves their load in load_.
std::optional<std::string> PressedMesh::meet(const Vec3& finger, MovingMesh moving,
                                             ContactHistory& history, Touch& touch) {
  MeshAnswer mesh = answer();
  mesh.influence = &*influence_;
  if (one_tissue_) mesh.one_tissue = &*one_tissue_;
  const bool viscous = history.relaxes();
  // Friction acts as it did; what it does in statics is no motion.
  const Vector still = viscous ? crept_.load() : drag_load(touch);
  moving.still = &still;
  moving.still_has_past = viscous;
  moving.slope = slope_;
  moving.time_step = stage_step_;
  mesh.moving = &moving;
  if (auto wrong = contacts_.find(finger, mesh, touch)) return wrong;
  if (viscous) {
    for (SphereContact& contact : touch.contacts) contact.force = contact.elastic;
    history.pass(*scene_, stage_step_, touch);
    for (SphereContact& contact : touch.contacts)
      contact.force = std::max(0.0, contact.force + contact.radiated);
    rub(*scene_, Vec3::Zero(), touch);
    contacts_.keep_forces(touch);
  }
  load_ = Contacts::load(touch, mesh);
  if (viscous) crept_.pass(load_);
  finer_ = Contacts::finer_load(touch, mesh);
  return std::nullopt;
}

template <class Linearised>
std::optional<std::string> PressedMesh::step_implicitly(Linearised& method, const Vec3& finger,
                                                        ContactHistory& history, Touch& touch) {
  const Vector friction = drag_load(touch);
  method.begin(state_, time_step_, MemoryRule::first_order);
  if (!method.linearise(state_.displacement, friction))
    return "the tangent stiffness is not positive";
  const Vector base = method.base();
  if (auto wrong = meet(finger, {.displacement = &base, .response = &*response_}, history, touch))
    return wrong;
  const Vector end = base + response_->to(load_ - friction);
  method.finish(state_, end, load_);
  return std::nullopt;
}

// The mean of the loads at both ends acts all along the step: what it gives the mesh is then
// what the contact's spring loses, mode by mode exactly, and no step is too long to be stable.
std::optional<std::string> PressedMesh::step_in_modes(integrate::Modal& method, const Vec3& finger,
                                                      ContactHistory& history, Touch& touch) {
  const Vector load_before = load_;
  method.begin(state_, time_step_, MemoryRule::held);
  const Vector friction = drag_load(touch);
  (void)method.linearise(state_.displacement, 0.5 * (load_before + friction));
  const Vector base = method.base();
  if (auto wrong = meet(finger, {.displacement = &base, .response = &*response_, .share = 0.5},
                        history, touch))
    return wrong;
  const Vector end = base + response_->to(0.5 * (load_ - friction));
  method.finish(state_, end, 0.5 * (load_before + load_));
  return std::nullopt;
}

}  // namespace palpate::run
