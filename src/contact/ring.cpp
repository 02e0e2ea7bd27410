// Least-squares fit over the ring, with weights that change smoothly.
#include "contact/ring.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpate::contact {
namespace {

// The weight of a vertex: largest at one spacing beyond the patch, half of that at 1/2 and 3/2
// spacings. It is smooth, so that readings do not jump, and never zero, so that on a coarse mesh
// the nearest vertices are used, however far away. docs/theory.md (13)
double ring_weight(double beyond_patch, double spacing) {
  const double x = (beyond_patch - spacing) / (0.5 * spacing);
  const double quarter = 1.0 + 0.1892071150027210667 * x * x;  // (1/2)^(1/4) at x = 1
  return 1.0 / (quarter * quarter * quarter * quarter);
}

constexpr double dropped = 0.02;  // of the largest weight: vertices with less are not used

// The displacement of a loaded vertex depends on the mesh, so its weight falls with its load.
double unloaded(double share) {
  constexpr double full = 0.01;  // of the force; from this share on the vertex is not used
  const double left = std::max(0.0, 1.0 - share / full);
  return left * left;
}

}  // namespace

RingReader::RingReader(const geometry::SmoothSurface& surface)
    : surface_(&surface),
      normals_(surface.surface().vertices.size()),
      part_(surface.surface().triangles.size(), -1) {
  const auto& triangles = surface.surface().triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      auto& known = normals_[as_index(triangles[t][i])];
      const Vec3& normal = surface.corner_normal(static_cast<int>(t), i);
      if (std::find(known.begin(), known.end(), normal) == known.end()) known.push_back(normal);
    }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (part_[t] >= 0) continue;
    const int part = static_cast<int>(spacing_.size());
    std::vector<int> found{static_cast<int>(t)};
    part_[t] = part;
    double area = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      area += 0.5 * twice_area(surface.surface(), found[i]).norm();
      for (std::size_t edge = 0; edge < 3; ++edge) {
        if (surface.crease(found[i], edge)) continue;
        const int next = surface.neighbours().across(found[i])[edge];
        if (part_[as_index(next)] >= 0) continue;
        part_[as_index(next)] = part;
        found.push_back(next);
      }
    }
    // l = sqrt(4 A / sqrt(3))
    spacing_.push_back(
        std::sqrt(4.0 * area / (std::sqrt(3.0) * static_cast<double>(found.size()))));
  }
}

double RingReader::spacing(const Patch& patch) const {
  const auto of = [&](int triangle) { return spacing_[as_index(part_[as_index(triangle)])]; };
  const double here = of(patch.at.triangle);
  return patch.turned > 0.0 ? here + patch.turned * (of(patch.beyond.triangle) - here) : here;
}

void RingReader::look_around(const Patch& patch, double reach) {
  if (patch.position == position_ && patch.normal == normal_ && reach <= reach_) return;
  position_ = patch.position;
  normal_ = patch.normal;
  reach_ = reach;
  around_.clear();
  const auto& vertices = surface_->surface().vertices;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const double r2 = (vertices[v] - patch.position).squaredNorm();
    if (r2 > reach * reach) continue;
    double facing = 0.0;
    for (const Vec3& normal : normals_[v]) facing = std::max(facing, normal.dot(patch.normal));
    if (facing > 0.0) around_.push_back({static_cast<int>(v), std::sqrt(r2), facing, 0.0});
  }
}

void RingReader::weigh(double radius, double spacing, std::span<const double> shares) {
  best_ = 0.0;
  for (Around& one : around_) {
    one.weight =
        one.facing * ring_weight(one.r - radius, spacing) * unloaded(shares[as_index(one.vertex)]);
    best_ = std::max(best_, one.weight);
  }
}

void RingReader::read(const Patch& patch, std::span<const double> shares, double away,
                      Reading& reading) {
  const double spacing = std::max(this->spacing(patch), away);
  const double radius = patch.radius();
  // Candidates are all vertices whose weight can reach `dropped` times the largest one; on a coarse
  // mesh all vertices. The factor 1.25 avoids new searches while a patch grows.
  constexpr double near = 4.0;  // spacings beyond the patch
  look_around(patch, 1.25 * radius + near * spacing);
  weigh(radius, spacing, shares);
  if (ring_weight(near * spacing, spacing) > dropped * best_) {
    look_around(patch, std::numeric_limits<double>::infinity());
    weigh(radius, spacing, shares);
  }
  double s0 = 0.0;
  double s1 = 0.0;
  double s2 = 0.0;
  reading.vertices.clear();
  reading.weights.clear();
  if (best_ <= 0.0) return;
  // The threshold is subtracted from all weights, so that no weight jumps when a vertex drops out.
  for (Around& one : around_) {
    one.weight = one.weight / best_ - dropped;
    if (one.weight <= 0.0) continue;
    const double r2 = one.r * one.r;
    s0 += one.weight;
    s1 += one.weight * r2;
    s2 += one.weight * r2 * r2;
  }
  // If all vertices have the same distance, the slope is undetermined; a small ridge keeps it at 0.
  const double mean_r2 = s1 / s0;
  const double ridge = 1e-3 * s0 * mean_r2 * mean_r2;
  const double determinant = s0 * (s2 + ridge) - s1 * s1;
  for (const Around& one : around_) {
    if (one.weight <= 0.0) continue;
    reading.vertices.push_back(one.vertex);
    reading.weights.push_back(one.weight * ((s2 + ridge) - s1 * one.r * one.r) / determinant);
  }
}

double RingReader::half_space(int vertex, int pressed, double plane_modulus, double spacing) const {
  const auto& vertices = surface_->surface().vertices;
  const double r = (vertices[as_index(vertex)] - vertices[as_index(pressed)]).norm();
  // The displacement of a vertex under its own small share is that of a disc half a spacing wide.
  return 1.0 / (std::numbers::pi * plane_modulus * std::max(r, 0.25 * spacing));
}

}  // namespace palpate::contact
