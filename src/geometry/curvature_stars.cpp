// Chooses the neighbours of every vertex: rings that stop at boundaries and creases.
#include <algorithm>
#include <cmath>

#include "geometry/curvature.h"

namespace palpate::geometry {
CurvatureStars::CurvatureStars(const Surface& rest, const Neighbours& neighbours,
                               const CurvatureOptions& options)
    : method_(options.method), corners_(rest.triangles.size(), {-1, -1, -1}) {
  part_at_creases(rest, neighbours, options.crease_angle);
  collect_stars(options.rings);
  for (std::size_t s = 0; s < vertex_.size(); ++s)
    cubic_.push_back(bears_cubic(rest, static_cast<int>(s)) ? 1 : 0);
}

void CurvatureStars::part_at_creases(const Surface& rest, const Neighbours& neighbours,
                                     double crease_angle) {
  const auto joined = [&](int triangle, int other) {
    return other >= 0 &&
           angle_between(twice_area(rest, triangle), twice_area(rest, other)) <= crease_angle;
  };
  std::vector<int> waiting;
  triangle_starts_.push_back(0);
  for (std::size_t v = 0; v < rest.vertices.size(); ++v) {
    const int vertex = static_cast<int>(v);
    side_starts_.push_back(static_cast<int>(vertex_.size()));
    for (const int start : neighbours.triangles_at(vertex)) {
      const auto corner = [&](int triangle) -> int& {
        const auto t = as_index(triangle);
        return corners_[t][corner_of(rest.triangles[t], vertex)];
      };
      if (corner(start) >= 0) continue;
      const int side = static_cast<int>(vertex_.size());
      vertex_.push_back(vertex);
      corner(start) = side;
      waiting.assign(1, start);
      for (std::size_t i = 0; i < waiting.size(); ++i) {
        const int triangle = waiting[i];
        const std::size_t at = corner_of(rest.triangles[as_index(triangle)], vertex);
        // The two edges of the triangle that meet at the vertex.
        for (const std::size_t edge : {at, (at + 2) % 3}) {
          const int other = neighbours.across(triangle)[edge];
          if (!joined(triangle, other) || corner(other) >= 0) continue;
          corner(other) = side;
          waiting.push_back(other);
        }
      }
      std::sort(waiting.begin(), waiting.end());
      triangles_.insert(triangles_.end(), waiting.begin(), waiting.end());
      triangle_starts_.push_back(static_cast<int>(triangles_.size()));
    }
  }
  side_starts_.push_back(static_cast<int>(vertex_.size()));
}

void CurvatureStars::collect_stars(int rings) {
  // A copy of the surface that is cut along its creases, which thereby become boundaries.
  Surface parted;
  parted.vertices.resize(vertex_.size());
  parted.triangles = corners_;
  const Neighbours neighbours(parted);
  std::vector<int> seen_from(vertex_.size(), -1);
  star_starts_.push_back(0);
  for (std::size_t s = 0; s < vertex_.size(); ++s) {
    const int side = static_cast<int>(s);
    const std::size_t start = stars_.size();
    seen_from[s] = side;
    bool cut = false;
    const auto look_around = [&](int from) {
      cut = cut || neighbours.on_boundary(from);
      for (const int next : neighbours.vertices_at(from)) {
        if (seen_from[as_index(next)] == side) continue;
        seen_from[as_index(next)] = side;
        stars_.push_back(next);
      }
    };
    look_around(side);
    std::size_t first = start;
    for (int ring = 1; ring < rings; ++ring) {
      const std::size_t last = stars_.size();
      for (; first < last; ++first) look_around(stars_[first]);
    }
    std::sort(stars_.begin() + static_cast<std::ptrdiff_t>(start), stars_.end());
    star_starts_.push_back(static_cast<int>(stars_.size()));
    cut_.push_back(cut ? 1 : 0);
  }
}

std::span<const int> CurvatureStars::triangles_of(int side) const {
  return list_of(triangle_starts_, triangles_, side);
}

std::span<const int> CurvatureStars::star_of(int side) const {
  return list_of(star_starts_, stars_, side);
}

double CurvatureStars::spread(const Surface& now, int side) const {
  double squares = 0.0;
  for (const int other : star_of(side))
    squares += (position(now, other) - position(now, side)).squaredNorm();
  return std::sqrt(squares / static_cast<double>(star_of(side).size()));
}

Vec3 CurvatureStars::normal(const Surface& now, int side) const {
  Vec3 sum = Vec3::Zero();
  for (const int triangle : triangles_of(side)) sum += twice_area(now, triangle);
  return sum;
}

}  // namespace palpate::geometry
