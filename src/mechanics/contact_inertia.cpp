// The terms that a moving mesh adds to the equations of `consistent`: docs/theory.md (74), (75).
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "contact/wide_patch.h"
#include "mechanics/contacts.h"

namespace palpate::mechanics {
namespace {

// Sum of share * of(node) over a spread; nodes below 0 do not move.
template <class Of>
double over_nodes(const MeshAnswer& mesh, const contact::Spread& spread, const Of& of) {
  double sum = 0.0;
  for (std::size_t k = 0; k < spread.vertices.size(); ++k) {
    const int node = mesh.node_of(spread.vertices[k]);
    if (node >= 0) sum += spread.shares[k] * of(node);
  }
  return sum;
}

// s of (74): mean sinking of the skin under a contact's wide patch, m.
double sunk(const MeshAnswer& mesh, const SphereContact& contact) {
  const integrate::Vector& displacement = *mesh.moving->displacement;
  return over_nodes(mesh, contact.wide, [&](int node) {
    return -contact.patch.normal.dot(displacement.segment<3>(3 * node));
  });
}

// Mean sinking under the wide patch of `own` per newton on the wide patch of `pressed`, m/N.
double sunk_by(const MeshAnswer& mesh, Influence& influence, const SphereContact& own,
               const SphereContact& pressed) {
  return over_nodes(mesh, own.wide, [&](int at) {
    return over_nodes(mesh, pressed.wide, [&](int node) {
      return influence.between(-own.patch.normal, at, -pressed.patch.normal, node, mesh.freedoms);
    });
  });
}

// Mean sinking under the wide patch of `own` by a load (N), m. The influence is symmetric.
double sunk_by(const MeshAnswer& mesh, Influence& influence, const SphereContact& own,
               const integrate::Vector& load) {
  return over_nodes(mesh, own.wide, [&](int node) {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      if (own.patch.normal[axis] != 0.0)
        sum -= own.patch.normal[axis] * influence.column(3 * node + axis, mesh.freedoms).dot(load);
    return sum;
  });
}

void add(const MeshAnswer& mesh, const contact::Spread& spread, const Vec3& push,
         integrate::Vector& load) {
  for (std::size_t k = 0; k < spread.vertices.size(); ++k) {
    const int node = mesh.node_of(spread.vertices[k]);
    if (node >= 0) load.segment<3>(3 * node) += spread.shares[k] * push;
  }
}

}  // namespace

// The largest displacement of any node of the skin, m; 0 where inertia does not reach the force.
double Contacts::rise(const MeshAnswer& mesh) const {
  if (mesh.moving == nullptr) return 0.0;
  double most = 0.0;
  for (const int node : mesh.nodes)
    if (node >= 0)
      most = std::max(most, mesh.moving->displacement->segment<3>(3 * node).squaredNorm());
  return std::sqrt(most);
}

// The width depends on the finger's position alone. If it depended on the force, loading and
// reading would not be transposes of each other, and the contact could feed energy into the motion.
void Contacts::spread_wide(SphereContact& contact) {
  const auto axes = contact.law.semi_axes(std::max(0.0, contact.approach));
  spreader_.spread(contact::wide_patch(contact.patch, axes, spacing_.at(contact.patch)),
                   contact.wide);
}

// Removes places that the finger touches neither on the skin at rest nor on the moving skin.
void Contacts::leave_apart(const MeshAnswer& mesh, KeptList<SphereContact>& found) {
  found.erase_if([&](SphereContact& contact) {
    if (contact.approach > 0.0) return false;
    contact.patch.axis = contact.patch.normal.unitOrthogonal();
    spread_wide(contact);
    return contact.approach - sunk(mesh, contact) <= 0.0;
  });
}

// Fills motion_, moving_by_force_ and still_by_force_, and finds each contact's NearField::past.
void Contacts::find_motion(const MeshAnswer& mesh, const KeptList<SphereContact>& contacts) {
  const MovingMesh& moving = *mesh.moving;
  const auto count = static_cast<Eigen::Index>(contacts.size());
  if (motion_.size() < count) motion_.resize(count);
  motion_.head(count).setZero();
  clear_corner(moving_by_force_, count);
  clear_corner(still_by_force_, count);
  near_.assign(contacts.size(), {});
  const bool loaded = moving.still->size() > 0 && moving.still->squaredNorm() > 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    double nearest = scene_->finger.sphere_radius;
    for (const Past& one : past_) {
      const double distance = (one.position - contacts[i].patch.position).norm();
      if (one.sphere != contacts[i].sphere || distance >= nearest) continue;
      nearest = distance;
      near_[i].past = one;
    }
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const SphereContact& own = contacts[as_index(i)];
    motion_[i] = sunk(mesh, own);
    if (loaded) motion_[i] -= sunk_by(mesh, *mesh.influence, own, *moving.still);
    for (Eigen::Index j = 0; j < count; ++j) {
      const SphereContact& pressed = contacts[as_index(j)];
      still_by_force_(i, j) = sunk_by(mesh, *mesh.influence, own, pressed);
      if (moving.response != nullptr)
        moving_by_force_(i, j) = moving.share * sunk_by(mesh, *moving.response, own, pressed);
      if (!moving.still_has_past) continue;
      const Past& past = near_[as_index(j)].past;
      motion_[i] += still_by_force_(i, j) * past.elastic +
                    moving_by_force_(i, j) * (past.force - moving.slope * past.elastic);
    }
  }
}

// theta of (74): 1, or less where the mesh would soften the contact by more than
//   theta sum_j c_ij <= 0.47 / F_i' + C_ii,  F_i' at the travel (negative C_ij included).
// h - c F(h) grows until c F' = 1 and is h/3 there. For F ~ h^(3/2) and c F' = 0.47 at the travel
// this is 1.5 times the travel, so that a solution exists however little the mesh has moved.
double Contacts::part_of_motion(const KeptList<SphereContact>& contacts) const {
  constexpr double most_softening = 0.47;
  double part = 1.0;
  const auto count = static_cast<Eigen::Index>(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto own = static_cast<Eigen::Index>(i);
    const double stiffness = contacts[i].law.point.stiffness(contacts[i].approach);
    double spare = most_softening;
    for (Eigen::Index j = 0; j < count; ++j)
      spare += stiffness * (j == own ? compliance_(own, j) : std::min(0.0, compliance_(own, j)));
    const double softening = stiffness * still_by_force_.row(own).head(count).sum();
    if (softening > spare) part = std::min(part, std::max(0.0, spare / softening));
  }
  return part;
}

// Fills damping and delay of near_: the radiation of waves shorter than the wide patch by Lysmer's
// analogue, without the part that the mesh radiates.                          docs/theory.md (75)
void Contacts::find_near_field(const MovingMesh& moving, const KeptList<SphereContact>& contacts,
                               double part) {
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
      if (j != own) others += std::abs(compliance_(own, j) - part * still_by_force_(own, j));
    if (others > 0.0) {
      const double spare =
          1.0 / stiffness + compliance_(own, own) - part * still_by_force_(own, own);
      const double most = std::max(0.0, 0.5 * spare / others - 1.0) * moving.time_step / spare;
      damping = std::min(damping, most);
    }
    near.damping = damping;
    near.delay = damping / (stiffness * stiffness * still_by_force_(own, own));
  }
}

// Fills whole_compliance_ and the approaches, so that the equations have the form of statics. With
// `part` theta, G the response of the step, c that of statics and R = C_L / dt:
//   h + W P = A - part m,  P = F(h) + R (h - h_0),  W = C + part (slope G - c)  or, solved for F,
//   h + (1 + W R)^-1 W F(h) = (1 + W R)^-1 (A - part m + W R h_0)
void Contacts::add_motion(const MovingMesh& moving, const KeptList<SphereContact>& contacts,
                          std::vector<double>& approaches) {
  const auto count = static_cast<Eigen::Index>(contacts.size());
  const double part = part_of_motion(contacts);
  find_near_field(moving, contacts, part);
  if (whole_compliance_.rows() < count) whole_compliance_.resize(count, count);
  whole_compliance_.topLeftCorner(count, count) =
      compliance_.topLeftCorner(count, count) +
      part * (moving.slope * moving_by_force_.topLeftCorner(count, count) -
              still_by_force_.topLeftCorner(count, count));
  if (softness_.size() < count) softness_.resize(count);
  double fastest = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const NearField& near = near_[as_index(i)];
    // Q_1 = (Q_0 + x P) / (1 + x),  x = dt / T                                docs/theory.md (75)
    const double kept = near.delay / (near.delay + moving.time_step);
    whole_compliance_(i, i) += part * kept * still_by_force_(i, i);
    approaches[as_index(i)] = contacts[as_index(i)].approach -
                              part * (motion_[i] - kept * still_by_force_(i, i) * near.past.spread);
    softness_[i] = whole_compliance_(i, i);
    fastest = std::max(fastest, near.damping);
  }
  if (!(fastest > 0.0)) return;
  constexpr int few = 16;
  const double time_step = moving.slope * moving.time_step;
  if (count <= few)
    damp<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, few, few>>(time_step, approaches);
  else
    damp<Eigen::MatrixXd>(time_step, approaches);
}

// The last equation above, from right-hand sides without W R h_0. A Matrix of few rows has a fixed
// maximum size and allocates nothing.
template <class Matrix>
void Contacts::damp(double time_step, std::vector<double>& approaches) {
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
  const Matrix known = compliance_.topLeftCorner(count, count).cwiseMin(0.0);
  const Matrix damped = (whole - known) * rate.asDiagonal();
  for (Eigen::Index i = 0; i < count; ++i) right += damped.col(i) * near_[as_index(i)].past.depth;
  const Eigen::PartialPivLU<Matrix> left(Matrix::Identity(count, count) + damped);
  const Side solved = left.solve(right);
  const Matrix given_way = left.solve(whole);
  whole_compliance_.topLeftCorner(count, count) = given_way;
  for (Eigen::Index i = 0; i < count; ++i) approaches[as_index(i)] = solved[i];
}

// Removes the contact with the largest tensile force, which arises where the tissue falls behind a
// finger that leaves. Returns whether there was one.
bool Contacts::release(const MovingMesh& moving, KeptList<SphereContact>& contacts) {
  std::size_t worst = contacts.size();
  double least = 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    SphereContact& contact = contacts[i];
    contact.radiated = near_[i].damping / moving.time_step * (contact.depth - near_[i].past.depth);
    const double push = contact.elastic + contact.radiated / moving.slope;
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
                                                   moving.time_step / near.damping)
                                  .value_or(0.0),
                     .spread = near.delay / (near.delay + moving.time_step) * near.past.spread});
  contacts.erase(worst);
  return true;
}

// Sets the contacts' forces and stiffnesses, and past_ for the next step.
void Contacts::remember(const MovingMesh& moving, KeptList<SphereContact>& contacts) {
  past_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    SphereContact& contact = contacts[i];
    if (contact.depth <= 0.0) continue;
    const auto own = static_cast<Eigen::Index>(i);
    const double elastic = contact.elastic + contact.radiated / moving.slope;
    contact.force = contact.elastic + contact.radiated;
    const NearField& near = near_[i];
    const double own_stiffness =
        contact.law.point.stiffness(contact.depth) + near.damping / moving.time_step;
    contact.stiffness = own_stiffness / (1.0 + softness_[own] * own_stiffness);
    const double kept = near.delay / (near.delay + moving.time_step);
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
      contact.approach += compliance_(own, static_cast<Eigen::Index>(j)) * contacts[j].elastic;
  }
  past_.insert(past_.end(), parted_.begin(), parted_.end());
  parted_.clear();
}

void Contacts::keep_forces(const Touch& touch) {
  for (std::size_t i = 0; i < past_.size(); ++i)
    past_[i].force = i < touch.contacts.size() ? touch.contacts[i].force : 0.0;
}

void Contacts::finer_load(const Touch& touch, const MeshAnswer& mesh, integrate::Vector& load) {
  load.setZero(mesh.freedoms);
  for (const SphereContact& contact : touch.contacts) {
    const Vec3 push = contact.drag - contact.elastic * contact.patch.normal;
    add(mesh, contact.load, push, load);
    add(mesh, contact.wide, -push, load);
  }
}

}  // namespace palpate::mechanics
