// Refines a tetrahedral mesh locally, by splitting edges with all tetrahedra around them.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "geometry/shapes.h"
#include "geometry/smooth_surface.h"
#include "geometry/tet_mesh.h"

namespace palpate::meshing {

// A tetrahedron is only ever halved at its longest edge, together with all tetrahedra around that
// edge; where the edge is not the longest of one of these, that one is halved first (Rivara 1984,
// Int. J. Numer. Methods Eng. 20, 745). The mesh stays conforming, existing nodes keep their places
// and numbers, and children keep their parent's region. Edges of equal length are told apart by
// their nodes, so that the same input gives the same mesh.
class Bisection {
 public:
  // The new node on an edge.
  struct Middle {
    int a = 0;
    int b = 0;
    double share = 0.5;           // of the way from a to b
    Vec3 between = Vec3::Zero();  // m, there
    std::vector<int> outer;       // third nodes of the boundary faces at the edge; empty inside
    bool inner = false;           // on a face between two regions
  };
  // Decides where the node on an edge goes, m. Nodes have consecutive numbers in the order of
  // calls.
  using Place = std::function<Vec3(const Middle&)>;

  // The mesh has passed check(), mesh_check.h.
  Bisection(geometry::TetMesh mesh, Place place);

  // Halves every tetrahedron with marked[t] > 0, its halves if it is above 1, and so on: after
  // three times their edges have about half the length. Where `place` would turn a tetrahedron
  // inside out or make it flat, the node stays nearer to the edge, if necessary on it.
  void halve(std::span<const char> marked);

  // Splits every edge that crosses the plane at height z (m), or only those on the boundary, so
  // that nodes lie in the plane instead. To be called before halve().
  void cut(double z, bool outer_only);

  // Without the tetrahedra that have been halved.
  [[nodiscard]] geometry::TetMesh mesh() const;

 private:
  struct Edge {
    int a = 0;  // below b
    int b = 0;
    double squared = 0.0;  // m^2, of its length

    [[nodiscard]] bool operator==(const Edge& other) const { return a == other.a && b == other.b; }
  };
  [[nodiscard]] Edge longest(int tetrahedron) const;
  [[nodiscard]] std::vector<int> around(const Edge& edge) const;
  void halve(int tetrahedron);
  void split(const Edge& edge, double share = 0.5, const double* height = nullptr);

  geometry::TetMesh mesh_;
  Place place_;
  std::vector<char> left_;            // per tetrahedron: how often it is still to be halved
  std::vector<char> gone_;            // per tetrahedron
  std::vector<std::vector<int>> at_;  // per node: its tetrahedra, with some that are gone
};

// The smooth boundaries that the faces of a mesh stand for, so that refined meshes approach them.
class TrueBoundary {
 public:
  // `start` is the mesh before the first refinement. Its outer nodes, and those between the regions
  // of `shape`, lie on the shape; without a shape the smooth surface through the outer nodes counts
  // (geometry/smooth_surface.h), and boundaries between regions other than inclusions stay as they
  // are. Nodes on edges at one of the heights `levels` (m) stay at that height.
  TrueBoundary(const geometry::TetMesh& start, std::optional<geometry::Shape> shape,
               std::span<const geometry::Inclusion> inclusions, std::span<const double> levels);

  // The place (m) of the node on an edge: Bisection::Place. Every mesh is refined from the one
  // before, so that this sees all nodes in their order.
  [[nodiscard]] Vec3 place(const Bisection::Middle& edge);

  // Gives every inclusion its volume again, by moving its nodes along its radii; the regions'
  // numbers are those of `inclusions`.
  void restore_inclusions(geometry::TetMesh& mesh);

 private:
  // A node's position on the smooth surface: corners of one of its triangles with their weights.
  struct OnSurface {
    std::array<int, 3> vertices{-1, -1, -1};
    Vec3 weights = Vec3::Zero();
  };
  [[nodiscard]] OnSurface between(const OnSurface& a, const OnSurface& b, double share) const;
  [[nodiscard]] Vec3 smooth_place(const Bisection::Middle& edge, const OnSurface& here) const;
  [[nodiscard]] std::optional<Vec3> position(const OnSurface& at) const;
  [[nodiscard]] bool on_end(const Bisection::Middle& edge) const;

  std::optional<geometry::Shape> shape_;
  std::vector<geometry::Inclusion> inclusions_;
  std::vector<double> levels_;
  std::vector<Vec3> nodes_;  // m, as far as they are known here
  geometry::SmoothSurface outer_surface_;
  std::vector<OnSurface> on_surface_;  // per node
  double length_ = 0.0;                // m, of the shape along y
  int axis_ = 1;                       // normal to its flat ends
};

// The mesh with no edge across the plane at height z (m), or no edge of its boundary. A node that
// is nearer to the plane than a quarter of an edge that crosses it is moved there along that edge,
// if that leaves the boundary's creases and the borders of regions where they are and turns nothing
// inside out; the other edges are split. New nodes on the boundary are on `shape`, or on the smooth
// surface through the mesh's nodes without one.
[[nodiscard]] geometry::TetMesh cut_at(geometry::TetMesh mesh, double z, bool outer_only,
                                       const std::optional<geometry::Shape>& shape);

}  // namespace palpate::meshing
