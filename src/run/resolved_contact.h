// The finger on a mesh that is fine enough to carry the contact itself: forces node by node.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/box_tree.h"
#include "geometry/curvature.h"
#include "run/contacts.h"
#include "run/pressed_nodes.h"

namespace palpate::run {

// Every node of the skin keeps a gap g_j >= 0 to the spheres and takes a force f_j >= 0, one of
// them zero; the mesh's compliance and, for an elastic finger, a half-space's of the finger
// connect them. Without friction inside; drag acts on the resultant.      docs/theory.md (70)-(72)
class ResolvedContact {
 public:
  explicit ResolvedContact(const scene::Scene& scene);

  // As Contacts::find(): `mesh.displacement` is where the mesh goes without these contacts' forces,
  // `mesh.influence` what they add. One contact a sphere that presses.
  [[nodiscard]] std::optional<std::string> find(const Vec3& finger, const MeshAnswer& mesh,
                                                Touch& touch);

 private:
  // A node with what the answer is sought of.
  struct Candidate {
    PressedNode skin;
    int node = -1;              // of the mesh that moves
    Vec3 base = Vec3::Zero();   // m, its displacement without forces
    Vec3 moved = Vec3::Zero();  // m, with them
    Vec3 push = Vec3::Zero();   // unit, of the force on it
    double gap = 0.0;           // m, without forces
    double left = 0.0;          // m, with them
    double force = 0.0;         // N
    bool sought = false;        // its force is
  };

  void look(const Vec3& finger, const MeshAnswer& mesh, const Touch& before);
  void measure_gaps();
  [[nodiscard]] std::optional<std::string> press(const MeshAnswer& mesh);
  [[nodiscard]] std::optional<std::string> solve(const MeshAnswer& mesh);
  [[nodiscard]] Eigen::Matrix3Xd answer(const MeshAnswer& mesh, const Candidate& loaded) const;
  [[nodiscard]] double finger_sinking(const Candidate& at, const Candidate& pressed) const;
  [[nodiscard]] bool sphere_normals() const;
  void fill(int sphere, const Touch& before, Touch& touch) const;
  [[nodiscard]] contact::ContactLaw law_for_estimates(const geometry::SurfacePoint& at) const;

  const scene::Scene* scene_;
  const geometry::SmoothSurface* surface_;
  SkinNodes skin_;
  geometry::BoxTree tree_;
  geometry::CurvatureStars stars_;
  double finger_compliance_ = 0.0;  // 1/Pa, lambda_1
  std::vector<Ball> balls_;
  std::vector<Candidate> candidates_;
};

}  // namespace palpate::run
