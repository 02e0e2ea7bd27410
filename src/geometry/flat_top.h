// The flat upper face of a body: its triangles, its nodes, and which triangle holds a point.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/tet_mesh.h"

namespace palpate::geometry {

// A point of the face between three nodes: position = sum of weights[i] * position of nodes[i].
struct FacePoint {
  std::array<int, 3> nodes{};       // indices into the mesh
  std::array<double, 3> weights{};  // 0 or more each, and 1 in sum up to rounding
};

// Holds copies of the plane coordinates: later movement of the mesh does not reach it.
class FlatTop {
 public:
  // The boundary triangles of `mesh` that face upwards and lie wholly in the plane at height `z`
  // (m), within 1e-9 of the mesh's diagonal. Throws MeshError where there are none.
  FlatTop(const TetMesh& mesh, double z);

  // The triangle that holds (x, y) in m, or nothing outside the face. A point on a shared edge
  // belongs to the triangle that comes first; one that rounding moved across an edge by up to
  // 1e-10 of a triangle's height is not lost. Constant time on average; no allocation.
  [[nodiscard]] std::optional<FacePoint> locate(double x, double y) const;

  // The face's node indices, ascending.
  [[nodiscard]] const std::vector<int>& nodes() const { return nodes_; }

  // Counter-clockwise from above, in the order of boundary_faces().
  [[nodiscard]] const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }

  [[nodiscard]] double area() const { return area_; }  // m^2

  // The edge of the equilateral triangle that has the mean area A: l = sqrt(4 A / sqrt(3)), in m.
  // A lattice of squares of side h, halved, has 1.075 h.
  [[nodiscard]] double mean_spacing() const;

 private:
  // Corner a and the inverse of the matrix (b - a, c - a): weights of b and c by four products.
  struct Shape {
    double ax, ay;
    double bx, by;  // weight of b = bx (x - ax) + by (y - ay)
    double cx, cy;  // weight of c = cx (x - ax) + cy (y - ay)
  };

  // Square bins over the face's bounding box; bin b lists the triangles bin_triangles_[i] with
  // bin_starts_[b] <= i < bin_starts_[b + 1], ascending.
  struct Bins {
    double low_x = 0.0, low_y = 0.0;    // m
    double high_x = 0.0, high_y = 0.0;  // m
    double side = 0.0;                  // m
    int columns = 1, rows = 1;

    [[nodiscard]] int column(double x) const;
    [[nodiscard]] int row(double y) const;
  };

  void collect(const TetMesh& mesh, double z);
  void sort_into_bins(const TetMesh& mesh);

  std::vector<int> nodes_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Shape> shapes_;
  double area_ = 0.0;
  Bins bins_;
  std::vector<int> bin_starts_;
  std::vector<int> bin_triangles_;
};

}  // namespace palpate::geometry
