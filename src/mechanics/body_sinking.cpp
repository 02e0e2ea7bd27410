// Interpolation over radii and places.
#include "mechanics/body_sinking.h"

#include <algorithm>
#include <cmath>

#include "scene/first_touch.h"

namespace palpate::mechanics {
namespace {

// An energy-optimal contact on a thin layer is at most sqrt(2) times as wide as Hertz's.
constexpr double widest = 1.4;
constexpr double stated = 1e-9;  // weights below it count as none

}  // namespace

BodySinking::BodySinking(const scene::Scene& scene, const tissue::Part& part,
                         std::span<const char> held, const Cholesky& factors, double deepest)
    : surface_(&*scene.specimen->surface),
      coupling_(scene, part, held, factors),
      deepest_(deepest),
      first_(scene::first_touch(scene).at) {}

BodySinking::Place BodySinking::evaluate(const contact::Patch& like, double radius_per_root) {
  Place place;
  place.largest = widest * radius_per_root * std::sqrt(deepest_);
  contact::Patch patch = like;
  const double slender = like.b > 0.0 ? std::sqrt(like.a / like.b) : 1.0;
  for (std::size_t k = 0; k < radii; ++k) {
    const double radius = steps[k] * place.largest;
    patch.a = radius * slender;
    patch.b = radius / slender;
    BeyondHalfSpace beyond = coupling_.beyond(patch);
    place.sinking[k] = beyond.sinking + beyond.error;
    place.error[k] = beyond.error;
    if (k == 2) place.rest = std::move(beyond.rest);
  }
  return place;
}

const BodySinking::Place& BodySinking::at_vertex(const contact::Patch& patch, std::size_t corner,
                                                 double radius_per_root) {
  const int triangle = patch.at.triangle;
  const int vertex = surface_->surface().triangles[as_index(triangle)][corner];
  const Vec3& normal = surface_->corner_normal(triangle, corner);
  auto& sides = at_vertices_[vertex];
  for (const auto& [side, place] : sides)
    if (side == normal) return place;
  contact::Patch here = patch;
  here.at.weights = Vec3::Unit(static_cast<Eigen::Index>(corner));
  here.position = surface_->surface().vertices[as_index(vertex)];
  here.normal = normal;
  const Vec3 axis = patch.axis - patch.axis.dot(normal) * normal;
  here.axis = axis.norm() > 1e-6 ? Vec3(axis.normalized()) : normal.unitOrthogonal();
  return sides.emplace_back(normal, evaluate(here, radius_per_root)).second;
}

// Fills shares_: linear weights of the corners or, in the triangle of the first touch, of that
// place and two corners.
void BodySinking::spread(const contact::Patch& patch, double radius_per_root) {
  shares_.fill({});
  std::array<double, 3> weights{patch.at.weights[0], patch.at.weights[1], patch.at.weights[2]};
  if (patch.at.triangle == first_.triangle) {
    // The largest multiple of the first touch's weights that leaves no weight negative.
    double part = 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double own = first_.weights[static_cast<Eigen::Index>(k)];
      if (own > stated) part = std::min(part, weights[k] / own);
    }
    for (std::size_t k = 0; k < 3; ++k)
      weights[k] -= part * first_.weights[static_cast<Eigen::Index>(k)];
    if (part > stated) {
      if (!at_first_) {
        contact::Patch here = patch;
        here.at = first_;
        here.position = surface_->position(first_);
        here.normal = surface_->normal(first_);
        const Vec3 axis = patch.axis - patch.axis.dot(here.normal) * here.normal;
        here.axis = axis.norm() > 1e-6 ? Vec3(axis.normalized()) : here.normal.unitOrthogonal();
        at_first_ = evaluate(here, radius_per_root);
      }
      shares_[3] = {&*at_first_, part};
    }
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (weights[k] > stated) shares_[k] = {&at_vertex(patch, k, radius_per_root), weights[k]};
}

BodySinking::Value BodySinking::at(const contact::Patch& patch, double radius_per_root) {
  spread(patch, radius_per_root);
  Value value;
  for (const auto& [place, weight] : shares_) {
    if (place == nullptr) continue;
    const double x = std::min(patch.radius() / place->largest, steps.back());
    for (std::size_t k = 0; k < radii; ++k) {
      // Lagrange's polynomial of the k-th radius, and its derivative.
      double product = 1.0;
      double slope = 0.0;
      for (std::size_t j = 0; j < radii; ++j) {
        if (j == k) continue;
        const double gap = steps[k] - steps[j];
        slope = (slope * (x - steps[j]) + product) / gap;
        product *= (x - steps[j]) / gap;
      }
      value.sinking += weight * product * place->sinking[k];
      value.slope += weight * slope / place->largest * place->sinking[k];
      value.error += weight * product * place->error[k];
    }
  }
  return value;
}

double BodySinking::rest(const Vec3& normal, const contact::Spread& read,
                         std::span<const int> nodes, const contact::Patch& pressed,
                         double radius_per_root) {
  spread(pressed, radius_per_root);
  double sum = 0.0;
  for (const auto& [place, weight] : shares_) {
    if (place == nullptr) continue;
    for (std::size_t k = 0; k < read.vertices.size(); ++k)
      if (const int node = nodes[as_index(read.vertices[k])]; node >= 0)
        sum -= weight * read.shares[k] * normal.dot(place->rest.segment<3>(3 * node));
  }
  return sum;
}

void BodySinking::make_ready(double reach, double radius_per_root) {
  const Vec3 middle = surface_->position(first_);
  const auto& triangles = surface_->surface().triangles;
  contact::Patch patch;
  patch.at = first_;
  patch.position = middle;
  patch.normal = surface_->normal(first_);
  patch.axis = patch.normal.unitOrthogonal();
  spread(patch, radius_per_root);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      patch.at.triangle = static_cast<int>(t);
      patch.axis = surface_->corner_normal(patch.at.triangle, k).unitOrthogonal();
      const Vec3& vertex = surface_->surface().vertices[as_index(triangles[t][k])];
      if ((vertex - middle).norm() <= reach &&
          surface_->corner_normal(patch.at.triangle, k).z() > 0.2)
        (void)at_vertex(patch, k, radius_per_root);
    }
}

}  // namespace palpate::mechanics
