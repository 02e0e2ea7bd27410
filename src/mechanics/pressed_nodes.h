// Geometry of the surface's nodes that a sphere may press: area, normal, offset of the facets.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/smooth_surface.h"

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

class SkinNodes {
 public:
  explicit SkinNodes(const geometry::SmoothSurface& surface);

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

}  // namespace palpate::mechanics
