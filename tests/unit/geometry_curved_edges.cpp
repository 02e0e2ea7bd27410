// Parts of quadratic faces and cells lie on the quadratic surface of the whole.
#include "geometry/curved_edges.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::geometry {
namespace {

// A tetrahedron whose face opposite to the origin bulges; the other three faces are plane but for
// their outer edges.
const TetMesh corner{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}, {{0, 1, 2, 3}}};

EdgeMiddles on_ball() {
  EdgeMiddles middles;
  for (const auto& [a, b] : {std::array{1, 2}, {1, 3}, {2, 3}})
    middles[{a, b}] = (corner.nodes[as_index(a)] + corner.nodes[as_index(b)]).normalized();
  return middles;
}

// The quadratic face through the corners 1, 2 and 3 and the middles.
Vec3 face_at(double l1, double l2, double l3) {
  const EdgeMiddles m = on_ball();
  return l1 * (2.0 * l1 - 1.0) * corner.nodes[1] + l2 * (2.0 * l2 - 1.0) * corner.nodes[2] +
         l3 * (2.0 * l3 - 1.0) * corner.nodes[3] + 4.0 * l1 * l2 * m.at({1, 2}) +
         4.0 * l2 * l3 * m.at({2, 3}) + 4.0 * l3 * l1 * m.at({1, 3});
}

TEST(CurvedEdges, PartsOfAFaceLieOnIt) {
  CurvedEdges edges(corner.nodes, on_ball());
  const auto expect = [&](const Vec3& place, double l1, double l2, double l3) {
    EXPECT_LT((place - face_at(l1, l2, l3)).norm(), 1e-15);
  };
  expect(edges.split(1, 2), 0.5, 0.5, 0.0);     // 4
  expect(edges.middle(1, 4), 0.75, 0.25, 0.0);  // a half
  expect(edges.middle(4, 3), 0.25, 0.25, 0.5);  // across the face
  expect(edges.split(4, 3), 0.25, 0.25, 0.5);   // 5
  expect(edges.middle(5, 1), 0.625, 0.125, 0.25);
  expect(edges.middle(4, 5), 0.375, 0.375, 0.25);
  EXPECT_EQ(edges.middle(0, 1), Vec3(0.5, 0.0, 0.0));  // straight
}

TEST(CurvedEdges, TheBoundaryFollowsCurvedFaces) {
  const Surface straight = curved_boundary(corner, {});
  EXPECT_EQ(straight.triangles, outer_surface(corner).surface.triangles);
  const Surface curved = curved_boundary(corner, on_ball());
  // The halves of an edge meet at 45 degrees, its quarters at 23.
  EXPECT_EQ(curved.triangles.size(), 4U * 16U);
  // The volume under the quadratic face, by the integral of its triple product over a grid.
  double exact = 0.0;
  constexpr int grid = 200;
  constexpr double h = 1.0 / grid;
  for (int i = 0; i < grid; ++i)
    for (int j = 0; i + j < grid; ++j)
      for (const double part : {1.0, 2.0}) {  // the two triangles of a cell
        const double u = (i + part / 3.0) * h, v = (j + part / 3.0) * h;
        if (u + v >= 1.0) continue;
        const Vec3 along = face_at(u + 0.5 * h, v, 1 - u - 0.5 * h - v) -
                           face_at(u - 0.5 * h, v, 1 - u + 0.5 * h - v);
        const Vec3 across = face_at(u, v + 0.5 * h, 1 - u - v - 0.5 * h) -
                            face_at(u, v - 0.5 * h, 1 - u - v + 0.5 * h);
        exact += 0.5 * face_at(u, v, 1 - u - v).dot(along.cross(across)) / 3.0;
      }
  const double none = 1.0 / 6.0;  // of the straight tetrahedron
  EXPECT_GT(exact, 1.5 * none);
  // Triangles of a quarter of the edges leave a sixteenth of what lies between.
  EXPECT_NEAR((exact - enclosed(curved).volume) / (exact - none), 1.0 / 16.0, 0.01);
}

}  // namespace
}  // namespace palpate::geometry
