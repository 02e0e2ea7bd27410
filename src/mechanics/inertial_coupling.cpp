// Steps of a mesh whose motion reaches the force.
#include "mechanics/couplings.h"
#include "mechanics/monitor.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace palpate::mechanics {
namespace {

using integrate::MemoryRule;
using integrate::Vector;

// The memory rule of the mesh's integrator.
MemoryRule memory_rule(const scene::Scene& scene) {
  return scene.scenario.solver.integrator == scenario::Solver::Integrator::backward_difference
             ? MemoryRule::first_order
             : MemoryRule::exact;
}

// The largest displacement of any node of the skin, m.
double rise(const MovingPart& part, const Vector& displacement) {
  double most = 0.0;
  for (const int node : part.nodes)
    if (node >= 0) most = std::max(most, displacement.segment<3>(3 * node).squaredNorm());
  return std::sqrt(most);
}

}  // namespace

ConsistentWithInertia::ConsistentWithInertia(SkinContacts& contacts, MovingPart& moving)
    : OnMesh(contacts, moving),
      statics(contacts, moving),
      inertia_(moving),
      crept_(moving.scene->specimen->law, memory_rule(*moving.scene)) {}

void ConsistentWithInertia::begin_part(const std::vector<Eigen::Index>& from) {
  statics.begin_part(from);
  inertia_.statics.forget();
  inertia_.response.forget();
  crept_.renumber(from);
}

void ConsistentWithInertia::make_ready() {
  statics.make_ready();
  inertia_.make_room(skin->most_contacts());
  inertia_.statics.ask_all();
  if (part->keeps_responses()) inertia_.response.ask_all();
}

// Stages of different durations follow each other only in a method with two stages, where exp() is
// therefore called in the step, twice per branch and stage.
void ConsistentWithInertia::set_stage(double duration) {
  if (duration == stage_) return;
  stage_ = duration;
  crept_.set_step(duration);
  slope_ = 1.0;
  for (const contact::Branch& branch : part->scene->relaxation.branches)
    slope_ += branch.ratio * (1.0 - tissue::MemoryStep::exact(duration, branch.time).end);
}

std::optional<std::string> ConsistentWithInertia::find(const Motion& motion, const StepTo& to) {
  // Oscillating skin may reach a finger that does not touch it at rest. Places that the finger
  // touches neither on the skin at rest nor on the moving skin are left out.
  skin->detect(to.finger, nullptr, rise(*part, motion.displacement))
      .erase_if([&](SphereContact& contact) {
        if (contact.approach > 0.0) return false;
        contact.patch.axis = contact.patch.normal.unitOrthogonal();
        skin->spread_wide(contact);
        return contact.approach - inertia_.sunk(motion.displacement, contact) <= 0.0;
      });
  return skin->find(
      to.finger, to.touch,
      [&](Touch& now) -> std::optional<std::string> {
        for (SphereContact& contact : now.contacts) skin->spread_wide(contact);
        const auto complete = [&](std::vector<double>& approaches,
                                  Eigen::MatrixXd& compliance) -> const Eigen::MatrixXd& {
          statics.find_sinking(now.contacts, compliance);
          return inertia_.complete(motion, now.contacts, compliance, approaches);
        };
        do {
          inertia_.begin(motion, now.contacts);
          if (auto wrong = skin->settle(now, complete)) return wrong;
        } while (inertia_.release(motion, now.contacts));
        inertia_.remember(motion, skin->compliance(), now.contacts);
        return std::nullopt;
      },
      statics.body());
}

// Finds the contacts of the finger with a moving mesh; leaves their load in the part's `load`.
std::optional<std::string> ConsistentWithInertia::meet(const Vector& displacement, double share,
                                                       const StepTo& to) {
  const bool viscous = to.history.relaxes();
  // Friction acts as in the previous step; its static displacement does not count as motion.
  if (!viscous) drag_load(to.touch, *part, drag_);
  const Motion motion{.displacement = displacement,
                      .still = viscous ? crept_.load() : drag_,
                      .still_has_past = viscous,
                      .share = share,
                      .slope = slope_,
                      .time_step = stage_};
  if (auto wrong = find(motion, to)) return wrong;
  if (viscous) {
    for (SphereContact& contact : to.touch.contacts) contact.force = contact.elastic;
    to.history.pass(*part->scene, stage_, to.touch);
    for (SphereContact& contact : to.touch.contacts)
      contact.force = std::max(0.0, contact.force + contact.radiated);
    rub(*part->scene, Vec3::Zero(), to.touch);
    inertia_.keep_forces(to.touch);
  }
  contact_load(to.touch, *part, part->load);
  if (viscous) crept_.pass(part->load);
  statics.load_finely(to.touch);
  return std::nullopt;
}

// In modal steps the mean of the loads at both ends acts during the whole step. The mesh then
// receives exactly the work that the contact's spring loses, mode by mode, and every step size is
// stable.
template <class Linearised>
std::optional<std::string> ConsistentWithInertia::step_with(Linearised& method, const StepTo& to) {
  constexpr bool modal = std::is_same_v<Linearised, integrate::Modal>;
  constexpr double share = modal ? 0.5 : 1.0;
  const auto act = [&](const Vector& at_end) {
    if constexpr (modal)
      acting_ = share * (part->load_before + at_end);
    else
      acting_ = at_end;
  };
  drag_load(to.touch, *part, drag_);
  act(drag_);
  method.begin(part->state, part->time_step, modal ? MemoryRule::held : MemoryRule::first_order);
  if (!method.linearise(part->state.displacement, acting_)) return not_positive;
  reached_ = method.base();
  if (auto wrong = meet(reached_, share, to)) return wrong;
  acting_ = share * (part->load - drag_);
  inertia_.response.to(acting_, moved_);
  moved_ += reached_;
  act(part->load);
  method.finish(part->state, moved_, acting_);
  return std::nullopt;
}

std::optional<std::string> ConsistentWithInertia::step(const StepTo& to) {
  set_stage(to.duration);
  return std::visit(
      [&](auto& method) -> std::optional<std::string> {
        if constexpr (requires { method.base(); }) {
          return step_with(method, to);
        } else {
          if (auto wrong =
                  part->stepper->step(part->state, part->load, part->load, MemoryRule::exact))
            return wrong;
          return meet(part->state.displacement, 0.0, to);
        }
      },
      part->stepper->method());
}

}  // namespace palpate::mechanics
