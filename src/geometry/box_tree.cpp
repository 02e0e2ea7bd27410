// Builds and searches the tree: boxes are split at the median of their longest side.
#include "geometry/box_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace palpate::geometry {
namespace {

constexpr int most_in_leaf = 4;

double box_distance_squared(const Vec3& point, const Vec3& low, const Vec3& high) {
  return (low - point).cwiseMax(point - high).cwiseMax(0.0).squaredNorm();
}

}  // namespace

Vec3 nearest_weights(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = point - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {1.0, 0.0, 0.0};
  const Vec3 bp = point - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {0.0, 1.0, 0.0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double v = d1 / (d1 - d3);
    return {1.0 - v, v, 0.0};
  }
  const Vec3 cp = point - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {0.0, 0.0, 1.0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double w = d2 / (d2 - d6);
    return {1.0 - w, 0.0, w};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0.0, 1.0 - w, w};
  }
  const double sum = va + vb + vc;
  const double v = vb / sum;
  const double w = vc / sum;
  return {1.0 - v - w, v, w};
}

BoxTree::BoxTree(const Surface& surface)
    : vertices_(surface.vertices), triangles_(surface.triangles), order_(triangles_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vec3> centres;
  for (const auto& [a, b, c] : triangles_)
    centres.push_back((vertices_[as_index(a)] + vertices_[as_index(b)] + vertices_[as_index(c)]) /
                      3.0);
  boxes_.emplace_back();
  split(0, 0, static_cast<int>(order_.size()), centres);
  refit(surface.vertices);
}

void BoxTree::split(int box, int first, int count, const std::vector<Vec3>& centres) {
  const auto at = [&](int i) -> const Vec3& { return centres[as_index(i)]; };
  boxes_[as_index(box)].first = first;
  boxes_[as_index(box)].count = count;
  if (count <= most_in_leaf) return;
  const auto begin = order_.begin() + first;
  Vec3 low = at(*begin);
  Vec3 high = low;
  for (auto i = begin; i != begin + count; ++i) {
    low = low.cwiseMin(at(*i));
    high = high.cwiseMax(at(*i));
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const int half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
    return at(a)[axis] != at(b)[axis] ? at(a)[axis] < at(b)[axis] : a < b;
  });
  const int left = static_cast<int>(boxes_.size());
  boxes_[as_index(box)].first = left;
  boxes_[as_index(box)].count = 0;
  boxes_.resize(boxes_.size() + 2);
  split(left, first, half, centres);
  split(left + 1, first + half, count - half, centres);
}

void BoxTree::fit(Box& box) const {
  if (box.count == 0) {
    const Box& left = boxes_[as_index(box.first)];
    const Box& right = boxes_[as_index(box.first) + 1];
    box.low = left.low.cwiseMin(right.low);
    box.high = left.high.cwiseMax(right.high);
    return;
  }
  constexpr double most = std::numeric_limits<double>::infinity();
  box.low = Vec3::Constant(most);
  box.high = Vec3::Constant(-most);
  for (int i = 0; i < box.count; ++i)
    for (const int v : triangles_[as_index(order_[as_index(box.first + i)])]) {
      box.low = box.low.cwiseMin(vertices_[as_index(v)]);
      box.high = box.high.cwiseMax(vertices_[as_index(v)]);
    }
}

void BoxTree::refit(std::span<const Vec3> vertices) {
  vertices_.assign(vertices.begin(), vertices.end());
  for (std::size_t b = boxes_.size(); b-- > 0;) fit(boxes_[b]);
}

Near BoxTree::near(const Vec3& point, int triangle) const {
  const auto& [i, j, k] = triangles_[as_index(triangle)];
  const Vec3& a = vertices_[as_index(i)];
  const Vec3& b = vertices_[as_index(j)];
  const Vec3& c = vertices_[as_index(k)];
  Near near{
      .distance_squared = 0.0, .triangle = triangle, .weights = nearest_weights(point, a, b, c)};
  near.distance_squared =
      (near.weights[0] * a + near.weights[1] * b + near.weights[2] * c - point).squaredNorm();
  return near;
}

void BoxTree::within(const Vec3& point, double radius, std::vector<Near>& found) const {
  found.clear();
  const double most = radius * radius;
  std::array<int, 64> stack;  // the tree is balanced: its depth is below 32
  int waiting = 0;
  stack[0] = 0;
  for (int next = 0; next >= 0; next = waiting > 0 ? stack[as_index(--waiting)] : -1) {
    const Box& box = boxes_[as_index(next)];
    if (box_distance_squared(point, box.low, box.high) > most) continue;
    if (box.count == 0) {
      stack[as_index(waiting++)] = box.first + 1;
      stack[as_index(waiting++)] = box.first;
      continue;
    }
    for (int i = 0; i < box.count; ++i) {
      const Near one = near(point, order_[as_index(box.first + i)]);
      if (one.distance_squared <= most) found.push_back(one);
    }
  }
  std::ranges::sort(found, {}, &Near::triangle);
}

Near BoxTree::nearest(const Vec3& point) const {
  Near best{.distance_squared = std::numeric_limits<double>::infinity()};
  std::array<int, 64> stack;
  int waiting = 0;
  for (int next = 0; next >= 0; next = waiting > 0 ? stack[as_index(--waiting)] : -1) {
    const Box& box = boxes_[as_index(next)];
    if (box_distance_squared(point, box.low, box.high) > best.distance_squared) continue;
    if (box.count == 0) {
      const auto far = [&](int child) {
        const Box& one = boxes_[as_index(child)];
        return box_distance_squared(point, one.low, one.high);
      };
      const bool left_first = far(box.first) <= far(box.first + 1);
      stack[as_index(waiting++)] = box.first + (left_first ? 1 : 0);
      stack[as_index(waiting++)] = box.first + (left_first ? 0 : 1);
      continue;
    }
    for (int i = 0; i < box.count; ++i) {
      const Near one = near(point, order_[as_index(box.first + i)]);
      if (one.distance_squared < best.distance_squared ||
          (one.distance_squared == best.distance_squared && one.triangle < best.triangle))
        best = one;
    }
  }
  return best;
}

double BoxTree::first_along(const Vec3& point, const Vec3& direction, double least) const {
  double best = std::numeric_limits<double>::infinity();
  std::array<int, 64> stack;
  int waiting = 0;
  for (int next = 0; next >= 0; next = waiting > 0 ? stack[as_index(--waiting)] : -1) {
    const Box& box = boxes_[as_index(next)];
    double enters = least;
    double leaves = best;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double low = box.low[axis] - point[axis];
      const double high = box.high[axis] - point[axis];
      if (direction[axis] == 0.0) {
        if (low > 0.0 || high < 0.0) leaves = -1.0;
        continue;
      }
      const double to_low = low / direction[axis];
      const double to_high = high / direction[axis];
      enters = std::max(enters, std::min(to_low, to_high));
      leaves = std::min(leaves, std::max(to_low, to_high));
    }
    if (enters > leaves) continue;
    if (box.count == 0) {
      stack[as_index(waiting++)] = box.first + 1;
      stack[as_index(waiting++)] = box.first;
      continue;
    }
    for (int i = 0; i < box.count; ++i) {
      const auto& [a, b, c] = triangles_[as_index(order_[as_index(box.first + i)])];
      const Vec3 first = vertices_[as_index(a)] - point;
      const Vec3 second = vertices_[as_index(b)] - point;
      const Vec3 third = vertices_[as_index(c)] - point;
      const std::array<double, 3> sides{direction.dot(second.cross(third)),
                                        direction.dot(third.cross(first)),
                                        direction.dot(first.cross(second))};
      const auto [low, high] = std::ranges::minmax_element(sides);
      if (*low < 0.0 && *high > 0.0) continue;  // the line passes beside it
      const double sum = sides[0] + sides[1] + sides[2];
      if (sum == 0.0) continue;  // or within its plane
      const double distance =
          direction.dot(sides[0] * first + sides[1] * second + sides[2] * third) / sum;
      if (distance > least) best = std::min(best, distance);
    }
  }
  return best;
}

}  // namespace palpate::geometry
