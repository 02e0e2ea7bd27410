// The ring of surface around a patch where `consistent` coupling reads the mesh.
#pragma once

#include <span>
#include <vector>

#include "contact/patch.h"

namespace palpate::contact {

// What the surface's displacements say about a patch: sum of weights[i] * displacement of
// vertices[i], along the normal.
struct Reading {
  std::vector<int> vertices;
  std::vector<double> weights;
};

// What of a surface the ring needs, found once.
class RingReader {
 public:
  explicit RingReader(const geometry::SmoothSurface& surface);

  // The ring that carries the sinking of the surface around a patch to its centre: weighted least
  // squares of c0 + c1 r^2 over the vertices that face as the patch does; the reading is c0.
  // `shares`: the greatest share of any patch's load that each vertex carries (one a vertex of the
  // surface); a vertex that carries a hundredth is not read. The ring stands a spacing beyond the
  // patch, or `away` (m) where that is more.                             docs/theory.md (13)
  void read(const Patch& patch, std::span<const double> shares, double away, Reading& reading);

  // From now on reading allocates nothing but what it grows of `reading`.
  void make_room() { around_.reserve(surface_->surface().vertices.size()); }

  // The edge of a typical triangle in the patch's part of the surface, m: that of the equilateral
  // triangle of the mean area between creases.
  [[nodiscard]] double spacing(const Patch& patch) const;

  // 1 / (pi E' |x - y|), the sinking of a half-space at a vertex per newton on another, m/N, at
  // least a quarter of the spacing apart.                                docs/theory.md (11)
  [[nodiscard]] double half_space(int vertex, int pressed, double plane_modulus,
                                  double spacing) const;

 private:
  struct Around {
    int vertex = 0;
    double r = 0.0;       // m, from the patch's centre
    double facing = 0.0;  // cosine
    double weight = 0.0;
  };
  void look_around(const Patch& patch, double reach);
  void weigh(double radius, double spacing, std::span<const double> shares);

  const geometry::SmoothSurface* surface_;
  std::vector<std::vector<Vec3>> normals_;  // of every vertex, one a side of its creases
  std::vector<int> part_;                   // of every triangle
  std::vector<double> spacing_;             // of every part, m
  std::vector<Around> around_;    // vertices within `reach_` that face as the last patch did
  double reach_ = 0.0;            // m
  double best_ = 0.0;             // the greatest weight among them
  Vec3 position_ = Vec3::Zero();  // of that patch, m
  Vec3 normal_ = Vec3::Zero();
};

}  // namespace palpate::contact
