// Builds the fingertip from rings of vertices, from the tip to the base.
#include "geometry/fingertip.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace palpate::geometry {
namespace {

// mm, before scaling.
constexpr double half_breadth = 9.0;
constexpr double nail_height = 8.0;  // above the axis
constexpr double pad_depth = 7.0;    // below it
constexpr double whole_length = 26.0;
constexpr double tip_length = 10.0;  // the rounded part of the length

// A ring: `cosine` is 0 on the finger's body and 1 at the tip.
struct Ring {
  int count;
  double cosine;
  double x;  // mm
};

// Rings with an even count have vertices on the middle lines of nail and pad, so that the triangles
// between them are mirror-symmetric. With the base's 15 the number of triangles is odd:
// 2 (6 + 12 + 4 x 16) + 15 = 179.
std::array<Ring, 7> rings() {
  const double half_root_3 = std::sqrt(3.0) / 2.0;
  const double body = whole_length - tip_length;
  return {{{6, half_root_3, body + tip_length * half_root_3},  // 30 degrees off the axis
           {12, 0.5, body + tip_length * 0.5},                 // 60 degrees
           {16, 0.0, body},
           {16, 0.0, 0.75 * body},
           {16, 0.0, 0.5 * body},
           {16, 0.0, 0.25 * body},
           {15, 0.0, 0.0}}};
}

// The vertex of a ring at `angle` from the pad's middle line, counter-clockwise seen from the tip.
Vec3 on_ring(const Ring& ring, double angle) {
  // The outline from above and the nail side are ellipses. The pad side and the pad's middle line
  // are flatter: |y|^4 + |z|^4 = 1 and |x|^4 + |z|^4 = 1. docs/theory.md [fingertip]
  const double square = ring.cosine * ring.cosine;
  const double round = std::sqrt(1.0 - square);
  const double flat = std::sqrt(std::sqrt(1.0 - square * square));
  const double right = std::sin(angle);
  const double down = std::cos(angle);
  if (down <= 0.0) return {ring.x, half_breadth * round * right, -nail_height * round * down};
  const double reach = 1.0 / std::sqrt(std::hypot(right * right, down * down));
  return {ring.x, half_breadth * round * right * reach, -pad_depth * flat * down * reach};
}

// Triangles between a ring of `inner` vertices, starting at `inner_first`, and the next ring
// towards the base, from the pad's middle line upwards on one side and mirrored on the other.
void join(int inner_first, int inner, int outer_first, int outer, Surface& surface) {
  const auto add = [&](int a, int b, int c) { surface.triangles.push_back({a, b, c}); };
  const auto in = [&](int i) { return inner_first + (i + inner) % inner; };
  const auto out = [&](int i) { return outer_first + (i + outer) % outer; };
  int i = 0;
  int o = 0;
  while (i < inner / 2 || o < outer / 2) {
    // The next vertex with the smaller angle comes first; angles are 2 pi i / count.
    if (i < inner / 2 && (o == outer / 2 || (i + 1) * outer <= (o + 1) * inner)) {
      add(in(i), out(o), in(i + 1));
      add(in(-i), in(-i - 1), out(-o));
      ++i;
    } else {
      add(in(i), out(o), out(o + 1));
      add(in(-i), out(-o - 1), out(-o));
      ++o;
    }
  }
  if (outer % 2 != 0) add(in(i), out(o), out(o + 1));  // across the middle line of the nail
}

}  // namespace

Surface fingertip(double volume) {
  Surface surface;
  surface.vertices.emplace_back(whole_length, 0.0, 0.0);
  int inner_first = 0;
  int inner = 1;
  for (const Ring& ring : rings()) {
    const int first = static_cast<int>(surface.vertices.size());
    for (int i = 0; i < ring.count; ++i) {
      // The left half is the exact mirror image of the right half.
      const int right = i <= ring.count / 2 ? i : ring.count - i;
      Vec3 vertex = on_ring(ring, 2.0 * std::numbers::pi * right / ring.count);
      if (2 * right == ring.count) vertex.y() = 0.0;
      if (right != i) vertex.y() = -vertex.y();
      surface.vertices.push_back(vertex);
    }
    join(inner_first, inner, first, ring.count, surface);
    inner_first = first;
    inner = ring.count;
  }
  const double scale = std::cbrt(volume / enclosed(with_closed_base(surface)).volume);
  for (Vec3& vertex : surface.vertices) vertex *= scale;
  return surface;
}

Surface with_closed_base(const Surface& open) {
  const Neighbours neighbours(open);
  Surface closed = open;
  const int centre = static_cast<int>(open.vertices.size());
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t t = 0; t < open.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      if (neighbours.across(static_cast<int>(t))[i] >= 0) continue;
      const int from = open.triangles[t][i];
      const int to = open.triangles[t][(i + 1) % 3];
      closed.triangles.push_back({to, from, centre});
      sum += open.vertices[as_index(from)];
      ++count;
    }
  if (count > 0) closed.vertices.push_back(sum / count);
  return closed;
}

}  // namespace palpate::geometry
