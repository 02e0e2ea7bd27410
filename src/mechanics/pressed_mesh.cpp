// Solver steps for each coupling, and the moving part of the specimen, which follows the contact.
#include "mechanics/pressed_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/first_touch.h"

namespace palpate::mechanics {
namespace {

using contact::Coupling;
using integrate::MemoryRule;
using integrate::State;
using integrate::Vector;

// The memory rule of the mesh's integrator.
MemoryRule memory_rule(const scene::Scene& scene) {
  return scene.scenario.solver.integrator == scenario::Solver::Integrator::backward_difference
             ? MemoryRule::first_order
             : MemoryRule::exact;
}

}  // namespace

PressedMesh::PressedMesh(const scene::Scene& scene)
    : scene_(&scene),
      specimen_(&*scene.specimen),
      contacts_(scene),
      inertia_(scene::inertia_reaches_force(scene.scenario)),
      crept_(specimen_->law, memory_rule(scene)) {
  const auto& rings = scene.scenario.solver.rings;
  if (!rings) {
    take(tissue::whole_part(specimen_->network));
    return;
  }
  const auto& corners =
      specimen_->surface->surface().triangles[as_index(scene::first_touch(scene).at.triangle)];
  std::vector<int> start;
  for (const int vertex : corners) start.push_back(specimen_->skin[as_index(vertex)]);
  take(tissue::part_around(specimen_->network, start, *rings));
}

// Makes `part` the moving part. Nodes and springs that were in the
// previous part too keep their state.
void PressedMesh::take(tissue::Part part) {
  const tissue::Part before = std::exchange(part_, std::move(part));
  const State old = std::exchange(state_, {});
  std::vector<int> number(specimen_->network.rest.size(), -1);
  for (std::size_t i = 0; i < part_.nodes.size(); ++i)
    number[as_index(part_.nodes[i])] = static_cast<int>(i);
  skin_nodes_.clear();
  for (const int node : specimen_->skin) skin_nodes_.push_back(number[as_index(node)]);

  std::vector<char> held(3 * part_.nodes.size());
  for (std::size_t d = 0; d < held.size(); ++d)
    held[d] =
        part_.edge[d / 3] != 0 ? 1 : specimen_->held[3 * as_index(part_.nodes[d / 3]) + d % 3];
  body_.emplace(part_.network, specimen_->kinematics, specimen_->law, held);
  const auto freedoms = static_cast<Eigen::Index>(held.size());
  state_.time = old.time;
  state_.displacement = Vector::Zero(freedoms);
  state_.velocity = Vector::Zero(freedoms);
  for (std::size_t i = 0; i < before.nodes.size(); ++i) {
    const int now = number[as_index(before.nodes[i])];
    if (now < 0 || part_.edge[as_index(now)] != 0) continue;
    const auto from = 3 * static_cast<Eigen::Index>(i);
    state_.displacement.segment<3>(3 * now) = old.displacement.segment<3>(from);
    state_.velocity.segment<3>(3 * now) = old.velocity.segment<3>(from);
  }
  state_.memory = body_->memory_at(state_.displacement);
  for (std::size_t s = 0; s < before.springs.size(); ++s) {
    const auto now =
        std::lower_bound(part_.springs.begin(), part_.springs.end(), before.springs[s]);
    if (now == part_.springs.end() || *now != before.springs[s]) continue;
    body_->inherit(old.memory, s, as_index(now - part_.springs.begin()), state_.memory);
  }
  std::vector<Eigen::Index> freedom_before(held.size(), -1);
  for (std::size_t i = 0; i < before.nodes.size(); ++i) {
    const int now = number[as_index(before.nodes[i])];
    if (now < 0) continue;
    for (int axis = 0; axis < 3; ++axis)
      freedom_before[as_index(3 * now + axis)] = 3 * static_cast<Eigen::Index>(i) + axis;
  }
  crept_.renumber(freedom_before);
  finer_.resize(0);
  load_ = Vector::Zero(freedoms);
  if (monitor_)
    monitor_->go_on(*body_, state_);
  else
    monitor_.emplace(*body_);
  stepper_.emplace(*scene_, *body_);
  if (time_step_ > 0.0) stepper_->set_step(time_step_);

  influence_.reset();
  beyond_.reset();
  if (scene_->scenario.contact.coupling == Coupling::one_way) return;
  const auto response = [this](const Vector& unit, Vector& moved) { respond(unit, moved); };
  if (inertia_) response_.emplace(response);
  if (!inertia_ && !forces_follow_finger()) {
    influence_.emplace(response);
    return;
  }
  beyond_.emplace(*scene_, part_, body_->held(),
                  scene::deepest_travel(scene_->scenario, scene_->law()));
  factored_ = false;
  if (!inertia_) return;
  factor();
  influence_.emplace([this](const Vector& unit, Vector& moved) {
    moved = unit;
    for (Eigen::Index d = 0; d < moved.size(); ++d)
      if (body_->held()[as_index(d)] != 0) moved[d] = 0.0;
    factors_.solve(moved, moved);
  });
}

// Factors the static stiffness, once for every moving part.
void PressedMesh::factor() {
  if (factored_) return;
  // Positive definite, as the measurement of the network's modulus has shown.
  factored_ = factors_.factor(body_->stiffness());
  eigen_assert(factored_);
}

void PressedMesh::set_step(double time_step) {
  if (time_step != time_step_) {
    if (response_) response_->forget();
    if (influence_ && !inertia_ && !forces_follow_finger()) influence_->forget();
  }
  time_step_ = time_step;
  stepper_->set_step(time_step);
  const auto* modal = std::get_if<integrate::Modal>(&stepper_->method());
  in_modes_ = modal != nullptr && modal->passes_alone() && forces_follow_finger() &&
              !scene_->scenario.solver.rings &&
              scene_->scenario.contact.curvature_on == scenario::Contact::CurvatureOn::rest;
  set_stage(time_step);
}

// Sets the time (s) to the next solution of the contacts. In a method with two stages this is part
// of the step, where exp() is called twice per branch.
void PressedMesh::set_stage(double duration) {
  stage_step_ = duration;
  crept_.set_step(duration);
  slope_ = 1.0;
  for (const contact::Branch& branch : scene_->relaxation.branches)
    slope_ += branch.ratio * (1.0 - tissue::MemoryStep::exact(duration, branch.time).end);
}

MeshAnswer PressedMesh::answer() const {
  MeshAnswer mesh{.nodes = skin_nodes_,
                  .freedoms = state_.displacement.size(),
                  // Steps in modes alone are frames in which every loaded node costs time.
                  .wide = beyond_ && !in_modes_};
  if (scene_->scenario.contact.curvature_on == scenario::Contact::CurvatureOn::deformed)
    mesh.shape = &state_.displacement;
  return mesh;
}

bool PressedMesh::forces_follow_finger() const {
  const Coupling coupling = scene_->scenario.contact.coupling;
  return coupling == Coupling::one_way || (coupling == Coupling::consistent && !inertia_);
}

std::optional<std::string> PressedMesh::try_out(const Vec3& finger, Touch& touch) {
  MeshAnswer mesh = answer();
  if (influence_) mesh.influence = &*influence_;
  if (beyond_) mesh.beyond = &*beyond_;
  return contacts_.find(finger, mesh, touch);
}

std::optional<std::string> PressedMesh::step_freely(const Vec3& finger, ContactHistory& history,
                                                    Touch& touch) {
  if (auto wrong = try_out(finger, touch)) return wrong;
  history.pass(*scene_, time_step_, touch);
  if (beyond_ && !in_modes_) Contacts::finer_load(touch, answer(), finer_);
  return move(touch);
}

std::optional<std::string> PressedMesh::move(const Touch& touch) {
  if (in_modes_) {
    auto& modal = std::get<integrate::Modal>(stepper_->method());
    Contacts::push(touch, answer(), [&](int node, const Vec3& force) {
      for (int axis = 0; axis < 3; ++axis) modal.press(3 * node + axis, force[axis]);
    });
    modal.pass(state_, time_step_);
    shown_ = false;
    return std::nullopt;
  }
  Contacts::load(touch, answer(), load_after_);
  auto wrong = stepper_->step(state_, load_, load_after_, integrate::MemoryRule::exact);
  load_.swap(load_after_);
  return wrong;
}

std::optional<std::string> PressedMesh::step_in_series(const Vec3& finger, Touch& touch) {
  if (auto* implicit = std::get_if<integrate::Implicit>(&stepper_->method()))
    return balance(*implicit, finger, touch);
  if (auto* staged = std::get_if<integrate::TrBdf2>(&stepper_->method()))
    return balance(*staged, finger, touch);
  if (auto* modal = std::get_if<integrate::Modal>(&stepper_->method()))
    return balance(*modal, finger, touch);
  if (auto wrong = stepper_->step(state_, load_, load_, integrate::MemoryRule::exact)) return wrong;
  // Explicit: the force follows from the present displacement over the patch of the previous step;
  // the patch changes by less than a step's travel.
  MeshAnswer mesh = answer();
  mesh.displacement = &state_.displacement;
  if (auto wrong = contacts_.find(finger, mesh, touch)) return wrong;
  Contacts::load(touch, mesh, load_);
  return std::nullopt;
}

template <class Linearised>
std::optional<std::string> PressedMesh::balance(Linearised& method, const Vec3& finger,
                                                Touch& touch) {
  MeshAnswer mesh = answer();
  mesh.influence = &*influence_;
  Vector& displacement = reached_;
  displacement = state_.displacement;
  // Friction acts as in the previous step; the contact equations give the normal forces.
  find_drag_load(touch);
  const Vector& friction = drag_load_;
  // A node in contact takes any force, and a force that is linear in each step would oscillate
  // about the correct one.                                             docs/theory.md, below (73)
  const bool swings = scene_->scenario.contact.coupling == Coupling::resolved;
  method.begin(state_, time_step_, swings ? MemoryRule::first_order : MemoryRule::exact);
  for (int i = 0; i < most_linearisations; ++i) {
    if (!body_->linear()) influence_->forget();
    if (!method.linearise(displacement, friction)) return "the tangent stiffness is not positive";
    mesh.displacement = &method.base();
    next_ = touch;
    if (auto wrong = contacts_.find(finger, mesh, next_)) return wrong;
    Vector& load = load_after_;
    Contacts::load(next_, mesh, load);
    further_ = load - friction;
    method.response(further_, moved_);
    moved_ += method.base();
    const double change = (moved_ - displacement).cwiseAbs().maxCoeff();
    displacement = moved_;
    if (!std::isfinite(change)) return "the motion is no longer finite";
    if (body_->linear() || change <= settled_length) {
      method.finish(state_, displacement, load);
      std::swap(touch, next_);
      load_ = load;
      return std::nullopt;
    }
  }
  return not_settled;
}

std::optional<std::string> PressedMesh::step(const Vec3& finger, double time,
                                             ContactHistory& history, Touch& touch) {
  if (in_modes_) {
    state_.time = time;
    return step_freely(finger, history, touch);
  }
  before_ = state_;
  load_before_ = load_;
  const auto go = [&](const Vec3& to) {
    return inertia_                 ? step_with_inertia(to, history, touch)
           : forces_follow_finger() ? step_freely(to, history, touch)
                                    : step_in_series(to, touch);
  };
  if (auto* staged = std::get_if<integrate::TrBdf2>(&stepper_->method());
      staged != nullptr && !forces_follow_finger()) {
    constexpr double part = integrate::TrBdf2::first_part;
    const Vec3 from = touch.finger;
    staged->start_under(load_);
    set_stage(part * time_step_);
    if (auto wrong = go(from + part * (finger - from))) return wrong;
    set_stage((1.0 - part) * time_step_);
  }
  if (auto wrong = go(finger)) return wrong;
  state_.time = time;  // a sum of steps would accumulate rounding errors
  // Modal steps with inertia are loaded by the mean load during the whole step.
  const bool mean = inertia_ && std::holds_alternative<integrate::Modal>(stepper_->method());
  if (mean) further_ = 0.5 * (load_before_ + load_);
  auto unstable = mean ? monitor_->step(before_, state_, further_, further_)
                       : monitor_->step(before_, state_, load_before_, load_);
  if (unstable) return unstable;
  if (scene_->scenario.solver.rings) follow(touch);
  return std::nullopt;
}

// Chooses another part if the contact has moved.
void PressedMesh::follow(const Touch& touch) {
  start_.clear();
  for (const SphereContact& contact : touch.contacts)
    for (const int vertex : contact.load.vertices)
      start_.push_back(specimen_->skin[as_index(vertex)]);
  if (start_.empty()) return;
  const int rings = *scene_->scenario.solver.rings;
  tissue::reach_around(specimen_->network, start_, rings, reach_);
  if (tissue::spans(part_, reach_)) return;
  take(tissue::part_around(specimen_->network, start_, rings));
  Contacts::load(touch, answer(), load_);
}

Vector PressedMesh::of_specimen(const Vector& of_part) const {
  Vector all = Vector::Zero(3 * specimen_->network.nodes());
  for (std::size_t i = 0; i < part_.nodes.size(); ++i)
    all.segment<3>(3 * part_.nodes[i]) = of_part.segment<3>(3 * static_cast<Eigen::Index>(i));
  return all;
}

// Computes state_ and the energies from the modal coordinates.
void PressedMesh::show() {
  if (shown_) return;
  const auto& modal = std::get<integrate::Modal>(stepper_->method());
  modal.show(state_);
  const auto energies = modal.energies();
  monitor_->take_over(energies.work, energies.lost, energies.held);
  shown_ = true;
}

const State& PressedMesh::state() {
  show();
  return state_;
}

Vector PressedMesh::displacement() {
  show();
  if (finer_.size() == 0) return of_specimen(state_.displacement);
  Vector load = finer_;
  for (Eigen::Index d = 0; d < load.size(); ++d)
    if (body_->held()[as_index(d)] != 0) load[d] = 0.0;
  factor();
  return of_specimen(state_.displacement + factors_.solve(load));
}

std::vector<double> PressedMesh::errors(const SphereContact& contact) {
  contact::Patch patch = contact.patch;
  patch.a = patch.b = patch.radius();
  return beyond_->errors(patch);
}

bool PressedMesh::inverted() {
  // There the mesh is loaded through the narrow patch, but its motion does not reach the force.
  if (in_modes_ && beyond_) return false;
  show();
  return tissue::inverted(specimen_->mesh, of_specimen(state_.displacement));
}

double PressedMesh::edge_reaction() {
  Vector force;
  body_->force(state_.displacement, state_.memory, force);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < part_.nodes.size(); ++i)
    if (part_.edge[i] != 0) sum += force.segment<3>(3 * static_cast<Eigen::Index>(i));
  return sum.norm();
}

double PressedMesh::imbalance() {
  show();
  return monitor_->imbalance();
}

}  // namespace palpate::mechanics
