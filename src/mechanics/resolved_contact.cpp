// Solves for the nodes in contact and their forces, docs/theory.md [unilateral], [gap].
#include "mechanics/resolved_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "contact/balance.h"

namespace palpate::mechanics {
namespace {

// The integral of p / r over the triangle, m: r is the distance from corner a, and p falls linearly
// from 1 at a to 0 on the side b c. Along a ray of length rho, int_0^rho (1 - r / rho) dr = rho
// / 2. With rho = d / cos(angle), d the distance of the side and t the coordinate along it, the
// integral is d/2 (asinh(t_c / d) - asinh(t_b / d)).
double hat_potential(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 along = (c - b).normalized();
  const double t_b = (b - a).dot(along);
  const double t_c = (c - a).dot(along);
  const double d = (b - a - t_b * along).norm();
  return 0.5 * d * (std::asinh(t_c / d) - std::asinh(t_b / d));
}

using Eigen::Index;

}  // namespace

// Computed before the first step, because asinh() may differ between processors in its last bit.
SurfaceNodes::SurfaceNodes(const geometry::SmoothSurface& surface) : surface_(&surface) {
  const geometry::Surface& outer_surface = surface.surface();
  triangles_.resize(outer_surface.triangles.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const int number = static_cast<int>(t);
    Triangle& triangle = triangles_[t];
    const Vec3 twice = geometry::twice_area(outer_surface, number);
    triangle.area = 0.5 * twice.norm();
    triangle.normal = twice.normalized();
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      const auto corner = [&](std::size_t k) -> const Vec3& {
        return outer_surface.vertices[as_index(outer_surface.triangles[t][k % 3])];
      };
      const Vec3 side = corner(next) - corner(i);
      triangle.squares += side.squaredNorm();
      triangle.turns +=
          side.dot(surface.corner_normal(number, next) - surface.corner_normal(number, i));
      triangle.own[i] = hat_potential(corner(i), corner(i + 1), corner(i + 2));
    }
  }
}

std::optional<PressedNode> SurfaceNodes::facing(int vertex, const Ball& ball) const {
  constexpr double least_facing = 0.2;  // cosine; triangles turned further away are not pressed
  PressedNode node;
  node.vertex = vertex;
  node.place = surface_->surface().vertices[as_index(vertex)];
  const Vec3 away = ball.centre - node.place;
  Vec3 normal = Vec3::Zero();
  double area = 0.0;
  for (const int t : surface_->neighbours().triangles_at(vertex)) {
    const Triangle& triangle = triangles_[as_index(t)];
    if (triangle.normal.dot(away) < least_facing * away.norm()) continue;
    const auto& corners = surface_->surface().triangles[as_index(t)];
    const auto corner = as_index(std::ranges::find(corners, vertex) - corners.begin());
    area += triangle.area;
    normal += triangle.area * surface_->corner_normal(t, corner);
    // A sphere of radius R through the ends of a straight side s is |s|^2 / (2 R) x_1 x_2 above it,
    // with linear weights x. Above a triangle the heights of the sides add up, and the mean of
    // x_1 x_2 is 1/12. The surface's curvature adds dn . s to |s|^2 / R, docs/theory.md [gap].
    node.facets += triangle.area * (triangle.squares / ball.radius + triangle.turns) / 24.0;
    node.own += triangle.own[corner];
  }
  if (area <= 0.0) return std::nullopt;
  node.normal = normal.normalized();
  node.area = area / 3.0;
  node.facets /= area;
  node.own /= node.area;
  return node;
}

ResolvedContact::ResolvedContact(const MovingPart& part)
    : part_(&part),
      scene_(part.scene),
      surface_(&*scene_->specimen->surface),
      outer_surface_(*surface_),
      tree_(surface_->surface()),
      stars_(surface_->surface(), surface_->neighbours(), {}),
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
    const auto outer_surface = outer_surface_.facing(v, balls_[as_index(sphere)]);
    if (!outer_surface) continue;
    Candidate one;
    one.outer_surface = *outer_surface;
    one.outer_surface.sphere = sphere;
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
    const Ball& ball = balls_[as_index(one.outer_surface.sphere)];
    const Vec3 to_centre = ball.centre - one.outer_surface.place;
    if (by_sphere) {
      // |x - c| - R, linearised at the present position of the node
      const Vec3 from_centre = one.moved - to_centre;
      one.push = from_centre.normalized();
      one.gap = from_centre.norm() - ball.radius + one.push.dot(one.base - one.moved);
    } else {
      // Distance to the sphere along the normal at rest, from the node at rest, minus its
      // displacement; infinite if the normal misses the sphere.
      one.push = -one.outer_surface.normal;
      const double height = to_centre.dot(one.outer_surface.normal);
      const double chord = ball.radius * ball.radius - to_centre.squaredNorm() + height * height;
      one.gap = chord <= 0.0 ? std::numeric_limits<double>::infinity()
                             : height - std::sqrt(chord) + one.push.dot(one.base);
    }
    one.gap += one.outer_surface.facets;
  }
}

// The finger's displacement at a node per newton on another, m/N, as a half-space.
double ResolvedContact::finger_surface_displacement(const Candidate& at,
                                                    const Candidate& pressed) const {
  if (at.outer_surface.sphere != pressed.outer_surface.sphere) return 0.0;
  const double inverse = &at == &pressed
                             ? at.outer_surface.own
                             : 1.0 / (at.outer_surface.place - pressed.outer_surface.place).norm();
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
      if (!one.sought || std::ranges::find(sought, i) != sought.end()) continue;
      sought.push_back(i);
      pressed.push_back(overlaps(one) ? 1 : 0);
      answers.push_back(answer(influence, one));
      changes.conservativeResize(Eigen::NoChange, changes.cols() + 1);
      for (Index j = 0; j < count; ++j) {
        const Candidate& other = candidates_[as_index(j)];
        changes(j, changes.cols() - 1) =
            other.push.dot(answers.back().col(j)) + finger_surface_displacement(other, one);
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

// Hertz's law at the pressed place, for estimates; the nodal forces do not use it.
contact::ContactLaw ResolvedContact::law_for_estimates(const geometry::SurfacePoint& at) const {
  const contact::SphereLaw sphere{scene_->finger.sphere_radius, scene_->finger.sphere_modulus};
  const auto corners = stars_.at_corners(surface_->surface(), at.triangle);
  const auto found = geometry::between(corners, {at.weights[0], at.weights[1], at.weights[2]});
  if (found.known())
    if (const auto law =
            contact::contact_law(scene_->scenario.contact.law, sphere, found.curvature))
      return *law;
  return *contact::contact_law(scene_->scenario.contact.law, sphere, {});
}

// Adds the contact of one sphere, from the forces on its nodes; nothing if all are zero.
void ResolvedContact::fill(int sphere, const Touch& before, Touch& touch) const {
  const Ball& ball = balls_[as_index(sphere)];
  SphereContact& contact = touch.contacts.add();
  contact.sphere = sphere;
  Vec3 sum = Vec3::Zero();
  Vec3 centre = Vec3::Zero();
  double total = 0.0;
  double area = 0.0;
  for (const Candidate& one : candidates_) {
    if (one.outer_surface.sphere != sphere) continue;
    contact.nodal.vertices.push_back(one.outer_surface.vertex);
    contact.nodal.gap.push_back(std::max(0.0, one.left));
    if (one.force <= 0.0) continue;
    contact.load.vertices.push_back(one.outer_surface.vertex);
    contact.load.shares.push_back(one.force);
    contact.nodal.push.push_back(one.force * one.push);
    sum += one.force * one.push;
    centre += one.force * one.outer_surface.place;
    contact.nodal.peak_pressure =
        std::max(contact.nodal.peak_pressure, one.force / one.outer_surface.area);
    total += one.force;
    area += one.outer_surface.area;
  }
  if (total <= 0.0) {
    touch.contacts.erase(touch.contacts.size() - 1);
    return;
  }
  contact.force = sum.norm();
  for (double& share : contact.load.shares) share /= total;
  for (Vec3& push : contact.nodal.push) push /= contact.force;
  const auto closest_point = surface_->closest_point(ball.centre, tree_.nearest(ball.centre));
  contact.patch.at = closest_point.at;
  contact.patch.position = centre / total;
  contact.patch.normal = -sum / contact.force;
  contact.patch.axis = contact.patch.normal.unitOrthogonal();
  contact.patch.a = contact.patch.b = std::sqrt(area / std::numbers::pi);
  contact.approach = contact.depth = ball.radius - closest_point.height;
  contact.law = law_for_estimates(closest_point.at);
  for (const SphereContact& old : before.contacts)
    if (old.sphere == sphere) contact.stretch = old.stretch;
}

std::optional<std::string> ResolvedContact::find(const Vec3& finger,
                                                 const integrate::Vector& displacement,
                                                 Influence& influence, Touch& touch) {
  look(finger, displacement, touch);
  if (auto wrong = press(influence)) return wrong;
  Touch next = touch;
  next.contacts.clear();
  for (std::size_t i = 0; i < balls_.size(); ++i) fill(static_cast<int>(i), touch, next);
  next.finger = finger;
  rub(*scene_, finger - touch.finger, next);
  touch = std::move(next);
  return std::nullopt;
}

}  // namespace palpate::mechanics
