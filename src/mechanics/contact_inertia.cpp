// The terms of the mesh's motion and of the radiation.
#include "mechanics/contact_inertia.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mechanics/skin_contacts.h"
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
      radiation_(scene::radiation_compliance(*part.scene)) {}

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

// Mean sinking under the wide patch of `own` per newton on the wide patch of `pressed`, m/N.
double ContactInertia::sunk_by(Influence& by, const SphereContact& own,
                               const SphereContact& pressed) const {
  return over_nodes(*part_, own.wide, [&](int at) {
    return over_nodes(*part_, pressed.wide, [&](int node) {
      return by.between(-own.patch.normal, at, -pressed.patch.normal, node);
    });
  });
}

// Mean static sinking under the wide patch of `own` by a load (N), m. The influence is symmetric.
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
// analogue, without the part that the mesh radiates.                   docs/theory.md [radiation]
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
    near.damping = damping;
    near.delay = damping / (stiffness * stiffness * still_by_force_(own, own));
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

}  // namespace palpate::mechanics
