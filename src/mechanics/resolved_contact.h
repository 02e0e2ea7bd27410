// Unilateral contact at the nodes of a fine mesh, for the coupling `resolved`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/influence.h"
#include "mechanics/nodal_touches.h"

namespace palpate::mechanics {

// Every node of the surface near a sphere has a gap g_j >= 0 and a force f_j >= 0, one of which is
// zero, docs/theory.md [unilateral]. They are related by the compliance of the mesh and, for an
// elastic finger, of a half-space. Friction is not part of this problem; it acts on the resultant.
class ResolvedContact {
 public:
  // The part must outlive this.
  explicit ResolvedContact(const MovingPart& part);

  // As SkinContacts::find(). `displacement` (m) is that at the end of the step without the contact
  // forces, `influence` the response to them. Gives one contact per sphere that presses.
  [[nodiscard]] std::optional<std::string> find(const Vec3& finger,
                                                const integrate::Vector& displacement,
                                                Influence& influence, Touch& touch);

 private:
  // A node that may be in contact.
  struct Candidate : PushedNode {
    int node = -1;              // of the moving mesh; -1: does not move
    Vec3 base = Vec3::Zero();   // m, displacement without contact forces
    Vec3 moved = Vec3::Zero();  // m, displacement with contact forces
    double gap = 0.0;           // m, without contact forces
    bool sought = false;        // the force is an unknown of the current problem
  };

  void look(const Vec3& finger, const integrate::Vector& displacement, const Touch& before);
  void measure_gaps();
  [[nodiscard]] std::optional<std::string> press(Influence& influence);
  [[nodiscard]] std::optional<std::string> solve(Influence& influence);
  [[nodiscard]] Eigen::Matrix3Xd answer(Influence& influence, const Candidate& loaded) const;
  [[nodiscard]] double finger_sinking(const Candidate& at, const Candidate& pressed) const;
  [[nodiscard]] bool sphere_normals() const;

  const MovingPart* part_;
  const scene::Scene* scene_;
  const geometry::SmoothSurface* surface_;
  SkinNodes skin_;
  NodalTouches touches_;
  double finger_compliance_ = 0.0;  // 1/Pa, lambda_1
  std::vector<Ball> balls_;
  std::vector<Candidate> candidates_;
};

}  // namespace palpate::mechanics
