// Least squares over the ring, with weights that let no vertex enter or leave with a jump.
#include "contact/ring.h"

#include <algorithm>
#include <cmath>
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

void RingReader::read(const Patch& patch, std::span<const double> shares, double away,
                      Reading& reading) const {
  const double spacing = std::max(this->spacing(patch), away);
  const double radius = patch.radius();
  const auto& vertices = surface_->surface().vertices;
  struct Candidate {
    int vertex;
    double r2, weight;
  };
  std::vector<Candidate> ring;
  double best = 0.0;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    double facing = 0.0;
    for (const Vec3& normal : normals_[v]) facing = std::max(facing, normal.dot(patch.normal));
    if (facing <= 0.0) continue;
    const double r = (vertices[v] - patch.position).norm();
    const double weight = facing * ring_weight(r - radius, spacing) * unloaded(shares[v]);
    if (weight <= 0.0) continue;
    ring.push_back({static_cast<int>(v), r * r, weight});
    best = std::max(best, weight);
  }
  // Far vertices are dropped below a fiftieth of the best weight, which is taken off all the
  // others so that dropping makes no jump.
  double s0 = 0.0;
  double s1 = 0.0;
  double s2 = 0.0;
  std::vector<Candidate> kept;
  for (Candidate candidate : ring) {
    candidate.weight = candidate.weight / best - 0.02;
    if (candidate.weight <= 0.0) continue;
    s0 += candidate.weight;
    s1 += candidate.weight * candidate.r2;
    s2 += candidate.weight * candidate.r2 * candidate.r2;
    kept.push_back(candidate);
  }
  reading.vertices.clear();
  reading.weights.clear();
  if (kept.empty()) return;
  // Where all vertices stand at one distance the slope cannot be told: a small ridge keeps it at 0.
  const double mean_r2 = s1 / s0;
  const double ridge = 1e-3 * s0 * mean_r2 * mean_r2;
  const double determinant = s0 * (s2 + ridge) - s1 * s1;
  for (const Candidate& candidate : kept) {
    reading.vertices.push_back(candidate.vertex);
    reading.weights.push_back(candidate.weight * ((s2 + ridge) - s1 * candidate.r2) / determinant);
  }
}

double RingReader::half_space(int vertex, const Spread& load, double plane_modulus,
                              double spacing) const {
  const auto& vertices = surface_->surface().vertices;
  double sum = 0.0;
  for (std::size_t j = 0; j < load.vertices.size(); ++j) {
    const double r = (vertices[static_cast<std::size_t>(vertex)] -
                      vertices[static_cast<std::size_t>(load.vertices[j])])
                         .norm();
    // A vertex reads its own small share as if it were spread over a disk of half a spacing.
    sum += load.shares[j] / std::max(r, 0.25 * spacing);
  }
  return sum / (std::numbers::pi * plane_modulus);
}

}  // namespace palpate::contact
