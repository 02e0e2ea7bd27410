// The smooth boundaries that the faces of a mesh stand for, so that refined meshes approach them.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "geometry/shapes.h"
#include "geometry/smooth_surface.h"
#include "meshing/bisection.h"

namespace palpate::meshing {

class TrueBoundary {
 public:
  // `start` is the mesh before the first refinement. Its outer nodes, and those between the regions
  // of `shape`, lie on the shape; without a shape the smooth surface through the outer nodes counts
  // (geometry/smooth_surface.h), and boundaries between regions other than inclusions stay as they
  // are. Nodes on edges at one of the heights `levels` (m) stay at that height.
  TrueBoundary(const geometry::TetMesh& start, std::optional<geometry::Shape> shape,
               std::span<const geometry::Lump> lumps, std::span<const double> levels);

  // The place (m) of the node on an edge: Bisection::Place. Every mesh is refined from the one
  // before, so that this sees all nodes in their order.
  [[nodiscard]] Vec3 place(const Bisection::Middle& edge);

  // Gives every inclusion its volume again, by moving its nodes along its radii; the regions'
  // numbers are those of `lumps`.
  void restore_lumps(geometry::TetMesh& mesh);

 private:
  // A node's position on the smooth surface: corners of one of its triangles with their weights.
  struct OnSkin {
    std::array<int, 3> vertices{-1, -1, -1};
    Vec3 weights = Vec3::Zero();
  };
  [[nodiscard]] OnSkin between(const OnSkin& a, const OnSkin& b, double share) const;
  [[nodiscard]] Vec3 smooth_place(const Bisection::Middle& edge, const OnSkin& here) const;
  [[nodiscard]] std::optional<Vec3> position(const OnSkin& at) const;
  [[nodiscard]] bool on_end(const Bisection::Middle& edge) const;

  std::optional<geometry::Shape> shape_;
  std::vector<geometry::Lump> lumps_;
  std::vector<double> levels_;
  std::vector<Vec3> nodes_;  // m, as far as they are known here
  geometry::SmoothSurface skin_;
  std::vector<OnSkin> on_skin_;  // per node
  double length_ = 0.0;          // m, of the shape along y
};

}  // namespace palpate::meshing
