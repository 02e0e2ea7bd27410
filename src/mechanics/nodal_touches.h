// The contacts that forces on single nodes of the surface make up.
#pragma once

#include <vector>

#include "geometry/box_tree.h"
#include "geometry/curvature.h"
#include "mechanics/contacts.h"
#include "mechanics/pressed_nodes.h"

namespace palpate::mechanics {

// A node that a sphere may push.
struct PushedNode {
  PressedNode skin;
  Vec3 push = Vec3::Zero();  // unit, direction of the force on the node
  double left = 0.0;         // m, gap with contact forces
  double force = 0.0;        // N
};

class NodalTouches {
 public:
  // The scene, which has a specimen, must outlive this.
  explicit NodalTouches(const scene::Scene& scene);

  // Replaces the contacts of `touch` by one per sphere that pushes nodes, with the finger at
  // `finger` (m) and its friction.
  void meet(const Vec3& finger, const std::vector<Ball>& balls,
            const std::vector<PushedNode>& nodes, Touch& touch) const;

 private:
  void fill(int sphere, const Ball& ball, const std::vector<PushedNode>& nodes, const Touch& before,
            Touch& touch) const;
  [[nodiscard]] contact::ContactLaw law_for_estimates(const geometry::SurfacePoint& at) const;

  const scene::Scene* scene_;
  const geometry::SmoothSurface* surface_;
  geometry::BoxTree tree_;
  geometry::CurvatureStars stars_;
};

}  // namespace palpate::mechanics
