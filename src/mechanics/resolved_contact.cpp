// Solves for the nodes in contact and their forces, docs/theory.md [unilateral], [gap].
#include "mechanics/resolved_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "contact/complementarity.h"

namespace palpate::mechanics {
namespace {

using Eigen::Index;

}  // namespace

ResolvedContact::ResolvedContact(const MovingPart& part)
    : part_(&part),
      scene_(part.scene),
      surface_(&*scene_->specimen->surface),
      skin_(*surface_),
      touches_(*scene_),
      finger_compliance_(scene_->finger.compliance_share / scene_->finger.whole.modulus) {
  for (const Vec3& centre : scene_->finger.centres)
    balls_.push_back({centre, scene_->finger.sphere_radius});
}

bool ResolvedContact::sphere_normals() const {
  return scene_->scenario.contact.direction == scenario::Contact::Direction::sphere;
}

// Fills candidates_ with the nodes near the spheres, each with the sphere nearest to it.
void ResolvedContact::look(const Vec3& finger, const integrate::Vector& displacement,
                           const Touch& before) {
  constexpr double reach = 1.25;  // distance from a centre, in radii
  for (std::size_t i = 0; i < balls_.size(); ++i)
    balls_[i].centre = finger + scene_->finger.centres[i];
  std::set<int> pressed;
  for (const SphereContact& contact : before.contacts)
    pressed.insert(contact.load.vertices.begin(), contact.load.vertices.end());
  candidates_.clear();
  const auto& vertices = surface_->surface().vertices;
  for (int v = 0; v < static_cast<int>(vertices.size()); ++v) {
    const int node = part_->node_of(v);
    const Vec3 base = node < 0 ? Vec3(Vec3::Zero()) : Vec3(displacement.segment<3>(3 * node));
    double nearest = std::numeric_limits<double>::infinity();
    int sphere = -1;
    for (int i = 0; i < static_cast<int>(balls_.size()); ++i) {
      const Ball& ball = balls_[as_index(i)];
      const double distance = (vertices[as_index(v)] + base - ball.centre).norm();
      if (distance > reach * ball.radius || distance >= nearest) continue;
      nearest = distance;
      sphere = i;
    }
    if (sphere < 0) continue;
    const auto skin = skin_.facing(v, balls_[as_index(sphere)]);
    if (!skin) continue;
    Candidate one;
    one.skin = *skin;
    one.skin.sphere = sphere;
    one.node = node;
    one.base = one.moved = base;
    one.sought = pressed.contains(v);
    candidates_.push_back(one);
  }
}

// Sets the gaps without contact forces, and the directions of the forces, for the present `moved`.
void ResolvedContact::measure_gaps() {
  const bool by_sphere = sphere_normals();
  for (Candidate& one : candidates_) {
    const Ball& ball = balls_[as_index(one.skin.sphere)];
    const Vec3 to_centre = ball.centre - one.skin.place;
    if (by_sphere) {
      // |x - c| - R, linearised at the present position of the node
      const Vec3 from_centre = one.moved - to_centre;
      one.push = from_centre.normalized();
      one.gap = from_centre.norm() - ball.radius + one.push.dot(one.base - one.moved);
    } else {
      // Distance to the sphere along the normal at rest, from the node at rest, minus its
      // displacement; infinite if the normal misses the sphere.
      one.push = -one.skin.normal;
      const double height = to_centre.dot(one.skin.normal);
      const double chord = ball.radius * ball.radius - to_centre.squaredNorm() + height * height;
      one.gap = chord <= 0.0 ? std::numeric_limits<double>::infinity()
                             : height - std::sqrt(chord) + one.push.dot(one.base);
    }
    one.gap += one.skin.facets;
  }
}

// The finger's displacement at a node per newton on another, m/N, as a half-space.
double ResolvedContact::finger_sinking(const Candidate& at, const Candidate& pressed) const {
  if (at.skin.sphere != pressed.skin.sphere) return 0.0;
  const double inverse =
      &at == &pressed ? at.skin.own : 1.0 / (at.skin.place - pressed.skin.place).norm();
  return finger_compliance_ * inverse / std::numbers::pi;
}

// The displacement of every candidate (columns, m) per newton on one of them.
Eigen::Matrix3Xd ResolvedContact::answer(Influence& influence, const Candidate& loaded) const {
  Eigen::Matrix3Xd moved = Eigen::Matrix3Xd::Zero(3, static_cast<Index>(candidates_.size()));
  if (loaded.node < 0) return moved;
  for (int axis = 0; axis < 3; ++axis) {
    const double part = loaded.push[axis];
    if (part == 0.0) continue;
    const auto& column = influence.column(3 * loaded.node + axis);
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      if (candidates_[i].node >= 0)
        moved.col(static_cast<Index>(i)) += part * column.segment<3>(3 * candidates_[i].node);
  }
  return moved;
}

// Solves [unilateral] for the present gaps. Columns of A are computed only for nodes that
// overlap, and for those that overlap under the resulting forces, until no further node overlaps.
std::optional<std::string> ResolvedContact::solve(Influence& influence) {
  const auto count = static_cast<Index>(candidates_.size());
  const double closed = 1e-12 * scene_->finger.sphere_radius;
  double deepest = 0.0;
  for (Candidate& one : candidates_) {
    one.left = one.gap;
    one.moved = one.base;
    one.force = 0.0;
    deepest = std::min(deepest, one.gap);
  }
  // At the edge of Hertz's contact the overlap is half the depth.
  const auto overlaps = [&](const Candidate& one) { return one.left < -closed; };
  for (Candidate& one : candidates_) one.sought = one.sought || one.left < 0.5 * deepest;

  std::vector<Index> sought;
  std::vector<char> pressed;
  std::vector<Eigen::Matrix3Xd> answers;
  Eigen::MatrixXd changes(count, 0);  // m/N, of every gap per newton on each node in `sought`
  while (true) {
    for (Index i = 0; i < count; ++i) {
      const Candidate& one = candidates_[as_index(i)];
      if (!one.sought || std::find(sought.begin(), sought.end(), i) != sought.end()) continue;
      sought.push_back(i);
      pressed.push_back(overlaps(one) ? 1 : 0);
      answers.push_back(answer(influence, one));
      changes.conservativeResize(Eigen::NoChange, changes.cols() + 1);
      for (Index j = 0; j < count; ++j) {
        const Candidate& other = candidates_[as_index(j)];
        changes(j, changes.cols() - 1) =
            other.push.dot(answers.back().col(j)) + finger_sinking(other, one);
      }
      if (changes(i, changes.cols() - 1) <= 0.0)
        return "the finger presses nodes that cannot move; move the finger, or raise "
               "`solver.rings`";
    }
    if (sought.empty()) return std::nullopt;
    Eigen::VectorXd gaps(static_cast<Index>(sought.size()));
    for (std::size_t k = 0; k < sought.size(); ++k)
      gaps[static_cast<Index>(k)] = candidates_[as_index(sought[k])].gap;
    Eigen::VectorXd forces;
    if (!contact::press_apart(changes(sought, Eigen::all), gaps, pressed, forces))
      return "the mesh does not resist the finger's forces; set `tissue.base = \"bonded\"`";
    const Eigen::VectorXd opened = changes * forces;
    bool settled = true;
    for (Index i = 0; i < count; ++i) {
      Candidate& one = candidates_[as_index(i)];
      one.left = one.gap + opened[i];
      if (one.sought || !overlaps(one)) continue;
      one.sought = true;
      settled = false;
    }
    if (!settled) continue;
    for (std::size_t k = 0; k < sought.size(); ++k) {
      const double force = forces[static_cast<Index>(k)];
      candidates_[as_index(sought[k])].force = force;
      for (Index i = 0; i < count; ++i) candidates_[as_index(i)].moved += force * answers[k].col(i);
    }
    return std::nullopt;
  }
}

// Solves [unilateral], again and again if the directions turn with the nodes (sphere's normals).
std::optional<std::string> ResolvedContact::press(Influence& influence) {
  constexpr int most_turns = 100;
  const double settled = 1e-12 * scene_->finger.sphere_radius;
  for (int turn = 0; turn < most_turns; ++turn) {
    measure_gaps();
    std::vector<Vec3> before;
    for (const Candidate& one : candidates_) before.push_back(one.moved);
    if (auto wrong = solve(influence)) return wrong;
    if (!sphere_normals()) return std::nullopt;
    double change = 0.0;
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      if (candidates_[i].force > 0.0)
        change = std::max(change, (candidates_[i].moved - before[i]).norm());
    if (change <= settled) return std::nullopt;
  }
  return "the sphere's normals did not settle in 100 iterations; take smaller cells in "
         "`tissue.mesh`, or a smaller `solver.time_step`";
}

std::optional<std::string> ResolvedContact::find(const Vec3& finger,
                                                 const integrate::Vector& displacement,
                                                 Influence& influence, Touch& touch) {
  look(finger, displacement, touch);
  if (auto wrong = press(influence)) return wrong;
  touches_.meet(finger, balls_, {candidates_.begin(), candidates_.end()}, touch);
  return std::nullopt;
}

}  // namespace palpate::mechanics
