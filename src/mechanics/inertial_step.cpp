// Solver steps of `consistent` where the tissue's inertia reaches the force: docs/theory.md (74).
#include <algorithm>

#include "mechanics/pressed_mesh.h"

namespace palpate::mechanics {

using integrate::MemoryRule;
using integrate::Vector;

// The displacement (m) that a load (N) adds at the end of an implicit or modal step. In modal steps
// with inertia the load acts during the whole step.
void PressedMesh::respond(const Vector& unit, Vector& moved) {
  if (auto* implicit = std::get_if<integrate::Implicit>(&stepper_->method()))
    return implicit->response(unit, moved);
  if (auto* staged = std::get_if<integrate::TrBdf2>(&stepper_->method()))
    return staged->response(unit, moved);
  auto& modal = std::get<integrate::Modal>(stepper_->method());
  if (!inertia_) return modal.response(unit, moved);
  // Modal bodies are linear: linearise() cannot fail.
  alone_.setZero(unit.size());
  (void)modal.linearise(state_.displacement, alone_);
  alone_ = modal.base();
  (void)modal.linearise(state_.displacement, unit);
  moved = modal.base() - alone_;
}

// The load of the present friction without normal forces, N.
void PressedMesh::find_drag_load(const Touch& touch) {
  rubbing_ = touch;
  for (SphereContact& contact : rubbing_.contacts) contact.force = 0.0;
  Contacts::load(rubbing_, answer(), drag_load_);
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

// Finds the contacts of the finger with a moving mesh; leaves their load in load_.
std::optional<std::string> PressedMesh::meet(const Vec3& finger, MovingMesh moving,
                                             ContactHistory& history, Touch& touch) {
  MeshAnswer mesh = answer();
  mesh.influence = &*influence_;
  mesh.beyond = &*beyond_;
  const bool viscous = history.relaxes();
  // Friction acts as in the previous step; its static displacement does not count as motion.
  if (!viscous) find_drag_load(touch);
  moving.still = viscous ? &crept_.load() : &drag_load_;
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
  Contacts::load(touch, mesh, load_);
  if (viscous) crept_.pass(load_);
  Contacts::finer_load(touch, mesh, finer_);
  return std::nullopt;
}

template <class Linearised>
std::optional<std::string> PressedMesh::step_implicitly(Linearised& method, const Vec3& finger,
                                                        ContactHistory& history, Touch& touch) {
  find_drag_load(touch);
  method.begin(state_, time_step_, MemoryRule::first_order);
  if (!method.linearise(state_.displacement, drag_load_))
    return "the tangent stiffness is not positive";
  reached_ = method.base();
  if (auto wrong =
          meet(finger, {.displacement = &reached_, .response = &*response_}, history, touch))
    return wrong;
  further_ = load_ - drag_load_;
  response_->to(further_, moved_);
  moved_ += reached_;
  method.finish(state_, moved_, load_);
  return std::nullopt;
}

// The mean of the loads at both ends acts during the whole step. The mesh then receives exactly the
// work that the contact's spring loses, mode by mode, and every step size is stable.
std::optional<std::string> PressedMesh::step_in_modes(integrate::Modal& method, const Vec3& finger,
                                                      ContactHistory& history, Touch& touch) {
  method.begin(state_, time_step_, MemoryRule::held);
  find_drag_load(touch);
  further_ = 0.5 * (load_before_ + drag_load_);
  (void)method.linearise(state_.displacement, further_);
  reached_ = method.base();
  if (auto wrong = meet(finger, {.displacement = &reached_, .response = &*response_, .share = 0.5},
                        history, touch))
    return wrong;
  further_ = 0.5 * (load_ - drag_load_);
  response_->to(further_, moved_);
  moved_ += reached_;
  further_ = 0.5 * (load_before_ + load_);
  method.finish(state_, moved_, further_);
  return std::nullopt;
}

}  // namespace palpate::mechanics
