// A neo-Hookean specimen under the finger, in equilibrium at every step.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/cholesky.h"
#include "mechanics/moving_part.h"
#include "mechanics/nodal_touches.h"
#include "tissue/neo_hookean.h"

namespace palpate::mechanics {

// Every node of the skin near a rigid sphere stays outside of it, at its displaced place, and is
// pushed along the sphere's normal. Newton's method finds the least of the energy with augmented
// Lagrangian terms for the gaps (Simo and Laursen 1992), in smaller steps of the finger where one
// is too large. The nodes' gaps are those of `resolved`.                  docs/theory.md (97)
class SolidContact {
 public:
  // The part, which is the whole specimen, must outlive this.
  explicit SolidContact(const MovingPart& part);

  // Moves the finger to `finger` (m), and `displacement` (m) to the equilibrium there. Returns a
  // sentence if none is found.
  [[nodiscard]] std::optional<std::string> press(const Vec3& finger,
                                                 integrate::Vector& displacement, Touch& touch);
  [[nodiscard]] double stored() const { return stored_; }  // J, after press()

 private:
  void look(const Vec3& finger, const integrate::Vector& displacement);
  void measure(const integrate::Vector& displacement);
  [[nodiscard]] double energy(const integrate::Vector& displacement);
  [[nodiscard]] bool descend(integrate::Vector& displacement);
  [[nodiscard]] bool settle(const Vec3& finger, integrate::Vector& displacement);
  [[nodiscard]] bool approach(const Vec3& from, const Vec3& to, integrate::Vector& displacement,
                              int halvings);

  const MovingPart* part_;
  const scene::Scene* scene_;
  const geometry::SmoothSurface* surface_;
  SkinNodes skin_;
  NodalTouches touches_;
  tissue::NeoHookean solid_;
  Cholesky factors_;
  std::vector<Ball> balls_;
  std::vector<PushedNode> nodes_;  // near the finger, with their forces
  std::vector<double> held_back_;  // N, one per vertex of the skin: the Lagrangian's multiplier
  std::vector<double> penalty_;    // N/m, one per entry of nodes_
  integrate::Vector gradient_, step_, tried_;
  double stored_ = 0.0;
};

}  // namespace palpate::mechanics
