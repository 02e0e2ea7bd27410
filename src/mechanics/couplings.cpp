// Steps of a mesh under a finger, from the coupling that knows nothing of the mesh to those that
// solve for both together; the compliances C_ij of docs/theory.md [contacts].
#include "mechanics/couplings.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "contact/hertz.h"
#include "mechanics/monitor.h"
#include "scenario/integrators.h"
#include "scene/time_plan.h"

namespace palpate::mechanics {
namespace {

// Sum of share * of(node) over a spread; nodes below 0 do not move.
template <class Of>
double over_nodes(const MovingPart& part, const contact::Spread& spread, const Of& of) {
  double sum = 0.0;
  for (std::size_t k = 0; k < spread.vertices.size(); ++k) {
    const int node = part.node_of(spread.vertices[k]);
    if (node >= 0) sum += spread.shares[k] * of(node);
  }
  return sum;
}

}  // namespace

ContactInertia::ContactInertia(MovingPart& part)
    : statics(part, Response::moving_statics),
      response(part, Response::whole_step),
      part_(&part),
      radiation_(scene::radiation_compliance(*part.scene)),
      return_time_(2.0 * (part.scene->specimen->high - part.scene->specimen->low).z() /
                   scene::shear_speed(part.scene->scenario.tissue)) {}

void ContactInertia::make_room(std::size_t contacts) {
  const auto size = static_cast<Eigen::Index>(contacts);
  for (Eigen::MatrixXd* matrix : {&whole_compliance_, &moving_by_force_, &still_by_force_})
    clear_corner(*matrix, size);
  for (Eigen::VectorXd* vector : {&softness_, &motion_}) vector->setZero(size);
  near_.reserve(contacts);
  past_.reserve(2 * contacts);
  parted_.reserve(contacts);
  pressed_.reserve(3 * contacts * contact::most_shares);
}

double ContactInertia::sunk(const integrate::Vector& displacement,
                            const SphereContact& contact) const {
  return over_nodes(*part_, contact.wide, [&](int node) {
    return -contact.patch.normal.dot(displacement.segment<3>(3 * node));
  });
}

// Mean surface displacement under the wide patch of `own` per newton on the wide patch of
// `pressed`, m/N.
double ContactInertia::sunk_by(Influence& by, const SphereContact& own,
                               const SphereContact& pressed) const {
  return over_nodes(*part_, own.wide, [&](int at) {
    return over_nodes(*part_, pressed.wide, [&](int node) {
      return by.between(-own.patch.normal, at, -pressed.patch.normal, node);
    });
  });
}

// Mean static surface displacement under the wide patch of `own` by a load (N), m. The influence is
// symmetric.
double ContactInertia::sunk_by(const integrate::Vector& load, const SphereContact& own) {
  return over_nodes(*part_, own.wide, [&](int node) {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      if (own.patch.normal[axis] != 0.0)
        sum -= own.patch.normal[axis] * statics.column(3 * node + axis).dot(load);
    return sum;
  });
}

// Fills motion_, moving_by_force_ and still_by_force_, and finds each contact's NearField::past.
void ContactInertia::begin(const Motion& motion, const KeptList<SphereContact>& contacts) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  if (motion_.size() < count) motion_.resize(count);
  motion_.head(count).setZero();
  clear_corner(moving_by_force_, count);
  clear_corner(still_by_force_, count);
  near_.assign(contacts.size(), {});
  const bool loaded = motion.still.size() > 0 && motion.still.squaredNorm() > 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    double nearest = part_->scene->finger.sphere_radius;
    for (const Past& one : past_) {
      const double distance = (one.position - contacts[i].patch.position).norm();
      if (one.sphere != contacts[i].sphere || distance >= nearest) continue;
      nearest = distance;
      near_[i].past = one;
    }
  }
  pressed_.clear();
  for (const SphereContact& own : contacts)
    for (const int vertex : own.wide.vertices)
      for (int axis = 0; axis < 3; ++axis)
        if (part_->node_of(vertex) >= 0 && own.patch.normal[axis] != 0.0)
          pressed_.push_back(3 * part_->node_of(vertex) + axis);
  statics.ask(pressed_);
  for (Eigen::Index i = 0; i < count; ++i) {
    const SphereContact& own = contacts[as_index(i)];
    motion_[i] = sunk(motion.displacement, own);
    if (loaded) motion_[i] -= sunk_by(motion.still, own);
    for (Eigen::Index j = 0; j < count; ++j) {
      const SphereContact& pressed = contacts[as_index(j)];
      still_by_force_(i, j) = sunk_by(statics, own, pressed);
      if (motion.share > 0.0)
        moving_by_force_(i, j) = motion.share * sunk_by(response, own, pressed);
      if (!motion.still_has_past) continue;
      const Past& past = near_[as_index(j)].past;
      motion_[i] += still_by_force_(i, j) * past.elastic +
                    moving_by_force_(i, j) * (past.force - motion.slope * past.elastic);
    }
  }
}

// theta of [inertia]: 1, or less where the mesh would soften the contact by more than
//   theta sum_j c_ij <= 0.47 / F_i' + C_ii,  F_i' at the travel (negative C_ij included).
// h - c F(h) grows until c F' = 1 and is h/3 there. For F ~ h^(3/2) and c F' = 0.47 at the travel
// this is 1.5 times the travel, so that a solution exists however little the mesh has moved.
double ContactInertia::part_of_motion(const KeptList<SphereContact>& contacts,
                                      const Eigen::MatrixXd& known) const {
  constexpr double most_softening = 0.47;
  double part = 1.0;
  const auto count = static_cast<Eigen::Index>(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto own = static_cast<Eigen::Index>(i);
    const double stiffness = contacts[i].law.point.stiffness(contacts[i].approach);
    double spare = most_softening;
    for (Eigen::Index j = 0; j < count; ++j)
      spare += stiffness * (j == own ? known(own, j) : std::min(0.0, known(own, j)));
    const double softening = stiffness * still_by_force_.row(own).head(count).sum();
    if (softening > spare) part = std::min(part, std::max(0.0, spare / softening));
  }
  return part;
}

// Fills damping and delay of near_: the radiation of waves shorter than the wide patch by Lysmer's
// analogue, without the part that the mesh radiates or the support reflects.
//                                                       docs/theory.md [radiation], [reflection]
void ContactInertia::find_near_field(const Motion& motion, const KeptList<SphereContact>& contacts,
                                     const Eigen::MatrixXd& known, double part) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto own = static_cast<Eigen::Index>(i);
    const contact::PointLaw& law = contacts[i].law.point;
    NearField& near = near_[i];
    near.damping = near.delay = 0.0;
    const double depth = std::max(0.0, near.past.depth + contacts[i].approach - near.past.approach);
    const double stiffness = law.stiffness(depth);
    if (stiffness <= 0.0) continue;
    // C_L = D (2 E* a)^2 with the half-space's 2 E* a, and T = C_L / (c F'^2).
    const double half_space = 1.5 * law.part * law.coefficient * std::sqrt(depth);
    double damping = radiation_ * half_space * half_space;
    // No such law is known between contacts. Where they deform each other's tissue, the dashpot is
    // bounded; otherwise differences of their forces would meet a negative compliance.
    double others = 0.0;
    for (Eigen::Index j = 0; j < count; ++j)
      if (j != own) others += std::abs(known(own, j) - part * still_by_force_(own, j));
    if (others > 0.0) {
      const double spare = 1.0 / stiffness + known(own, own) - part * still_by_force_(own, own);
      const double most = std::max(0.0, 0.5 * spare / others - 1.0) * motion.time_step / spare;
      damping = std::min(damping, most);
    }
    const double delay = damping / (stiffness * stiffness * still_by_force_(own, own));
    const double radiated = std::min(1.0, return_time_ / delay);
    const double in_series = std::max(0.0, 1.0 + stiffness * std::min(0.0, known(own, own)));
    near.damping = radiated * part * damping;
    near.delay = radiated * in_series * delay;
  }
}

// With
// `part` theta, G the response of the step, c that of statics and R = C_L / dt:
//   h + W P = A - part m,  P = F(h) + R (h - h_0),  W = C + part (slope G - c)  or, solved for F,
//   h + (1 + W R)^-1 W F(h) = (1 + W R)^-1 (A - part m + W R h_0)
const Eigen::MatrixXd& ContactInertia::complete(const Motion& motion,
                                                const KeptList<SphereContact>& contacts,
                                                const Eigen::MatrixXd& known,
                                                std::vector<double>& approaches) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  const double part = part_of_motion(contacts, known);
  find_near_field(motion, contacts, known, part);
  if (whole_compliance_.rows() < count) whole_compliance_.resize(count, count);
  whole_compliance_.topLeftCorner(count, count) =
      known.topLeftCorner(count, count) +
      part * (motion.slope * moving_by_force_.topLeftCorner(count, count) -
              still_by_force_.topLeftCorner(count, count));
  if (softness_.size() < count) softness_.resize(count);
  double fastest = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const NearField& near = near_[as_index(i)];
    // Q_1 = (Q_0 + x P) / (1 + x),  x = dt / T                         docs/theory.md [radiation]
    const double kept = near.delay / (near.delay + motion.time_step);
    whole_compliance_(i, i) += part * kept * still_by_force_(i, i);
    approaches[as_index(i)] = contacts[as_index(i)].approach -
                              part * (motion_[i] - kept * still_by_force_(i, i) * near.past.spread);
    softness_[i] = whole_compliance_(i, i);
    fastest = std::max(fastest, near.damping);
  }
  if (!(fastest > 0.0)) return whole_compliance_;
  constexpr int few = 16;
  const double time_step = motion.slope * motion.time_step;
  if (count <= few)
    damp<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, few, few>>(time_step, known,
                                                                             approaches);
  else
    damp<Eigen::MatrixXd>(time_step, known, approaches);
  return whole_compliance_;
}

// The last equation above, from right-hand sides without W R h_0. A Matrix of few rows has a fixed
// maximum size and allocates nothing.
template <class Matrix>
void ContactInertia::damp(double time_step, const Eigen::MatrixXd& known,
                          std::vector<double>& approaches) {
  using Side = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Matrix::MaxRowsAtCompileTime, 1>;
  const auto count = static_cast<Eigen::Index>(approaches.size());
  Side right(count);
  Side rate(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    right[i] = approaches[as_index(i)];
    rate[i] = near_[as_index(i)].damping / time_step;
  }
  Matrix whole = whole_compliance_.topLeftCorner(count, count);
  // A body stiffer than the half-space is so in statics, where waves have been to its base and
  // back: the dashpot does not press through that negative compliance.
  const Matrix stiffer = known.topLeftCorner(count, count).cwiseMin(0.0);
  const Matrix damped = (whole - stiffer) * rate.asDiagonal();
  for (Eigen::Index i = 0; i < count; ++i) right += damped.col(i) * near_[as_index(i)].past.depth;
  const Eigen::PartialPivLU<Matrix> left(Matrix::Identity(count, count) + damped);
  const Side solved = left.solve(right);
  const Matrix given_way = left.solve(whole);
  whole_compliance_.topLeftCorner(count, count) = given_way;
  for (Eigen::Index i = 0; i < count; ++i) approaches[as_index(i)] = solved[i];
}

bool ContactInertia::release(const Motion& motion, KeptList<SphereContact>& contacts) {
  std::size_t worst = contacts.size();
  double least = 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    SphereContact& contact = contacts[i];
    contact.radiated = near_[i].damping / motion.time_step * (contact.depth - near_[i].past.depth);
    const double push = contact.elastic + contact.radiated / motion.slope;
    if (push >= least) continue;
    least = push;
    worst = i;
  }
  if (worst == contacts.size()) return false;
  // Without the finger its depth recovers by F(h) + C_L (h - h_0) / dt = 0.
  const NearField& near = near_[worst];
  const SphereContact& contact = contacts[worst];
  parted_.push_back({.sphere = contact.sphere,
                     .position = contact.patch.position,
                     .approach = contact.approach,
                     .depth = contact::penetration(contact.law.point, near.past.depth,
                                                   motion.time_step / near.damping)
                                  .value_or(0.0),
                     .spread = near.delay / (near.delay + motion.time_step) * near.past.spread});
  contacts.erase(worst);
  return true;
}

void ContactInertia::remember(const Motion& motion, const Eigen::MatrixXd& known,
                              KeptList<SphereContact>& contacts) {
  past_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    SphereContact& contact = contacts[i];
    if (contact.depth <= 0.0) continue;
    const auto own = static_cast<Eigen::Index>(i);
    const double elastic = contact.elastic + contact.radiated / motion.slope;
    contact.force = contact.elastic + contact.radiated;
    const NearField& near = near_[i];
    const double own_stiffness =
        contact.law.point.stiffness(contact.depth) + near.damping / motion.time_step;
    contact.stiffness = own_stiffness / (1.0 + softness_[own] * own_stiffness);
    const double kept = near.delay / (near.delay + motion.time_step);
    past_.push_back({.sphere = contact.sphere,
                     .position = contact.patch.position,
                     .approach = contact.approach,
                     .depth = contact.depth,
                     .spread = kept * near.past.spread + (1.0 - kept) * elastic,
                     .elastic = elastic,
                     .force = contact.force});
    // The approach becomes the one at which statics gives this depth.
    contact.approach = contact.depth;
    for (std::size_t j = 0; j < contacts.size(); ++j)
      contact.approach += known(own, static_cast<Eigen::Index>(j)) * contacts[j].elastic;
  }
  past_.insert(past_.end(), parted_.begin(), parted_.end());
  parted_.clear();
}

void ContactInertia::keep_forces(const Touch& touch) {
  for (std::size_t i = 0; i < past_.size(); ++i)
    past_[i].force = i < touch.contacts.size() ? touch.contacts[i].force : 0.0;
}

namespace {

using integrate::MemoryRule;
using integrate::Vector;

// The radius of the contact divided by the square root of its depth, sqrt(m).
double radius_per_root(const contact::ContactLaw& law) {
  const contact::LayerContact* layer = law.point.layer;
  return layer != nullptr ? law.radius_share * std::sqrt(layer->radius) : std::sqrt(law.a * law.b);
}

// How far from its first touch the loading history lets the finger press, with room for a hand that
// does not follow it closely, m.
double farthest_reach(const scene::Scene& scene) {
  double path = 4.0 * contact::hertz::contact_radius(
                          scene::deepest_travel(scene.scenario, scene.law()), scene.law().radius);
  path += scene.law().radius;
  for (const scenario::Step& step : scene.scenario.steps)
    if (const auto* slide = std::get_if<scenario::Slide>(&step)) path += std::abs(slide->by);
  return path;
}

}  // namespace

std::optional<std::string> OneWay::find(const Vec3& finger, Touch& touch) {
  outer_surface->detect(finger, nullptr);
  return outer_surface->find(finger, touch, [this](Touch& now) {
    SurfaceContacts::guess_depth(now.contacts);
    return outer_surface->settle(
        now, [](auto&, auto& compliance) -> auto& { return compliance; });
  });
}

std::optional<std::string> OneWay::step(const StepTo& to) {
  if (auto wrong = find(to.finger, to.touch)) return wrong;
  to.history.pass(*part->scene, to.duration, to.touch);
  return part->move(to.touch);
}

void Consistent::begin_part(const std::vector<Eigen::Index>& /*from*/) {
  const scene::Scene& scene = *part->scene;
  beyond_.emplace(scene, part->part, part->body->held(),
                  scene::deepest_travel(scene.scenario, scene.law()));
  finer_.resize(0);
}

void Consistent::make_ready() { beyond_->make_ready(farthest_reach(*part->scene)); }

std::optional<std::string> Consistent::find(const Vec3& finger, Touch& touch) {
  outer_surface->detect(finger, nullptr);
  return outer_surface->find(
      finger, touch,
      [this](Touch& now) {
        // Steps in modes alone are frames in which every loaded node costs time.
        if (!part->in_modes)
          for (SphereContact& contact : now.contacts) outer_surface->spread_wide(contact);
        SurfaceContacts::guess_depth(now.contacts);
        return outer_surface->settle(
            now, [&](auto&, Eigen::MatrixXd& compliance) -> auto& {
              find_surface_displacement(now, compliance);
              return compliance;
            });
      },
      body());
}

std::optional<std::string> Consistent::step(const StepTo& to) {
  if (auto wrong = find(to.finger, to.touch)) return wrong;
  to.history.pass(*part->scene, to.duration, to.touch);
  if (!part->in_modes) load_finely(to.touch);
  return part->move(to.touch);
}

// The patch of the single sphere that a group of spheres with `calibration = "force"` replaces:
// below the group's middle, or where its deepest contact is.
contact::Patch Consistent::joint_patch(const Touch& touch) {
  const SphereContact& deepest = *touch.deepest();
  contact::Patch joint = outer_surface->below_middle().value_or(deepest.patch);
  // a^2 = R h, and R is n^(1/3) times a sphere's radius.
  const double wider = std::pow(static_cast<double>(part->scene->finger.centres.size()), 1.0 / 6.0);
  joint.a = wider * deepest.patch.a;
  joint.b = wider * deepest.patch.b;
  return joint;
}

// The contact radius a is the one that stores the most energy, docs/theory.md [energy]:
//   F = F_Hertz(a) / (1 - (5/3) E* a^2 s'(a)),   travel = a^2 / R + (s + a s') F.
// Both take the form of the contact equations: the law times a factor, and a compliance.
void Consistent::find_surface_displacement(Touch& touch, Eigen::MatrixXd& compliance) {
  KeptList<SphereContact>& contacts = touch.contacts;
  constexpr double most_stiffening = 0.8;
  const auto count = static_cast<Eigen::Index>(contacts.size());
  const bool as_one = presses_as_one(*part->scene) && count > 0;
  const auto& tissue = part->scene->scenario.tissue;
  const double plane_modulus =
      tissue.young_modulus / (1.0 - tissue.poisson_ratio * tissue.poisson_ratio);
  contact::Patch joint;
  BodySurfaceDisplacement::Value of_all;
  if (as_one) {
    joint = joint_patch(touch);
    of_all = beyond_->at(joint);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    SphereContact& own = contacts[as_index(i)];
    const BodySurfaceDisplacement::Value value = as_one ? of_all : beyond_->at(own.patch);
    const double radius = (as_one ? joint : own.patch).radius();
    // F_Hertz = 4/3 E* a h, for an ellipse with a modulus that makes this so. A layer's law knows
    // its own contact radius.
    const double modulus = as_one ? part->scene->finger.whole.modulus
                                  : 0.75 * own.law.point.coefficient / radius_per_root(own.law);
    const double stiffening =
        std::min(most_stiffening, 5.0 / 3.0 * modulus * radius * radius * value.slope);
    // The mesh is linear: it sinks by the force without the factor of a deep press, and by that of
    // all spheres that stand for one.
    const double forces = (as_one ? static_cast<double>(count) : 1.0) / own.deep;
    own.surface_displacement_error = forces * value.error;
    own.surface_displacement_doubt = forces * value.doubt;
    double surface_displacement = value.surface_displacement / own.deep;
    if (own.law.point.layer == nullptr) {
      own.law.point.part /= 1.0 - stiffening;
      surface_displacement += radius * value.slope / own.deep;
    }
    if (as_one) {
      compliance.row(i).head(count).setConstant(surface_displacement);
      continue;
    }
    compliance(i, i) = surface_displacement;
    // Symmetrised, c_ij = (c_ij + c_ji) / 2, because readings at points are not quite symmetric.
    for (Eigen::Index j = 0; j < count; ++j) {
      if (i == j) continue;
      const SphereContact& other = contacts[as_index(j)];
      const double between = own.patch.normal.dot(other.patch.normal) *
                                 contact::half_space_surface_displacement(
                                     (own.patch.position - other.patch.position).norm(), 1.0,
                                     other.patch.radius(), plane_modulus) +
                             beyond_->rest(own.patch.normal, own.load, part->nodes, other.patch);
      compliance(i, j) += 0.5 * between / other.deep;
      compliance(j, i) += 0.5 * between / own.deep;
    }
  }
}

std::vector<double> Consistent::errors(const SphereContact& contact) {
  contact::Patch patch = contact.patch;
  patch.a = patch.b = patch.radius();
  return beyond_->errors(patch);
}

Vector Consistent::displacement() {
  if (finer_.size() == 0) return part->state.displacement;
  Vector further;
  part->respond(Response::statics, finer_, further);
  return part->state.displacement + further;
}

namespace {

// The memory rule of the mesh's integrator.
MemoryRule memory_rule(const scene::Scene& scene) {
  return scene.scenario.solver.integrator == scenario::Solver::Integrator::backward_difference
             ? MemoryRule::first_order
             : MemoryRule::exact;
}

// The largest displacement of any node of the surface, m.
double rise(const MovingPart& part, const Vector& displacement) {
  double most = 0.0;
  for (const int node : part.nodes)
    if (node >= 0) most = std::max(most, displacement.segment<3>(3 * node).squaredNorm());
  return std::sqrt(most);
}

}  // namespace

ConsistentWithInertia::ConsistentWithInertia(SurfaceContacts& contacts, MovingPart& moving)
    : OnMesh(contacts, moving),
      statics(contacts, moving),
      inertia_(moving),
      equivalent_(moving.scene->specimen->law, memory_rule(*moving.scene)) {}

void ConsistentWithInertia::begin_part(const std::vector<Eigen::Index>& from) {
  statics.begin_part(from);
  inertia_.statics.forget();
  inertia_.response.forget();
  equivalent_.renumber(from);
}

void ConsistentWithInertia::make_ready() {
  statics.make_ready();
  inertia_.make_room(outer_surface->most_contacts());
  inertia_.statics.ask_all();
  if (part->keeps_responses()) inertia_.response.ask_all();
}

// Stages of different durations follow each other only in a method with two stages, where exp() is
// therefore called in the step, twice per branch and stage.
void ConsistentWithInertia::set_stage(double duration) {
  if (duration == stage_) return;
  stage_ = duration;
  equivalent_.set_step(duration);
  slope_ = 1.0;
  for (const contact::Branch& branch : part->scene->relaxation.branches)
    slope_ += branch.ratio * (1.0 - tissue::MemoryStep::exact(duration, branch.time).end);
}

std::optional<std::string> ConsistentWithInertia::find(const Motion& motion, const StepTo& to) {
  // An oscillating surface may reach a finger that does not touch it at rest. Places that the
  // finger touches neither on the surface at rest nor on the moving surface are excluded.
  outer_surface->detect(to.finger, nullptr, rise(*part, motion.displacement))
      .erase_if([&](SphereContact& contact) {
        if (contact.approach > 0.0) return false;
        contact.patch.axis = contact.patch.normal.unitOrthogonal();
        outer_surface->spread_wide(contact);
        return contact.approach - inertia_.sunk(motion.displacement, contact) <= 0.0;
      });
  return outer_surface->find(
      to.finger, to.touch,
      [&](Touch& now) -> std::optional<std::string> {
        for (SphereContact& contact : now.contacts) outer_surface->spread_wide(contact);
        const auto complete = [&](std::vector<double>& approaches,
                                  Eigen::MatrixXd& compliance) -> const Eigen::MatrixXd& {
          statics.find_surface_displacement(now, compliance);
          return inertia_.complete(motion, now.contacts, compliance, approaches);
        };
        do {
          inertia_.begin(motion, now.contacts);
          if (auto wrong = outer_surface->settle(now, complete)) return wrong;
        } while (inertia_.release(motion, now.contacts));
        inertia_.remember(motion, outer_surface->compliance(), now.contacts);
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
                      .still = viscous ? equivalent_.load() : drag_,
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
  if (viscous) equivalent_.pass(part->load);
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

void FromMesh::make_ready() {
  outer_surface->make_room(next_);
  if (part->keeps_responses()) influence.ask_all();
}

template <class Find>
std::optional<std::string> FromMesh::step_by(MemoryRule rule, const Find& find, Touch& touch) {
  return std::visit(
      [&](auto& method) -> std::optional<std::string> {
        if constexpr (requires { method.base(); }) {
          return balance(method, rule, find, touch);
        } else {
          if (auto wrong = part->stepper->step(part->state, part->load, part->load, rule))
            return wrong;
          if (auto wrong = find(part->state.displacement, touch)) return wrong;
          contact_load(touch, *part, part->load);
          return std::nullopt;
        }
      },
      part->stepper->method());
}

template <class Linearised, class Find>
std::optional<std::string> FromMesh::balance(Linearised& method, MemoryRule rule, const Find& find,
                                             Touch& touch) {
  const bool linear = part->body->linear();
  reached_ = part->state.displacement;
  // Friction acts as in the previous step; the contact equations give the normal forces.
  drag_load(touch, *part, drag_);
  method.begin(part->state, part->time_step, rule);
  for (int i = 0; i < most_linearisations; ++i) {
    if (!linear) influence.forget();
    if (!method.linearise(reached_, drag_)) return not_positive;
    next_ = touch;
    if (auto wrong = find(method.base(), next_)) return wrong;
    contact_load(next_, *part, part->other_load);
    further_ = part->other_load - drag_;
    method.response(further_, moved_);
    moved_ += method.base();
    const double change = (moved_ - reached_).cwiseAbs().maxCoeff();
    reached_ = moved_;
    if (!std::isfinite(change)) return not_finite;
    if (linear || change <= settled_length) {
      method.finish(part->state, reached_, part->other_load);
      std::swap(touch, next_);
      part->load = part->other_load;
      return std::nullopt;
    }
  }
  return not_settled;
}

std::optional<std::string> Series::step(const StepTo& to) {
  const bool once = about(part->scene->scenario.solver.integrator).explicit_steps;
  const auto solve = [&](Touch& now) {
    const auto complete = [&](auto&, Eigen::MatrixXd& compliance) -> auto& {
      if (!once) find_surface_displacement(now.contacts, compliance);
      return compliance;
    };
    return outer_surface->settle(now, complete, once ? 1 : SurfaceContacts::most_passes);
  };
  const auto find = [&](const Vector& displacement, Touch& now) {
    outer_surface->detect(to.finger, &displacement);
    return outer_surface->find(to.finger, now, solve);
  };
  return step_by(MemoryRule::exact, find, to.touch);
}

// The surface displacement of the mesh under each contact per newton on each other, m/N.
void Series::find_surface_displacement(const KeptList<SphereContact>& contacts,
                                       Eigen::MatrixXd& compliance) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      const SphereContact& own = contacts[as_index(i)];
      const SphereContact& pressed = contacts[as_index(j)];
      double sum = 0.0;
      for (std::size_t k = 0; k < own.load.vertices.size(); ++k) {
        const int at = part->node_of(own.load.vertices[k]);
        double moved = 0.0;
        for (std::size_t l = 0; l < pressed.load.vertices.size(); ++l) {
          const Eigen::Matrix3d block =
              influence.block(at, part->node_of(pressed.load.vertices[l]));
          moved += pressed.load.shares[l] * own.patch.normal.dot(block * pressed.patch.normal);
        }
        sum += own.load.shares[k] * moved;
      }
      compliance(i, j) = sum;
    }
}

// A node in contact takes any force, and a force that is linear in each step would oscillate about
// the correct one.                                                    docs/theory.md, below [cells]
std::optional<std::string> Resolved::step(const StepTo& to) {
  const auto find = [&](const Vector& displacement, Touch& now) {
    return contact_.find(to.finger, displacement, influence, now);
  };
  return step_by(MemoryRule::first_order, find, to.touch);
}

}  // namespace palpate::mechanics
