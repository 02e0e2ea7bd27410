// A body for a solid: its mesh, made for a press, with what holds it.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "geometry/smooth_surface.h"
#include "solid/mesher.h"
#include "solid/press.h"
#include "tissue/supports.h"

namespace palpate::solid {

struct BodyOrder {
  // One of the three gives the body, as in MeshOrder.
  std::optional<geometry::Shape> shape = {};
  const geometry::SmoothSurface* surface = nullptr;
  bool coarser = true;  // as there
  bool movable = true;  // as there
  const geometry::TetMesh* mesh = nullptr;
  const geometry::EdgeMiddles* middles = nullptr;
  std::function<int(int)> region_of = {};
  std::vector<Inclusion> inclusions = {};

  std::vector<tissue::Isotropic> tissues;  // one per region
  tissue::Base base = tissue::Base::bonded;
  double base_level = 0.0;       // m, absolute; the surface up to this height is the base
  Vec3 base_up = Vec3::UnitZ();  // the direction of that height; if it is not z, the base is bonded

  double radius = 0.0;             // m, of the balls
  double travel = 0.0;             // m, the deepest
  std::vector<Vec3> touched = {};  // m, where balls meet the body along their way
  // Whether finger and way are their own images across a plane through the first touch, normal to x
  // and y. The body is then halved where it is its own image too.
  std::array<bool, 2> mirrored{};
  double per_radius = 2.0;  // elements per contact radius sqrt(radius travel)
};

// Throws MeshError as mesh_for() does, and if the base does not hold the body.
[[nodiscard]] Body make_body(const BodyOrder& order);

// The lower half of an elastic ball, turned up: its equator lies on a plane on which it slides, its
// pole is at (0, 0, radius). A quarter is meshed, for a contact radius of sqrt(radius depth), m, in
// which the ball takes `travel` (m) of the depth.
[[nodiscard]] Body make_ball(double radius, double depth, double travel,
                             const tissue::Isotropic& material, double per_radius);

}  // namespace palpate::solid
