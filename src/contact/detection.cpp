// Finds candidate triangles in the tree of boxes, and one foot for every minimum of the distance.
#include "contact/detection.h"

#include <algorithm>

namespace palpate::contact {
namespace {

// The displacement of a surface point, m.
Vec3 displacement_at(const geometry::Surface& surface, const geometry::SurfacePoint& point,
                     std::span<const Vec3> displacement) {
  if (displacement.empty()) return Vec3::Zero();
  const auto& [a, b, c] = surface.triangles[as_index(point.triangle)];
  return point.weights[0] * displacement[as_index(a)] +
         point.weights[1] * displacement[as_index(b)] +
         point.weights[2] * displacement[as_index(c)];
}

}  // namespace

Detector::Detector(const geometry::SmoothSurface& surface)
    : surface_(&surface), tree_(surface.surface()), moved_(surface.surface().vertices) {}

void Detector::refit(std::span<const Vec3> displacement) {
  const auto& rest = surface_->surface().vertices;
  for (std::size_t v = 0; v < rest.size(); ++v) moved_[v] = rest[v] + displacement[v];
  tree_.refit(moved_);
}

bool Detector::nearest_around(const geometry::Near& near) const {
  const auto distance = [&](int triangle) {
    const auto found = std::ranges::lower_bound(near_, triangle, {}, &geometry::Near::triangle);
    return found != near_.end() && found->triangle == triangle ? &*found : nullptr;
  };
  for (const int corner : surface_->surface().triangles[as_index(near.triangle)])
    for (const int triangle : surface_->neighbours().triangles_at(corner)) {
      if (triangle == near.triangle) continue;
      const geometry::Near* other = distance(triangle);
      if (other == nullptr) continue;
      if (other->distance_squared < near.distance_squared ||
          (other->distance_squared == near.distance_squared && triangle < near.triangle))
        return false;
    }
  return true;
}

void Detector::find(const Vec3& centre, double radius, std::span<const Vec3> displacement,
                    std::vector<geometry::SmoothSurface::ClosestPoint>& feet) {
  feet.clear();
  tree_.within(centre, radius, near_);
  // A centre deeper inside than the radius has no triangle within the radius.
  if (near_.empty()) near_.push_back(tree_.nearest(centre));
  const auto first = std::ranges::min_element(
      near_, [](const auto& a, const auto& b) { return a.distance_squared < b.distance_squared; });
  for (const geometry::Near& near : near_) {
    if (!nearest_around(near)) continue;
    const Vec3 carried =
        centre - displacement_at(surface_->surface(), {near.triangle, near.weights}, displacement);
    const auto closest_point = surface_->closest_point(carried, near);
    if (closest_point.height >= radius) continue;
    // For a centre inside, only the nearest foot counts; for one outside, a foot on a face that is
    // turned away belongs to the far side of the tissue.
    if (closest_point.height < 0.0 && &near != &*first) continue;
    // If the surface has taken the shape of the sphere, one contact has many minima. Two minima are
    // the same contact if the search from the foot of one, with the centre of the other, ends at
    // the other's foot. Only the deepest is kept.
    const auto known = std::ranges::find_if(feet, [&](const auto& other) {
      const double same = 1e-6 * radius;
      if ((other.position - closest_point.position).norm() <= same) return true;
      if (displacement.empty()) return false;
      const auto led = surface_->closest_point(
          carried, {.triangle = other.at.triangle, .weights = other.at.weights});
      return (led.position - closest_point.position).norm() <= same;
    });
    if (known == feet.end())
      feet.push_back(closest_point);
    else if (closest_point.height < known->height)
      *known = closest_point;
  }
}

}  // namespace palpate::contact
