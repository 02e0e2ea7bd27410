// Meshes for a press: small where the finger presses, growing with the distance.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "geometry/curved_edges.h"
#include "geometry/shapes.h"
#include "geometry/smooth_surface.h"
#include "meshing/surface_remeshing.h"
#include "solid/elements.h"
#include "solid/surface_net.h"

namespace palpate::solid {

// Elements have the edge `size` up to `radius` from `centre`, and grow with the distance beyond.
struct Spot {
  Vec3 centre = Vec3::Zero();  // m
  double radius = 0.0;         // m
  double size = 0.0;           // m
};

struct Sizes {
  std::vector<Spot> spots;
  double largest = 0.0;    // m, up to `calm` from the centres of spots
  double calm = HUGE_VAL;  // m
  // Elements across what bends: a wall of which neither side is held.
  std::optional<double> across = {};

  // m, where the body is `wall` (m) thick; 0.35 of the distance is added.
  //                                                               docs/theory.md [solid_mesh]
  [[nodiscard]] double at(const Vec3& place, double wall) const;
};

// A part of a body with a tissue of its own: a ball, or a slab from side to side.
struct Inclusion {
  int region = 0;
  std::optional<geometry::Inclusion> sphere = {};  // its `region` is not used
  double bottom = 0.0, top = 0.0;                  // m, of a slab
};

struct MeshOrder {
  // One of the three gives the body.
  std::optional<geometry::Shape> shape;
  const geometry::SmoothSurface* surface = nullptr;
  bool coarser = true;                      // whether that may get larger triangles far away
  meshing::Nearer nearer = {};              // where it may do so least
  bool movable = true;                      // whether its edges may turn and its vertices move
  const geometry::TetMesh* mesh = nullptr;  // with its regions; is only refined
  const geometry::EdgeMiddles* middles = nullptr;  // of the mesh, if it is curved
  // Regions of the shape's own parts, by their numbers there.
  std::function<int(int)> region_of = {};
  std::vector<Inclusion> inclusions = {};  // later ones replace earlier ones
  std::vector<Plane> mirrors = {};         // the body above each is meshed
  std::optional<Plane> base = {};          // edges follow it where it crosses the body
  Sizes sizes;
};

// The mesh, with the middles of edges on the true boundary of the body, and of balls inside. Throws
// MeshError as meshing::tetgen_pieces() does, and if a ball is not wholly inside the body.
[[nodiscard]] Mesh mesh_for(const MeshOrder& order);

// Whether the body is its own mirror image: its surface, within 1e-4 of its size.
[[nodiscard]] bool symmetric(const geometry::Surface& surface, const Plane& plane);

}  // namespace palpate::solid
