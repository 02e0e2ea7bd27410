// Newton's steps.
#include "solid/press.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/stop_scope.h"

namespace palpate::solid {
namespace {

constexpr double stiff = 100.0;     // penalty over E / h
constexpr double last_step = 1e-3;  // of the travel: Newton's, what is left is of its square
constexpr double longest = 0.5;     // of the size: a step's largest change of displacement
constexpr int most_steps = 40;
constexpr int most_halvings = 5;

double penalty(const Body& body) {
  // By the tissue at the highest face that may be met.
  double top = -HUGE_VAL;
  double modulus = 0.0;
  for (const OuterFace& face : body.met) {
    const double z = body.mesh.nodes[as_index(face.nodes[0])].z();
    if (z <= top) continue;
    top = z;
    modulus = body.tissues[as_index(body.mesh.regions[as_index(face.element)])].young_modulus;
  }
  return stiff * modulus / body.size;
}

}  // namespace

double Answer::normal() const { return std::accumulate(forces.begin(), forces.end(), 0.0); }

Press::Press(Body body)
    : body_(std::move(body)),
      elements_(body_.mesh, body_.tissues, body_.held),
      contact_(elements_, body_.met, penalty(body_)) {
  for (const tissue::Isotropic& own : body_.tissues)
    hardest_ = std::max(hardest_, own.young_modulus);
  Vector force;
  elements_.assemble(Vector::Zero(static_cast<Eigen::Index>(3 * body_.mesh.nodes.size())), force,
                     linear_);
  factors_.analyse(linear_, elements_.first_unknowns());
}

void Press::begin(const Vec3& finger) {
  now_ = {finger, Vector::Zero(static_cast<Eigen::Index>(3 * body_.mesh.nodes.size())),
          std::vector<double>(points * body_.mesh.elements.size(), 0.0)};
  has_before_ = false;
}

// Factors the stiffness with a share of the linear one, if it is not positive definite alone.
bool Press::factor() {
  constexpr double first_share = 0.02;
  constexpr double most_share = 50.0;
  double share = 0.0;
  for (;;) {
    StopScope::end_if_stopped();
    ++factorisations_;
    if (factors_.factor(stiffness_)) return true;
    const double more = std::max(first_share, 2.0 * share);
    share += more;
    if (share > most_share) return false;
    stiffness_ += more * linear_;
  }
}

// Of an indenter with its pole there, in the mirrors through the finger's point: 0 beyond one,
// where it is the image of another.
int Press::images_of(const Vec3& pole) const {
  const double near = 1e-6 * body_.size;
  int images = 1;
  for (const int axis : {0, 1}) {
    if (!body_.mirrored[as_index(axis)] || std::abs(pole[axis]) < near) continue;
    images *= pole[axis] > 0.0 ? 2 : 0;
  }
  return images;
}

std::vector<Indenter> Press::finger_at(const Vec3& place) const {
  std::vector<Indenter> moved = indenters_;
  for (Indenter& one : moved) one.pole += place;
  return moved;
}

std::optional<Answer> Press::settle(const Vec3& finger, bool extrapolate) {
  const std::vector<Indenter> indenters = finger_at(finger);
  Vector u = now_.displacement;
  std::vector<double> pressures = now_.pressures;
  if (extrapolate) {
    const double way = (now_.finger - before_.finger).norm();
    const double share = (finger - now_.finger).norm() / way;
    u += share * (now_.displacement - before_.displacement);
    for (std::size_t i = 0; i < pressures.size(); ++i)
      pressures[i] += share * (now_.pressures[i] - before_.pressures[i]);
  }
  elements_.set_pressures(std::move(pressures));
  Vector force;
  Vector right(elements_.unknowns());
  Vector solution;
  Vector step = Vector::Zero(u.size());
  std::vector<Met> met;
  for (int i = 0; i < most_steps; ++i) {
    const double least = elements_.assemble(u, force, stiffness_);
    if (!(least > -1.0)) return std::nullopt;
    contact_.add(u, indenters, hardest_, force, stiffness_, met);
    for (int d = 0; d < static_cast<int>(u.size()); ++d)
      if (const int unknown = elements_.unknown(d); unknown >= 0) right[unknown] = -force[d];
    if (!factor()) return std::nullopt;
    factors_.solve(right, solution);
    const double most = solution.size() > 0 ? solution.cwiseAbs().maxCoeff() : 0.0;
    if (!std::isfinite(most)) return std::nullopt;
    const double share = std::min(1.0, longest * body_.size / most);
    for (int d = 0; d < static_cast<int>(u.size()); ++d)
      if (const int unknown = elements_.unknown(d); unknown >= 0) step[d] = solution[unknown];
    elements_.advance(u, step, share);
    u += share * step;
    if (most > last_step * body_.travel) continue;
    const double folded = elements_.assemble(u, force, stiffness_);
    if (!(folded > 0.0)) return std::nullopt;
    contact_.add(u, indenters, hardest_, force, stiffness_, met);
    Answer answer;
    double work = 0.0;
    for (std::size_t i = 0; i < met.size(); ++i) {
      const Met& one = met[i];
      answer.forces.push_back(-body_.copies * one.force.z());
      answer.force -= body_.copies * one.force;
      work += body_.copies * one.work;
      answer.area += body_.copies * one.area;
      answer.peak = std::max(answer.peak, one.peak);
      if (one.area > 0.0) answer.touching += images_of(indenters_[i].pole);
    }
    for (int axis = 0; axis < 2; ++axis)
      if (body_.mirrored[as_index(axis)]) answer.force[axis] = 0.0;
    if (answer.normal() > 0.0) answer.lost = work / answer.normal();
    before_ = std::move(now_);
    has_before_ = true;
    now_ = {finger, std::move(u), elements_.pressures()};
    return answer;
  }
  return std::nullopt;
}

std::optional<Answer> Press::go(const Vec3& finger) {
  Vec3 wanted = finger;
  int halved = 0;
  for (;;) {
    const Vec3 way = wanted - now_.finger;
    const Vec3 last = now_.finger - before_.finger;
    const bool straight = has_before_ && way.norm() < 4.0 * last.norm() &&
                          way.dot(last) > 0.99 * way.norm() * last.norm();
    auto found = settle(wanted, straight);
    if (!found && straight) found = settle(wanted, false);
    if (found && wanted == finger) return found;
    if (found) {
      wanted = finger;
      continue;
    }
    if (++halved > most_halvings) return std::nullopt;
    wanted = 0.5 * (now_.finger + wanted);
  }
}

std::optional<Vector> Press::look(const Vec3& finger) {
  const State now = now_, before = before_;
  const bool had_before = has_before_;
  const auto found = go(finger);
  std::optional<Vector> displacement;
  if (found) displacement = std::move(now_.displacement);
  now_ = now;
  before_ = before;
  has_before_ = had_before;
  return displacement;
}

}  // namespace palpate::solid
