// Unilateral contact at the nodes of a fine mesh, for the coupling `resolved`.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/box_tree.h"
#include "geometry/curvature.h"
#include "geometry/smooth_surface.h"
#include "mechanics/contacts.h"
#include "mechanics/influence.h"

namespace palpate::mechanics {

// A sphere of the finger.
struct Ball {
  Vec3 centre = Vec3::Zero();  // m
  double radius = 0.0;         // m
};

// A vertex of the surface under a sphere.     docs/theory.md [unilateral], [gap], [nodal_pressure]
struct PressedNode {
  int vertex = 0;
  int sphere = 0;
  Vec3 place = Vec3::Zero();    // m, at rest
  Vec3 normal = Vec3::UnitZ();  // unit, outwards, at rest: of the triangles that face the sphere
  double area = 0.0;            // m^2, a third of the area of these triangles
  double facets = 0.0;          // m, o_j of [gap]: mean height of the sphere above flat triangles
  double own = 0.0;             // 1/m: a half-space sinks by own / (pi E') per newton on this node
};

class SurfaceNodes {
 public:
  explicit SurfaceNodes(const geometry::SmoothSurface& surface);

  // The node under a sphere (`sphere` is left at 0); nothing if none of its triangles faces it.
  [[nodiscard]] std::optional<PressedNode> facing(int vertex, const Ball& ball) const;

 private:
  struct Triangle {
    Vec3 normal = Vec3::UnitZ();
    double area = 0.0;            // m^2
    double squares = 0.0;         // m^2, sum of the squared lengths of the sides
    double turns = 0.0;           // m, sum over the sides of (change of normal) . side
    std::array<double, 3> own{};  // m, integral of p / (distance from a corner) over the triangle,
                                  // where p falls linearly from 1 at this corner to 0 at the others
  };
  const geometry::SmoothSurface* surface_;
  std::vector<Triangle> triangles_;
};

// Every node of the surface near a sphere has a gap g_j >= 0 and a force f_j >= 0, one of which is
// zero, docs/theory.md [unilateral]. They are related by the compliance of the mesh and, for an
// elastic finger, of a half-space. Friction is not part of this problem; it acts on the resultant.
class ResolvedContact {
 public:
  // The part must outlive this.
  explicit ResolvedContact(const MovingPart& part);

  // As SurfaceContacts::find(). `displacement` (m) is that at the end of the step without the
  // contact forces, `influence` the response to them. Gives one contact per sphere that presses.
  [[nodiscard]] std::optional<std::string> find(const Vec3& finger,
                                                const integrate::Vector& displacement,
                                                Influence& influence, Touch& touch);

 private:
  // A node that may be in contact.
  struct Candidate {
    PressedNode outer_surface;
    int node = -1;              // of the moving mesh; -1: does not move
    Vec3 push = Vec3::Zero();   // unit, direction of the force on the node
    Vec3 base = Vec3::Zero();   // m, displacement without contact forces
    Vec3 moved = Vec3::Zero();  // m, displacement with contact forces
    double gap = 0.0;           // m, without contact forces
    double left = 0.0;          // m, gap with contact forces
    double force = 0.0;         // N
    bool sought = false;        // the force is an unknown of the current problem
  };

  void look(const Vec3& finger, const integrate::Vector& displacement, const Touch& before);
  void measure_gaps();
  [[nodiscard]] std::optional<std::string> press(Influence& influence);
  [[nodiscard]] std::optional<std::string> solve(Influence& influence);
  [[nodiscard]] Eigen::Matrix3Xd answer(Influence& influence, const Candidate& loaded) const;
  [[nodiscard]] double finger_surface_displacement(const Candidate& at,
                                                   const Candidate& pressed) const;
  [[nodiscard]] bool sphere_normals() const;
  [[nodiscard]] contact::ContactLaw law_for_estimates(const geometry::SurfacePoint& at) const;
  void fill(int sphere, const Touch& before, Touch& touch) const;

  const MovingPart* part_;
  const scene::Scene* scene_;
  const geometry::SmoothSurface* surface_;
  SurfaceNodes outer_surface_;
  geometry::BoxTree tree_;
  geometry::CurvatureStars stars_;
  double finger_compliance_ = 0.0;  // 1/Pa, lambda_1
  std::vector<Ball> balls_;
  std::vector<Candidate> candidates_;
};

}  // namespace palpate::mechanics
