// The nodes of the skin that a sphere may press: their part of the skin, and their way to it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/smooth_surface.h"

namespace palpate::run {

// A sphere of the finger.
struct Ball {
  Vec3 centre = Vec3::Zero();  // m
  double radius = 0.0;         // m
};

// A vertex of the skin under a sphere.                                    docs/theory.md (70)-(72)
struct PressedNode {
  int vertex = 0;
  int sphere = 0;
  Vec3 place = Vec3::Zero();    // m, at rest
  Vec3 normal = Vec3::UnitZ();  // unit, outwards, at rest: of the sides that face the sphere
  double area = 0.0;            // m^2, a third of those sides' triangles
  double facets = 0.0;          // m, that a sphere stands off flat triangles in the mean
  double own = 0.0;             // 1/m, of a half-space's sinking under its own load: own / (pi E')
};

class SkinNodes {
 public:
  explicit SkinNodes(const geometry::SmoothSurface& surface);

  // What a vertex of the skin is to a sphere (without PressedNode::sphere); nothing where no side
  // of it faces the sphere.
  [[nodiscard]] std::optional<PressedNode> facing(int vertex, const Ball& ball) const;

 private:
  // Of a triangle, and of the pressure over it that falls from 1 at a corner to 0 at the others.
  struct Triangle {
    Vec3 normal = Vec3::UnitZ();
    double area = 0.0;            // m^2
    double squares = 0.0;         // m^2, of its sides' lengths together
    double turns = 0.0;           // m, over its sides: change of normal . side
    std::array<double, 3> own{};  // m, integral of that pressure over the distance from its corner
  };
  const geometry::SmoothSurface* surface_;
  std::vector<Triangle> triangles_;
};

}  // namespace palpate::run
