// The ring of surface around a patch in which `consistent` coupling averages displacements.
#pragma once

#include <span>
#include <vector>

#include "contact/patch.h"

namespace palpate::contact {

// A displacement average: the sum of weights[i] times the normal displacement of vertices[i].
struct Reading {
  std::vector<int> vertices;
  std::vector<double> weights;
};

// Computes the weights of rings on one surface.
class RingReader {
 public:
  explicit RingReader(const geometry::SmoothSurface& surface);

  // Computes the weights of the ring of a patch: a weighted least-squares fit c0 + c1 r^2 to the
  // displacements of the vertices that face the same way as the patch; the reading is c0. `shares`
  // contains for each vertex of the surface its largest share of the load of any patch; vertices
  // with a share of a hundredth or more are excluded. The ring is one spacing beyond the patch, or
  // `away` (m) if that is more. docs/theory.md (13)
  void read(const Patch& patch, std::span<const double> shares, double away, Reading& reading);

  // After this, read() allocates memory only for `reading`.
  void make_room() { around_.reserve(surface_->surface().vertices.size()); }

  // The typical edge length (m) of the triangles of the patch's part of the surface, which ends at
  // creases: that of an equilateral triangle of the mean area.
  [[nodiscard]] double spacing(const Patch& patch) const;

  // 1 / (pi E' |x - y|), m/N: the sinking of a half-space at one vertex per newton on another, at
  // least a quarter of the spacing apart. docs/theory.md (11)
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
  std::vector<std::vector<Vec3>> normals_;  // per vertex, one for each side of its creases
  std::vector<int> part_;                   // per triangle: its part of the surface
  std::vector<double> spacing_;             // per part, m
  std::vector<Around> around_;  // vertices within `reach_` that face the same way as the last patch
  double reach_ = 0.0;          // m
  double best_ = 0.0;           // the largest of their weights
  Vec3 position_ = Vec3::Zero();  // of that patch, m
  Vec3 normal_ = Vec3::Zero();
};

}  // namespace palpate::contact
