// Least squares over the ring, with weights that let no vertex enter or leave with a jump.
#include "contact/ring.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpate::contact {
namespace {

// How much a vertex is believed: most at one spacing beyond the patch, half at a half and at one
// and a half, next to nothing far off. Smooth, so that no vertex enters or leaves with a jump, and
// never zero, so that a coarse mesh reads the nearest vertices it has.
double ring_weight(double beyond_patch, double spacing) {
  const double x = (beyond_patch - spacing) / (0.5 * spacing);
  const double quarter = 1.0 + 0.1892071150027210667 * x * x;  // (1/2)^(1/4) at x = 1
  return 1.0 / (quarter * quarter * quarter * quarter);
}

constexpr double dropped = 0.02;  // of the best weight: vertices of less are not read

// A vertex that carries load itself sinks as the mesh likes: it is read less, the more it carries.
double unloaded(double share) {
  constexpr double full = 0.01;  // of the force; from here on the vertex is not read at all
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
      auto& known = normals_[static_cast<std::size_t>(triangles[t][i])];
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
        if (part_[static_cast<std::size_t>(next)] >= 0) continue;
        part_[static_cast<std::size_t>(next)] = part;
        found.push_back(next);
      }
    }
    // l = sqrt(4 A / sqrt(3))
    spacing_.push_back(
        std::sqrt(4.0 * area / (std::sqrt(3.0) * static_cast<double>(found.size()))));
  }
}

double RingReader::spacing(const Patch& patch) const {
  const auto of = [&](int triangle) {
    return spacing_[static_cast<std::size_t>(part_[static_cast<std::size_t>(triangle)])];
  };
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
    one.weight = one.facing * ring_weight(one.r - radius, spacing) *
                 unloaded(shares[static_cast<std::size_t>(one.vertex)]);
    best_ = std::max(best_, one.weight);
  }
}

void RingReader::read(const Patch& patch, std::span<const double> shares, double away,
                      Reading& reading) {
  const double spacing = std::max(this->spacing(patch), away);
  const double radius = patch.radius();
  // All that can count beside the best of the near ones; of a coarse mesh, all there are. Looked
  // for with some room, so that a growing patch need not look again.
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
  // What is dropped is taken off all the others, so that dropping makes no jump.
  for (Around& one : around_) {
    one.weight = one.weight / best_ - dropped;
    if (one.weight <= 0.0) continue;
    const double r2 = one.r * one.r;
    s0 += one.weight;
    s1 += one.weight * r2;
    s2 += one.weight * r2 * r2;
  }
  // Where all vertices stand at one distance the slope cannot be told: a small ridge keeps it at 0.
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
  const double r =
      (vertices[static_cast<std::size_t>(vertex)] - vertices[static_cast<std::size_t>(pressed)])
          .norm();
  // A vertex reads its own small share as if it were spread over a disk of half a spacing.
  return 1.0 / (std::numbers::pi * plane_modulus * std::max(r, 0.25 * spacing));
}

}  // namespace palpate::contact
