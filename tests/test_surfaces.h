// Irregular triangulations of surfaces whose curvature is known: sphere, cylinder, torus, saddle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "geometry/surface.h"

namespace palpate::test {

// Numbers in [0, 1) that are the same on every machine (Knuth's MMIX generator).
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  double roll() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

struct Known {
  geometry::Surface surface;
  // Of the smooth surface at a vertex, 1/m: the larger one first, convex positive.
  std::function<std::array<double, 2>(const Vec3&)> kappas;
  std::function<Vec3(const Vec3&)> normal;
};

// The mean length of all edges, m.
inline double mean_edge(const geometry::Surface& surface) {
  double sum = 0.0;
  int count = 0;
  for (const auto& triangle : surface.triangles)
    for (std::size_t i = 0; i < 3; ++i, ++count)
      sum += (surface.vertices[static_cast<std::size_t>(triangle[(i + 1) % 3])] -
              surface.vertices[static_cast<std::size_t>(triangle[i])])
                 .norm();
  return sum / count;
}

struct Grid {
  std::array<int, 2> cells{};
  std::array<bool, 2> wraps{};   // does the last row of cells end at the first row of vertices?
  double jitter = 0.25;          // vertices move by up to so many cells in both directions
  bool random_diagonals = true;  // else every cell is cut along the same diagonal
  std::uint64_t seed = 1;
};

// Split quads; `place` takes parameters in [0, 1] and runs counter-clockwise from outside. Vertices
// on an open rim stay where they are.
template <class Place>
geometry::Surface split_quads(const Grid& grid, const Place& place) {
  Dice dice(grid.seed);
  const auto [columns, rows] = grid.cells;
  const int wide = columns + (grid.wraps[0] ? 0 : 1);
  const int high = rows + (grid.wraps[1] ? 0 : 1);
  const auto moved = [&](int index, int direction) {
    const auto d = static_cast<std::size_t>(direction);
    const double shift = grid.jitter * (2.0 * dice.roll() - 1.0);
    const bool rim = !grid.wraps[d] && (index == 0 || index == grid.cells[d]);
    return (index + (rim ? 0.0 : shift)) / grid.cells[d];
  };
  geometry::Surface surface;
  for (int j = 0; j < high; ++j)
    for (int i = 0; i < wide; ++i) {
      const double u = moved(i, 0);
      const double v = moved(j, 1);
      surface.vertices.push_back(place(u, v));
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto at = [&](int di, int dj) { return (i + di) % wide + (j + dj) % high * wide; };
      if (!grid.random_diagonals || dice.roll() < 0.5) {
        surface.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
        surface.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
      } else {
        surface.triangles.push_back({at(0, 0), at(1, 0), at(0, 1)});
        surface.triangles.push_back({at(1, 0), at(1, 1), at(0, 1)});
      }
    }
  return surface;
}

// The icosahedron's faces cut into frequency^2 triangles each, on the unit sphere; vertices are
// shaken by up to `jitter` edges. Edges are about 1.1 / frequency long.
inline Known sphere(int frequency, double jitter, double radius = 1.0, std::uint64_t seed = 1) {
  const double g = std::numbers::phi;
  const std::array<Vec3, 12> tops{{{-1, g, 0},
                                   {1, g, 0},
                                   {-1, -g, 0},
                                   {1, -g, 0},
                                   {0, -1, g},
                                   {0, 1, g},
                                   {0, -1, -g},
                                   {0, 1, -g},
                                   {g, 0, -1},
                                   {g, 0, 1},
                                   {-g, 0, -1},
                                   {-g, 0, 1}}};
  constexpr int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  geometry::Surface surface;
  // A vertex is known by the tops that it mixes and their shares.
  std::map<std::vector<std::pair<int, int>>, int> known;
  const auto vertex = [&](const int(&face)[3], std::array<int, 3> shares) {
    std::vector<std::pair<int, int>> mix;
    Vec3 position = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      if (shares[i] == 0) continue;
      mix.emplace_back(face[i], shares[i]);
      position += shares[i] * tops[static_cast<std::size_t>(face[i])];
    }
    std::sort(mix.begin(), mix.end());
    const auto [place, is_new] = known.emplace(mix, static_cast<int>(surface.vertices.size()));
    if (is_new) surface.vertices.push_back(position.normalized());
    return place->second;
  };
  for (const auto& face : faces)
    for (int i = 0; i < frequency; ++i)
      for (int j = 0; i + j < frequency; ++j) {
        const int k = frequency - i - j;
        const int a = vertex(face, {k, i, j});
        const int b = vertex(face, {k - 1, i + 1, j});
        const int c = vertex(face, {k - 1, i, j + 1});
        surface.triangles.push_back({a, b, c});
        if (k > 1) surface.triangles.push_back({b, vertex(face, {k - 2, i + 1, j + 1}), c});
      }
  Dice dice(seed);
  for (Vec3& position : surface.vertices) {
    Vec3 shake;
    for (int i = 0; i < 3; ++i) shake[i] = 2.0 * dice.roll() - 1.0;
    position = radius * (position + jitter * 1.1 / frequency * shake).normalized();
  }
  return {surface,
          [radius](const Vec3&) {
            return std::array{1.0 / radius, 1.0 / radius};
          },
          [](const Vec3& x) -> Vec3 { return x.normalized(); }};
}

// A tube about the z axis, open at both ends, four radii long.
inline Known cylinder(double cell, double radius = 1.0, Grid grid = {}) {
  const double around = 2.0 * std::numbers::pi;
  grid.cells = {static_cast<int>(std::lround(around * radius / cell)),
                static_cast<int>(std::lround(4.0 * radius / cell))};
  grid.wraps = {true, false};
  return {
      split_quads(
          grid,
          [&](double u, double v) -> Vec3 {
            return {radius * std::cos(around * u), radius * std::sin(around * u), 4.0 * radius * v};
          }),
      [radius](const Vec3&) {
        return std::array{1.0 / radius, 0.0};
      },
      [](const Vec3& x) -> Vec3 { return Vec3(x.x(), x.y(), 0.0).normalized(); }};
}

// A regular patch of split quads on a unit cylinder, its rows `angle` (rad) off the hoop direction.
struct Patch {
  geometry::Surface surface;
  int middle = 0;  // a vertex with four cells to every rim
};
inline Patch rotated_patch(double cell, double angle) {
  const Grid grid{
      .cells = {8, 8}, .wraps = {false, false}, .jitter = 0.0, .random_diagonals = false};
  const auto place = [&](double u, double v) -> Vec3 {
    const double along = 8.0 * cell * (u - 0.5);
    const double across = 8.0 * cell * (v - 0.5);
    const double hoop = std::cos(angle) * along - std::sin(angle) * across;
    const double z = std::sin(angle) * along + std::cos(angle) * across;
    return {std::cos(hoop), std::sin(hoop), z};
  };
  return {.surface = split_quads(grid, place), .middle = 40};
}

// Tube of radius 1 about a circle of radius `ring` around the z axis.
inline Known torus(double cell, double ring = 3.0, Grid grid = {}) {
  const double around = 2.0 * std::numbers::pi;
  grid.cells = {static_cast<int>(std::lround(around * ring / cell)),
                static_cast<int>(std::lround(around / cell))};
  grid.wraps = {true, true};
  return {split_quads(grid,
                      [&](double u, double v) -> Vec3 {
                        const double distance = ring + std::cos(around * v);
                        return {distance * std::cos(around * u), distance * std::sin(around * u),
                                std::sin(around * v)};
                      }),
          [ring](const Vec3& x) {
            const double distance = std::hypot(x.x(), x.y());
            return std::array{1.0, (distance - ring) / distance};
          },
          [ring](const Vec3& x) -> Vec3 {
            const double share = 1.0 - ring / std::hypot(x.x(), x.y());
            return {share * x.x(), share * x.y(), x.z()};
          }};
}

// z = (x^2 - y^2) / 2 over |x|, |y| <= 1, outside upwards: curvatures -1 and 1 in the middle.
inline Known saddle(double cell, Grid grid = {}) {
  const int cells = static_cast<int>(std::lround(2.0 / cell));
  grid.cells = {cells, cells};
  grid.wraps = {false, false};
  return {split_quads(grid,
                      [&](double u, double v) -> Vec3 {
                        const double x = 2.0 * u - 1.0;
                        const double y = 2.0 * v - 1.0;
                        return {x, y, 0.5 * (x * x - y * y)};
                      }),
          [](const Vec3& p) {
            // H and K of a graph; upwards is outside, so that a valley is concave.
            const double x = p.x() * p.x();
            const double y = p.y() * p.y();
            const double w = 1.0 + x + y;
            const double mean = -0.5 * ((1.0 + y) - (1.0 + x)) / (w * std::sqrt(w));
            const double root = std::sqrt(mean * mean + 1.0 / (w * w));
            return std::array{mean + root, mean - root};
          },
          [](const Vec3& p) -> Vec3 { return Vec3(-p.x(), p.y(), 1.0).normalized(); }};
}

}  // namespace palpate::test
