// Newton's method with a line search, inside the augmented Lagrangian's updates.
#include "mechanics/solid_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::mechanics {
namespace {

using integrate::Vector;

constexpr double reach = 1.25;      // distance from a centre, in radii, of nodes that are looked at
constexpr double settled = 1e-6;    // of the radius: gaps of pushed nodes
constexpr double last_step = 1e-5;  // of the radius: Newton's; what is left is of its square
constexpr double stiff_nodes = 300.0;  // penalty over E' sqrt(area)
constexpr int most_descents = 60;
constexpr int most_updates = 30;
constexpr int most_halvings = 8;

}  // namespace

SolidContact::SolidContact(const MovingPart& part)
    : part_(&part),
      scene_(part.scene),
      surface_(&*scene_->specimen->surface),
      skin_(*surface_),
      touches_(*scene_),
      solid_(scene_->specimen->mesh, scene::tissues_of(scene_->scenario), scene::own_share),
      held_back_(surface_->surface().vertices.size(), 0.0) {
  for (const Vec3& centre : scene_->finger.centres)
    balls_.push_back({centre, scene_->finger.sphere_radius});
}

// Fills nodes_ with the nodes near the spheres, each with the sphere nearest to it.
void SolidContact::look(const Vec3& finger, const Vector& displacement) {
  for (std::size_t i = 0; i < balls_.size(); ++i)
    balls_[i].centre = finger + scene_->finger.centres[i];
  const tissue::Isotropic top{scene_->scenario.tissue.young_modulus,
                              scene_->scenario.tissue.poisson_ratio};
  const double modulus = top.young_modulus / (1.0 - top.poisson_ratio * top.poisson_ratio);
  nodes_.clear();
  penalty_.clear();
  for (std::size_t v = 0; v < held_back_.size(); ++v) {
    const int node = part_->node_of(static_cast<int>(v));
    const Vec3 place = surface_->surface().vertices[v] + displacement.segment<3>(3 * node);
    double nearest = reach * scene_->finger.sphere_radius;
    int sphere = -1;
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const double distance = (place - balls_[i].centre).norm();
      if (distance > nearest) continue;
      nearest = distance;
      sphere = static_cast<int>(i);
    }
    if (sphere < 0) continue;
    const auto skin = skin_.facing(static_cast<int>(v), balls_[as_index(sphere)]);
    if (!skin) continue;
    nodes_.push_back({.skin = *skin});
    nodes_.back().skin.sphere = sphere;
    penalty_.push_back(stiff_nodes * modulus * std::sqrt(skin->area));
  }
}

// The gaps and forces of all nodes.
void SolidContact::measure(const Vector& displacement) {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    PushedNode& one = nodes_[k];
    const Ball& ball = balls_[as_index(one.skin.sphere)];
    const Vec3 from =
        one.skin.place - ball.centre + displacement.segment<3>(3 * part_->node_of(one.skin.vertex));
    const double distance = from.norm();
    one.push = from / distance;
    one.left = distance - ball.radius + one.skin.facets;
    one.force = std::max(0.0, held_back_[as_index(one.skin.vertex)] - penalty_[k] * one.left);
  }
}

// Of the solid and of the Lagrangian's terms, J.
double SolidContact::energy(const Vector& displacement) {
  stored_ = solid_.energy(displacement);
  if (!std::isfinite(stored_)) return stored_;
  measure(displacement);
  double sum = stored_;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const double before = held_back_[as_index(nodes_[k].skin.vertex)];
    sum += 0.5 * (nodes_[k].force * nodes_[k].force - before * before) / penalty_[k];
  }
  return sum;
}

// Newton's method for the present multipliers.
bool SolidContact::descend(Vector& displacement) {
  const double radius = scene_->finger.sphere_radius;
  const auto held = part_->body->held();
  double now = energy(displacement);
  if (!std::isfinite(now)) return false;
  for (int i = 0; i < most_descents; ++i) {
    solid_.force(gradient_);
    for (const PushedNode& one : nodes_)
      gradient_.segment<3>(3 * part_->node_of(one.skin.vertex)) -= one.force * one.push;
    for (std::size_t d = 0; d < held.size(); ++d)
      if (held[d] != 0) gradient_[static_cast<Eigen::Index>(d)] = 0.0;
    const auto factor = [&](bool bounded) {
      SplitMatrix matrix = solid_.stiffness(held, bounded);
      for (std::size_t k = 0; k < nodes_.size(); ++k) {
        const PushedNode& one = nodes_[k];
        if (one.force <= 0.0) continue;
        const Ball& ball = balls_[as_index(one.skin.sphere)];
        const double distance = one.left - one.skin.facets + ball.radius;
        const double across = bounded ? 0.0 : one.force / distance;
        const int first = 3 * part_->node_of(one.skin.vertex);
        for (int p = 0; p < 3; ++p)
          for (int q = 0; q < 3; ++q)
            if (held[as_index(first + p)] == 0 && held[as_index(first + q)] == 0)
              matrix.local.coeffRef(first + p, first + q) +=
                  (penalty_[k] + across) * one.push[p] * one.push[q] - (p == q ? across : 0.0);
      }
      return factors_.factor(matrix);
    };
    if (!factor(false) && !factor(true)) return false;
    factors_.solve(-gradient_, step_);
    const double length = step_.cwiseAbs().maxCoeff();
    if (!std::isfinite(length)) return false;
    const double slope = gradient_.dot(step_);
    double part = 1.0;
    for (;; part *= 0.5) {
      tried_ = displacement + part * step_;
      const double then = energy(tried_);
      // Below this length rounding hides the decrease.
      const bool small = part == 1.0 && length <= last_step * radius;
      if (std::isfinite(then) && (small || then <= now + 1e-4 * part * slope)) {
        now = then;
        break;
      }
      if (part < 1e-6) return false;
    }
    displacement = tried_;
    if (part == 1.0 && length <= last_step * radius) return true;
  }
  return false;
}

// Equilibrium with the finger there; leaves `displacement` and the multipliers on failure.
bool SolidContact::settle(const Vec3& finger, Vector& displacement) {
  const std::vector<double> multipliers = held_back_;
  Vector moved = displacement;
  look(finger, moved);
  for (int i = 0; i < most_updates && descend(moved); ++i) {
    double overlap = 0.0;
    for (const PushedNode& one : nodes_) {
      held_back_[as_index(one.skin.vertex)] = one.force;
      if (one.force > 0.0) overlap = std::max(overlap, std::abs(one.left));
    }
    if (overlap > settled * scene_->finger.sphere_radius) continue;
    displacement = std::move(moved);
    return true;
  }
  held_back_ = multipliers;
  return false;
}

bool SolidContact::approach(const Vec3& from, const Vec3& to, Vector& displacement, int halvings) {
  if (settle(to, displacement)) return true;
  if (halvings == 0) return false;
  const Vec3 middle = 0.5 * (from + to);
  return approach(from, middle, displacement, halvings - 1) &&
         approach(middle, to, displacement, halvings - 1);
}

std::optional<std::string> SolidContact::press(const Vec3& finger, Vector& displacement,
                                               Touch& touch) {
  if (!approach(touch.finger, finger, displacement, most_halvings))
    return "no equilibrium of the neo-Hookean tissue was found, even in steps 256 times smaller; "
           "press less deep, or give `tissue.mesh` other cells";
  touches_.meet(finger, balls_, nodes_, touch);
  return std::nullopt;
}

}  // namespace palpate::mechanics
