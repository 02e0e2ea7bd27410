// Fine surfaces and surfaces with needles: what remeshing keeps, and the meshes of such surfaces.
#include "meshing/surface_remeshing.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "geometry/body.h"
#include "geometry/box_tree.h"
#include "geometry/cuboid.h"
#include "geometry/shapes.h"
#include "meshing/cgal_library.h"
#include "meshing/cgal_repair.h"
#include "meshing/surface_repair.h"
#include "meshing/tetgen_body.h"
#include "test_surfaces.h"
#include "tetgen_calls.h"

namespace palpate::meshing {
namespace {

using geometry::Surface;
using test::time_given;

Surface sampled(const geometry::Shape& shape, double spacing) {
  return geometry::sampled(shape, {spacing, spacing}).parts.front().surface;
}

double volume(const Surface& surface) { return geometry::enclosed(surface).volume; }

// Of an ellipsoid of the default size: the distance of a point from it, to first order, m.
double off_ellipsoid(const Vec3& point) {
  const Vec3 half = 0.5 * geometry::Ellipsoid{}.size;
  const Vec3 x = point - half;
  const double level = x.cwiseQuotient(half).norm() - 1.0;
  return std::abs(level) / x.cwiseQuotient(half.cwiseProduct(half)).norm();
}

// Narrow strips from end to end, as programs for drawing export a cylinder: axis along z, m.
Surface strips(int count, double radius, double length) {
  Surface surface;
  for (const double z : {0.0, length})
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / count;
      surface.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  surface.vertices.emplace_back(0.0, 0.0, 0.0);
  surface.vertices.emplace_back(0.0, 0.0, length);
  for (int i = 0; i < count; ++i) {
    const int j = (i + 1) % count;
    surface.triangles.push_back({i, j, j + count});
    surface.triangles.push_back({i, j + count, i + count});
    surface.triangles.push_back({j, i, 2 * count});
    surface.triangles.push_back({i + count, j + count, 2 * count + 1});
  }
  return surface;
}

// 40 mm long and 30 mm wide, with an edge of this angle.
Surface wedge(double degrees) {
  const double top = 0.04 * std::tan(degrees * std::numbers::pi / 180.0);
  return {
      {{0, 0, 0}, {0, 0.03, 0}, {0.04, 0, 0}, {0.04, 0.03, 0}, {0.04, 0, top}, {0.04, 0.03, top}},
      {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}, {2, 3, 5}, {2, 5, 4}, {0, 2, 4}, {1, 5, 3}}};
}

// A scan with noise of 0.7 mm.
Surface rough_ellipsoid() {
  Surface rough = sampled(geometry::Ellipsoid{{0.06, 0.05, 0.04}}, 0.8e-3);
  EXPECT_GT(rough.triangles.size(), 20000u);
  const Vec3 middle(0.03, 0.025, 0.02);
  for (std::size_t v = 0; v < rough.vertices.size(); ++v)
    rough.vertices[v] += 0.7e-3 * std::sin(1e3 * static_cast<double>(v * v % 1013)) *
                         (rough.vertices[v] - middle).normalized();
  return rough;
}

Surface coarser(const Surface& surface, double spacing, const Nearer& nearer) {
  const auto made = remeshed(surface, spacing, nearer);
  if (!made) {
    ADD_FAILURE() << "none was found";
    return surface;
  }
  check_closed(made->surface, "made");
  return made->surface;
}

long pages_of_children() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  return used.ru_minflt;
}

// A base is known by being flat.
TEST(FineSurface, KeepsItsFlatSidesFlat) {
  const Surface fine = sampled(geometry::Cylinder{.radius = 0.03, .length = 0.02}, 0.6e-3);
  const auto coarse = remeshed(fine, 6e-3);
  ASSERT_TRUE(coarse.has_value());
  double ends = 0.0;
  for (std::size_t t = 0; t < coarse->surface.triangles.size(); ++t) {
    const auto& corners = coarse->surface.triangles[t];
    const auto y = [&](std::size_t k) {
      return coarse->surface.vertices[as_index(corners[k])].y();
    };
    if (y(0) == y(1) && y(1) == y(2) && (y(0) == 0.0 || y(0) == 0.02))
      ends += 0.5 * geometry::twice_area(coarse->surface, static_cast<int>(t)).norm();
  }
  EXPECT_NEAR(ends / (2.0 * std::numbers::pi * 0.03 * 0.03), 1.0, 0.03);
}

// A large plate whose creases need several tries, all but the first from a finer surface of its
// own.
TEST(FineSurface, KeepsTheCreasesOfALargePlate) {
  Surface plate = geometry::box_surface({0.1, 0.1, 0.006}, {104, 104, 2});
  ASSERT_GT(plate.triangles.size(), 40000u);
  const auto folded = [](double along) { return 4.0 * std::abs(along - std::round(along)) - 1.0; };
  for (Vec3& vertex : plate.vertices)
    vertex.z() += 1e-3 * folded(vertex.x() / 0.0173 + vertex.y() / 0.1) +
                  0.7e-3 * folded(vertex.y() / 0.023 + vertex.x() / 0.06);
  constexpr double spacing = 13e-3;
  const auto coarse = remeshed(plate, spacing);
  ASSERT_TRUE(coarse.has_value());
  check_closed(coarse->surface, "coarse");
  EXPECT_LT(coarse->surface.triangles.size(), plate.triangles.size() / 10);
  EXPECT_NEAR(volume(coarse->surface) / volume(plate), 1.0, 0.005);
  EXPECT_LE(coarse->distance, remeshing_limit(plate, spacing));
  const geometry::BoxTree tree(coarse->surface);
  for (const Vec3& vertex : plate.vertices)
    ASSERT_LE(std::sqrt(tree.nearest(vertex).distance_squared), remeshing_limit(plate, spacing));
}

TEST(FineSurface, BecomesCoarserWithTheSameVolume) {
  const Surface fine = sampled(geometry::Ellipsoid{}, 2.5e-3);
  ASSERT_GT(fine.triangles.size(), 40000u);
  for (const double spacing : {20e-3, 10e-3}) {
    const auto coarse = remeshed(fine, spacing);
    ASSERT_TRUE(coarse.has_value());
    check_closed(coarse->surface, "coarse");
    EXPECT_NEAR(test::mean_edge(coarse->surface) / spacing, 1.0, 0.2);
    EXPECT_EQ(count_needles(coarse->surface), 0u);
    // The needles at the poles are remeshed with vertices on the surface, inside the round body.
    EXPECT_NEAR(volume(coarse->surface) / volume(fine), 1.0, 0.005);
    EXPECT_LE(coarse->distance, remeshing_limit(fine, spacing));
    double most = 0.0;
    for (const auto& [a, b, c] : coarse->surface.triangles) {
      const auto& v = coarse->surface.vertices;
      for (const Vec3& point :
           {v[as_index(a)], Vec3((v[as_index(a)] + v[as_index(b)] + v[as_index(c)]) / 3.0)})
        most = std::max(most, off_ellipsoid(point));
    }
    EXPECT_NEAR(coarse->distance / most, 1.0, 0.15);  // middles of edges count too, to first order
  }
}

TEST(FineSurface, KeepsCornersAndEdgesOfABox) {
  const Vec3 size{0.060, 0.050, 0.030};
  const Surface fine = sampled(geometry::Cuboid{size}, 0.5e-3);
  ASSERT_EQ(count_needles(fine), 0u);
  const auto coarse = remeshed(fine, 8e-3);
  ASSERT_TRUE(coarse.has_value());
  EXPECT_LT(coarse->surface.triangles.size(), 1000u);
  EXPECT_NEAR(volume(coarse->surface) / size.prod(), 1.0, 1e-9);  // each collapse preserves it
  constexpr double rounding = 1e-8;  // m, of the least squares that place the vertices
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 place((corner & 1) * size.x(), ((corner >> 1) & 1) * size.y(),
                     (corner >> 2) * size.z());
    double nearest = 1.0;
    for (const Vec3& vertex : coarse->surface.vertices)
      nearest = std::min(nearest, (vertex - place).norm());
    EXPECT_LT(nearest, rounding);
  }
  EXPECT_LT(coarse->distance, rounding);
}

TEST(FineSurface, KeepsADetailByShorterEdges) {
  // A ball of 100 mm with a knob that is 4 mm high and 6 mm wide.
  Surface fine = sampled(geometry::Ellipsoid{{0.1, 0.1, 0.1}}, 1e-3);
  const Vec3 middle = Vec3::Constant(0.05);
  for (Vec3& vertex : fine.vertices) {
    const Vec3 out = (vertex - middle).normalized();
    const double along = (out - Vec3::UnitX()).norm() * 0.05 / 0.003;
    vertex += 0.004 * std::exp(-along * along) * out;
  }
  const auto coarse = remeshed(fine, 15e-3);
  ASSERT_TRUE(coarse.has_value());
  EXPECT_LE(coarse->distance, remeshing_limit(fine, 15e-3));
  EXPECT_LT(test::mean_edge(coarse->surface), 12e-3);
  double highest = 0.0;
  for (const Vec3& vertex : coarse->surface.vertices)
    highest = std::max(highest, (vertex - middle).norm());
  EXPECT_NEAR(highest, 0.054, remeshing_limit(fine, 15e-3));
}

// A body with two thin horns is coarse but for these.
TEST(FineSurface, KeepsThinLimbsByShorterEdgesThereAlone) {
  geometry::Surface body =
      geometry::sampled(geometry::Ellipsoid{Vec3(0.06, 0.05, 0.04)}, {0.0015, 0.0015})
          .parts.front()
          .surface;
  const Vec3 middle(0.03, 0.025, 0.02);
  for (Vec3& vertex : body.vertices) {
    const Vec3 out = vertex - middle;
    for (const Vec3& way : {Vec3(1.0, 0.0, 0.3), Vec3(-1.0, 0.2, 0.2)}) {
      const double angle = std::acos(std::min(1.0, out.normalized().dot(way.normalized())));
      vertex += 1.2 * std::exp(-angle * angle / (0.16 * 0.16)) * out;
    }
  }
  const auto coarse = remeshed(body, cell_for(body, 150));
  ASSERT_TRUE(coarse.has_value());
  EXPECT_LT(coarse->surface.triangles.size(), 800U);
  EXPECT_LE(coarse->distance, remeshing_limit(body, cell_for(body, 150)));
  EXPECT_NEAR(geometry::enclosed(coarse->surface).volume, geometry::enclosed(body).volume,
              0.005 * geometry::enclosed(body).volume);  // as promised
}

TEST(FineSurface, IsTheSameToTheBitAgain) {
  const Surface fine = sampled(geometry::Cylinder{}, 1.5e-3);
  const auto first = remeshed(fine, 8e-3);
  const auto again = remeshed(fine, 8e-3);
  ASSERT_TRUE(first && again);
  EXPECT_EQ(first->surface.vertices, again->surface.vertices);
  EXPECT_EQ(first->surface.triangles, again->surface.triangles);
  EXPECT_EQ(first->distance, again->distance);
}

// One needle among few triangles must not cost thousands of them.
TEST(CoarseSurface, KeepsAFewNeedles) {
  Surface knobs = sampled(geometry::Ellipsoid{{0.06, 0.05, 0.04}}, 12e-3);
  for (std::size_t v = 0; v < knobs.vertices.size(); v += 3)  // details that need short edges
    knobs.vertices[v] += 0.25 * (knobs.vertices[v] - Vec3(0.03, 0.025, 0.02));
  const auto split = knobs.triangles.front();  // a vertex in an edge's middle makes needles
  knobs.vertices.push_back(0.98 * knobs.vertices[as_index(split[0])] +
                           0.02 * knobs.vertices[as_index(split[1])]);
  const int middle = static_cast<int>(knobs.vertices.size()) - 1;
  std::vector<std::array<int, 3>> faces;
  for (const auto& triangle : knobs.triangles) {
    auto one = triangle, other = triangle;
    bool both = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = triangle[i], b = triangle[(i + 1) % 3];
      if (!((a == split[0] && b == split[1]) || (a == split[1] && b == split[0]))) continue;
      one[(i + 1) % 3] = other[i] = middle;
      both = true;
    }
    faces.push_back(one);
    if (both) faces.push_back(other);
  }
  knobs.triangles = faces;
  check_closed(knobs, "knobs");
  ASSERT_GT(count_needles(knobs), 0u);
  const auto made = remeshed(knobs, 15e-3);
  EXPECT_TRUE(!made || made->surface.triangles.size() < 2000u);
}

// A finger meets the surface of the file, and not one that is a tenth of its travel lower.
TEST(CoarseSurface, IsNearerAroundPlaces) {
  const Surface fine = sampled(geometry::Ellipsoid{{0.06, 0.05, 0.04}}, 1.5e-3);
  const Vec3 top(0.03, 0.025, 0.04);
  constexpr double radius = 6e-3;
  const auto distance = [&](const Surface& coarse) {
    const geometry::BoxTree tree(coarse);
    double most = 0.0;
    for (const Vec3& vertex : fine.vertices)
      if ((vertex - top).norm() < radius)
        most = std::max(most, std::sqrt(tree.nearest(vertex).distance_squared));
    return most;
  };
  const auto everywhere = remeshed(fine, 15e-3);
  ASSERT_TRUE(everywhere.has_value());
  EXPECT_GT(distance(everywhere->surface), 0.1e-3);
  const auto nearer = remeshed(fine, 15e-3, {{top}, radius, 0.04e-3});
  ASSERT_TRUE(nearer.has_value());
  EXPECT_LE(distance(nearer->surface), 0.04e-3);
  EXPECT_LT(nearer->surface.triangles.size(), fine.triangles.size() / 5);
}

// The noise of this scan is larger than the limit, so that a surface as near as that would be the
// given one.
TEST(CoarseSurface, IsOneThatServesWhereNoneIsNear) {
  const Surface rough = rough_ellipsoid();
  const double limit = remeshing_limit(rough, 15e-3);
  const auto coarse = remeshed(rough, 15e-3);
  ASSERT_TRUE(coarse.has_value());
  check_closed(coarse->surface, "coarse");
  EXPECT_LT(coarse->surface.triangles.size(), rough.triangles.size() / 4);
  EXPECT_GT(coarse->distance, limit);
  EXPECT_LE(coarse->distance, 4.0 * limit);
}

// Of many triangles one had been taken that was farther there, without a word.
TEST(CoarseSurface, OfALargeRoughOneIsNearAroundPlacesAllTheSame) {
  const Surface rough = rough_ellipsoid();
  const Nearer nearer{{Vec3(0.03, 0.025, 0.04)}, 4e-3, 0.02e-3};
  const Surface coarse = coarser(rough, 15e-3, nearer);
  EXPECT_LT(coarse.triangles.size(), rough.triangles.size() / 4);
  const geometry::BoxTree tree(coarse);
  for (const Vec3& vertex : rough.vertices) {
    if ((vertex - nearer.places[0]).norm() > nearer.radius) continue;
    ASSERT_LE(std::sqrt(tree.nearest(vertex).distance_squared), nearer.distance);
  }
}

TEST(CoarseSurface, IsNotMadeFiner) {
  EXPECT_FALSE(remeshed(sampled(geometry::Cuboid{}, 10e-3), 5e-3).has_value());
}

TEST(Needles, AreRemeshedAndTheRimStays) {
  const Surface needles = strips(128, 0.030, 0.080);
  ASSERT_EQ(count_needles(needles), needles.triangles.size());
  const auto even = remeshed(needles, 8e-3);
  ASSERT_TRUE(even.has_value());
  EXPECT_EQ(count_needles(even->surface), 0u);
  EXPECT_NEAR(volume(even->surface) / volume(needles), 1.0, 0.005);
  double smallest = std::numbers::pi;
  for (std::size_t t = 0; t < even->surface.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      smallest = std::min(smallest, geometry::corner_angle(even->surface, static_cast<int>(t), i));
  EXPECT_GT(smallest, 10.0 * std::numbers::pi / 180.0);
  // No triangle cuts the rim off: the ends keep their area.
  double ends = 0.0;
  for (std::size_t t = 0; t < even->surface.triangles.size(); ++t) {
    const Vec3 twice = geometry::twice_area(even->surface, static_cast<int>(t));
    if (std::abs(twice.z()) > 0.9 * twice.norm()) ends += 0.5 * twice.norm();
  }
  EXPECT_NEAR(ends / (2.0 * std::numbers::pi * 9e-4), 1.0, 0.03);  // chords of 8 mm take 1.2 %
}

// Those of a rod had all been kept, and its mesh of them had taken a minute.
TEST(Needles, AreEvenAndNearAroundPlaces) {
  const Surface needles = strips(200, 0.015, 0.030);
  const Nearer nearer{{Vec3(0.015, 0.0, 0.015)}, 2.5e-3, 0.02e-3};
  const Surface even = coarser(needles, 8e-3, nearer);
  EXPECT_LT(even.triangles.size(), needles.triangles.size() / 2);
  EXPECT_LT(count_needles(even), 10u);
  const geometry::BoxTree tree(even);
  for (int i = -3; i <= 3; ++i) {
    const double angle = 2.0 * std::numbers::pi / 200.0 * i;
    const Vec3 on(0.015 * std::cos(angle), 0.015 * std::sin(angle), 0.015);
    ASSERT_LT((on - nearer.places[0]).norm(), nearer.radius);
    EXPECT_LE(std::sqrt(tree.nearest(on).distance_squared), nearer.distance) << i;
  }
}

// With CGAL eight tries took minutes, and none had a result.
TEST(Needles, OfAWedgeAreKeptWithoutATry) {
  ASSERT_GT(count_needles(wedge(3.0)), 0U);
  const long before = pages_of_children();
  EXPECT_FALSE(remeshed(wedge(3.0), 1e-3).has_value());
  EXPECT_EQ(pages_of_children(), before) << "a child process was started";
}

// TetGen took minutes over the needles of a connecting rod with sharp edges, and crashed.
TEST(Needles, OfASurfaceWithASharpEdgeAreRemeshed) {
  constexpr int count = 1300;
  Surface needles = strips(count, 0.015, 0.080);
  for (const int v : {0, count}) needles.vertices[as_index(v)].x() += 1.7e-3;  // a narrow fin
  check_closed(needles, "fin");
  const auto even = remeshed(needles, 8e-3);
  ASSERT_TRUE(even.has_value());
  check_closed(even->surface, "even");
  EXPECT_LT(even->surface.triangles.size(), 1000u);
  EXPECT_EQ(count_needles(even->surface), 0u);
  EXPECT_NEAR(volume(even->surface) / volume(needles), 1.0, 0.02);
  EXPECT_LE(even->distance, 4.0 * remeshing_limit(needles, 8e-3));
}

// TetGen took minutes over those of a housing, again with every number of nodes.
TEST(Needles, ThatStayAndHaveNoMeshAreRefusedAtOnce) {
  const Surface needles = wedge(3.0);
  ASSERT_GT(10 * count_needles(needles), needles.triangles.size());
  const auto meshed = [](const Surface& surface) {
    constexpr double no_time = 1e-9;  // s
    (void)tetgen_file(surface, {}, {.nodes = 200}, no_time);
  };
  EXPECT_THROW(meshed(needles), palpate::meshing::Needles);
  try {
    meshed(wedge(30.0));
    FAIL() << "meshed";
  } catch (const palpate::meshing::Needles&) {
    FAIL() << "it has none that stay";
  } catch (const MeshError&) {
  }
}

// Split by TetGen, those of a sensor's housing had become 215 000 nodes.
TEST(Needles, AreNotSplitForAMeshOfTheirSize) {
  const Surface needles = strips(128, 0.030, 0.080);
  const geometry::Body body{{{needles, 0}}};
  const geometry::TetMesh mesh =
      tetgen_body(body, {.edge_length = spacing_of(needles)}, time_given);
  EXPECT_EQ(geometry::outer_surface(mesh).surface.triangles.size(), needles.triangles.size());
}

TEST(Crossings, OfACoarserSurfaceAreReplaced) {
  Surface ball = sampled(geometry::Ellipsoid{Vec3::Constant(0.06)}, 4e-3);
  const double whole = volume(ball);
  Vec3& through = ball.vertices.front();  // comes out on the other side
  through += 2.1 * (Vec3::Constant(0.03) - through);
  ASSERT_FALSE(cgal_library::self_intersections(ball).empty());
  const Surface made = cgal_library::uncrossed(ball);
  check_closed(made, "made");
  EXPECT_NEAR(volume(made) / whole, 1.0, 0.01);
}

// A single edge sharper than five degrees had kept all triangles of a scan.
TEST(FineSurface, IsCoarserBesideASharpEdge) {
  Surface fine = sampled(geometry::Ellipsoid{Vec3::Constant(0.03)}, 0.5e-3);
  ASSERT_GT(fine.triangles.size(), 20000u);
  // A fin: one edge at the equator is pulled outwards by 12 mm.
  const Vec3 middle = Vec3::Constant(0.015);
  int from = 0;
  for (std::size_t v = 0; v < fine.vertices.size(); ++v)
    if (fine.vertices[v].x() > fine.vertices[as_index(from)].x()) from = static_cast<int>(v);
  int to = -1;
  for (const auto& triangle : fine.triangles)
    for (std::size_t i = 0; i < 3 && to < 0; ++i)
      if (triangle[i] == from) to = triangle[(i + 1) % 3];
  for (const int v : {from, to}) fine.vertices[as_index(v)] += 0.012 * Vec3::UnitX();
  check_closed(fine, "fin");
  double folded = 1.0;
  const geometry::Neighbours neighbours(fine);
  for (int t = 0; t < static_cast<int>(fine.triangles.size()); ++t)
    for (const int other : neighbours.across(t))
      folded = std::min(folded, geometry::twice_area(fine, t).normalized().dot(
                                    geometry::twice_area(fine, other).normalized()));
  ASSERT_LT(folded, std::cos(175.0 * std::numbers::pi / 180.0));
  const auto coarse = remeshed(fine, 5e-3);
  ASSERT_TRUE(coarse.has_value());
  check_closed(coarse->surface, "coarse");
  EXPECT_LT(coarse->surface.triangles.size(), 3000u);
  EXPECT_LE(coarse->distance, remeshing_limit(fine, 5e-3));
  double farthest = 0.0;
  for (const Vec3& vertex : coarse->surface.vertices)
    farthest = std::max(farthest, (vertex - middle).norm());
  EXPECT_NEAR(farthest, 0.027, remeshing_limit(fine, 5e-3));
}

// Eight triangles: the search ended with the six nodes of the surface, and said that it keeps them.
TEST(FileMesh, OfAFewTrianglesHasTheNodesAskedFor) {
  for (const double degrees : {3.0, 10.0, 30.0}) {
    const FileMesh made = tetgen_file(wedge(degrees), {}, {.nodes = 3000}, time_given);
    EXPECT_NEAR(static_cast<double>(made.mesh.nodes.size()) / 3000.0, 1.0, 0.03) << degrees;
    EXPECT_EQ(made.warning, "") << degrees;
  }
}

// The mesh of an organ with noise had kept all of its triangles.
TEST(FileMesh, OfANoisyScanHasAboutTheNodesAskedFor) {
  const FileMesh made = tetgen_file(rough_ellipsoid(), {}, {.nodes = 300}, time_given);
  EXPECT_LT(made.mesh.nodes.size(), 600u);
  EXPECT_NE(made.warning.find("the two surfaces are at most"), std::string::npos) << made.warning;
}

TEST(Cells, GiveAboutAsManyNodesAsAskedFor) {
  // A cube of 60 mm in cells of 10 mm: 218 vertices on its surface, 125 inside.
  EXPECT_NEAR(cell_for(sampled(geometry::Cuboid{{0.06, 0.06, 0.06}}, 5e-3), 343), 10e-3, 1.5e-3);
}

TEST(FileMesh, OfAFineSurfaceHasTheNodesAskedForAndSaysWhatItDid) {
  const Surface fine = sampled(geometry::Ellipsoid{}, 3e-3);
  for (const int nodes : {728, 3000}) {
    const FileMesh made = tetgen_file(fine, {}, {.nodes = nodes}, time_given);
    EXPECT_NEAR(static_cast<double>(made.mesh.nodes.size()) / nodes, 1.0, 0.03);
    EXPECT_NEAR(geometry::volume(made.mesh) / volume(fine), 1.0, 0.005);
    EXPECT_NE(made.warning.find("the " + std::to_string(fine.triangles.size()) +
                                " triangles of the surface became "),
              std::string::npos)
        << made.warning;
    EXPECT_NE(made.warning.find(" mm apart"), std::string::npos) << made.warning;
  }
}

TEST(FileMesh, OfNeedlesHasTheNodesAskedFor) {
  const FileMesh made = tetgen_file(strips(128, 0.030, 0.080), {}, {.nodes = 728}, time_given);
  EXPECT_NEAR(static_cast<double>(made.mesh.nodes.size()) / 728.0, 1.0, 0.03);
  EXPECT_NE(made.warning.find("because 512 of them are needles"), std::string::npos)
      << made.warning;
}

TEST(FileMesh, OfAFineSurfaceWithAnEdgeLengthIsCoarserToo) {
  const FileMesh made =
      tetgen_file(sampled(geometry::Cuboid{}, 1e-3), {}, {.edge_length = 8e-3}, time_given);
  EXPECT_LT(made.mesh.nodes.size(), 1500u);
  EXPECT_NE(made.warning.find("finer than the mesh wanted"), std::string::npos) << made.warning;
}

// TetGen puts no nodes into a wall that is thinner than its triangles.
TEST(FileMesh, OfAThinWallHasTheNodesThatAreWanted) {
  Surface wall = geometry::ellipsoid_surface(Vec3::Zero(), Vec3::Constant(0.060), 8e-3);
  const Surface inside = geometry::ellipsoid_surface(Vec3::Zero(), Vec3::Constant(0.056), 8e-3);
  const auto outer = static_cast<int>(wall.vertices.size());
  wall.vertices.insert(wall.vertices.end(), inside.vertices.begin(), inside.vertices.end());
  for (const auto& [a, b, c] : inside.triangles)
    wall.triangles.push_back({outer + a, outer + c, outer + b});
  ASSERT_LT(wall.vertices.size(), 750u);
  const FileMesh made = tetgen_file(wall, {}, {.nodes = 1500}, time_given);
  EXPECT_NEAR(static_cast<double>(made.mesh.nodes.size()) / 1500.0, 1.0, 0.03);
  EXPECT_NE(made.warning.find("edges of the surface were halved"), std::string::npos)
      << made.warning;
  EXPECT_NEAR(geometry::volume(made.mesh) / volume(wall), 1.0, 1e-9);  // rounding
}

TEST(HalvedEdges, LeaveTheSurfaceWhereItIs) {
  const Surface box = geometry::box_surface(Vec3(0.03, 0.02, 0.01), {1, 1, 1});
  const Surface made = geometry::with_halved_edges(box, 100);
  EXPECT_EQ(made.vertices.size(), 100u);
  EXPECT_NO_THROW(check_closed(made, "box"));
  EXPECT_NEAR(volume(made), 6e-6, 1e-18);  // rounding
  EXPECT_NEAR(geometry::area(made), 2.2e-3, 1e-15);
  const double even = spacing_of(made);
  for (const auto& triangle : made.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT(
          (made.vertices[as_index(triangle[i])] - made.vertices[as_index(triangle[(i + 1) % 3])])
              .norm(),
          2.5 * even);
}

TEST(FileMesh, KeepsAGoodSurface) {
  const Surface good = sampled(geometry::Cuboid{}, 8e-3);
  const FileMesh made = tetgen_file(good, {}, {.nodes = 728}, time_given);
  EXPECT_EQ(made.warning, "");
  EXPECT_NEAR(static_cast<double>(made.mesh.nodes.size()) / 728.0, 1.0, 0.03);
}

// 100 nodes are fewer than a torus that is nearer than half a per cent of its size needs.
TEST(FileMesh, HasMoreNodesWhereTheSurfaceNeedsThem) {
  Surface fine = test::torus(0.06).surface;
  for (Vec3& vertex : fine.vertices) vertex *= 0.01;  // 80 mm wide
  const FileMesh made = tetgen_file(fine, {}, {.nodes = 100}, time_given);
  EXPECT_GT(made.mesh.nodes.size(), 125u);
  EXPECT_NE(made.warning.find(" nodes instead of 100, because it keeps the surface's vertices"),
            std::string::npos)
      << made.warning;
  EXPECT_LT(made.mesh.nodes.size(), 4000u);
}

}  // namespace
}  // namespace palpate::meshing
