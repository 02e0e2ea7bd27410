// Meshes for a press: volumes of parts, mirrors, true boundaries, sizes.
#include "solid/mesher.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/error.h"
#include "geometry/box_tree.h"
#include "geometry/cuboid.h"
#include "meshing/cgal_library.h"
#include "solid/finger_press.h"

namespace palpate::solid {
namespace {

// Volumes (m^3) of the regions, by the integration points of curved elements.
std::map<int, double> volumes(const Mesh& mesh) {
  std::map<int, double> found;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const Functions& at : at_points()) {
      Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
      for (std::size_t a = 0; a < 10; ++a)
        jacobian += mesh.nodes[std::size_t(mesh.elements[e][a])] * at.derivatives[a].transpose();
      EXPECT_GT(jacobian.determinant(), 0.0);
      found[mesh.regions[e]] += jacobian.determinant() / 24.0;
    }
  return found;
}

constexpr double ball = 4.0 / 3.0 * 3.14159265358979;

MeshOrder box() {
  return {.shape = geometry::Cuboid{Vec3(0.040, 0.036, 0.020)},
          .sizes = {{{Vec3(0.020, 0.018, 0.020), 0.003, 0.0015}}, 0.009}};
}

// A flat peak over the tip of a spike: its vertex, at the middle of its neighbours, would be below
// the tip.
TEST(SurfaceNet, MovesNoVertexThroughAnotherSheet) {
  geometry::Surface sheets;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      sheets.vertices.emplace_back(10.0 * i, 10.0 * j, i == 1 && j == 1 ? 2.0 : 0.0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const int at = i + 3 * j;
      if (i == j)  // all diagonals run through the peak
        sheets.triangles.insert(sheets.triangles.end(),
                                {{at, at + 1, at + 4}, {at, at + 4, at + 3}});
      else
        sheets.triangles.insert(sheets.triangles.end(),
                                {{at, at + 1, at + 3}, {at + 1, at + 4, at + 3}});
    }
  for (const Vec3& place : {Vec3(10.0, 10.0, 1.5), Vec3(11.0, 10.0, -10.0), Vec3(9.5, 11.0, -10.0),
                            Vec3(9.5, 9.0, -10.0)})
    sheets.vertices.push_back(place);
  for (const int i : {0, 1, 2}) sheets.triangles.push_back({9, 10 + i, 10 + (i + 1) % 3});
  ASSERT_TRUE(meshing::cgal_library::self_intersections(sheets).empty());
  const auto crossing = [&](std::optional<int> whole) {
    SurfaceNet net(sheets, std::vector<int>(sheets.triangles.size(), 2),
                   [](const Vec3& point, std::span<const int>) { return point; });
    net.refine([](const Vec3&) { return 100.0; }, whole);
    return meshing::cgal_library::self_intersections({net.vertices(), net.triangles()}).size();
  };
  EXPECT_GT(crossing(std::nullopt), 0u);  // or the test tests nothing
  EXPECT_EQ(crossing(2), 0u);
  SurfaceNet split(sheets, std::vector<int>(sheets.triangles.size(), 2),
                   [](const Vec3& point, std::span<const int>) { return point; });
  split.only_split();
  split.cut({0, 9.0});  // the peak at 10 would move to it
  split.refine([](const Vec3&) { return 2.0; });
  for (std::size_t v = 0; v < sheets.vertices.size(); ++v)
    EXPECT_EQ(split.vertices()[v], sheets.vertices[v]);
  EXPECT_GT(split.vertices().size(), 100u);
  EXPECT_TRUE(
      meshing::cgal_library::self_intersections({split.vertices(), split.triangles()}).empty());
}

// Two vertices of a surface may lie at one place of a plane that cuts it: there is then no edge
// between them, and the surface is meshed in another way.
TEST(CutsThroughBodies, HaveNoTrianglesWhereAnEdgeHasNoLength) {
  const std::vector<Eigen::Vector2d> points{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}};
  const std::vector<std::array<int, 2>> round{{0, 1}, {1, 2}, {0, 2}};
  const std::vector<std::array<int, 2>> pinched{{0, 1}, {1, 2}, {2, 3}, {0, 3}};
  EXPECT_TRUE(meshing::cgal_library::triangulated({points.data(), 3}, round).has_value());
  EXPECT_FALSE(meshing::cgal_library::triangulated(points, pinched).has_value());
}

// Every place between corners is nearest to a corner, as on a fold: halves are as long as the
// whole.
TEST(SurfaceNet, EndsWhereTheTrueSurfaceIsElsewhere) {
  const geometry::Surface square{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)},
                                 {{0, 1, 2}, {0, 2, 3}}};
  SurfaceNet net(square, {2, 2}, [](const Vec3& point, std::span<const int>) {
    return Vec3(std::round(point.x()), std::round(point.y()), 0.0);
  });
  net.refine([](const Vec3&) { return 0.1; });
  EXPECT_GT(net.vertices().size(), 60u);
  EXPECT_LT(net.vertices().size(), 2000u);
  SurfaceNet fine(square, {2, 2}, [](const Vec3& point, std::span<const int>) { return point; });
  EXPECT_THROW(fine.refine([](const Vec3&) { return 1e-3; }), MeshError);
}

// A tetrahedron of a file whose outer edges bulge: its halves have the same shape.
TEST(SolidMesher, KeepsTheMiddlesOfAFile) {
  const geometry::TetMesh file{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                               {{0, 1, 2, 3}}};
  geometry::EdgeMiddles middles;
  for (const auto& [a, b] : {std::array{1, 2}, {1, 3}, {2, 3}})
    middles[{a, b}] = 0.575 * (file.nodes[std::size_t(a)] + file.nodes[std::size_t(b)]);
  // Jacobians are polynomials of the third degree, which four points integrate to the second.
  const auto volume = [&](double size, bool curved) {
    MeshOrder order;
    order.mesh = &file;
    if (curved) order.middles = &middles;
    order.sizes.largest = size;
    return volumes(mesh_for(order))[0];
  };
  const double whole = volume(10.0, true);
  EXPECT_NEAR(volume(10.0, false), 1.0 / 6.0, 1e-12);
  EXPECT_GT(whole, 1.2 / 6.0);
  for (const double size : {0.4, 0.2}) {
    EXPECT_NEAR(volume(size, true), whole, 0.01 * whole) << size;
    EXPECT_NEAR(volume(size, false), 1.0 / 6.0, 1e-12) << size;
  }
}

// "Skin over fat with a sphere": a later region replaces an earlier one, also where a slab
// cuts it.
TEST(SolidMesher, LaterRegionsReplaceEarlierOnes) {
  const geometry::Inclusion inner{Vec3(0.022, 0.018, 0.010), 0.004, 0};
  const Inclusion of_sphere{.region = 2, .sphere = inner};
  const Inclusion slab{.region = 1, .bottom = 0.0, .top = 0.011};
  MeshOrder order = box();
  order.sizes.spots.push_back({inner.centre, inner.radius, 0.002});
  order.mirrors = {{1, 0.018}};
  const double all = 0.040 * 0.018 * 0.020;
  const double low = 0.040 * 0.018 * 0.011;
  const double sphere = 0.5 * ball * std::pow(inner.radius, 3);
  order.inclusions = {slab, of_sphere};
  std::map<int, double> found = volumes(mesh_for(order));
  EXPECT_NEAR(found[2], sphere, 0.01 * sphere);  // curved faces of 2 mm on a radius of 4 mm
  EXPECT_NEAR(found[0] + found[1] + found[2], all, 1e-9 * all);
  // What of the ball is above the slab: a cap of the height h = 3 mm.
  const double cap = 0.5 * 3.14159265358979 * 0.003 * 0.003 * (3.0 * 0.004 - 0.003) / 3.0;
  EXPECT_NEAR(found[0], all - low - cap, 0.002 * all);
  order.inclusions = {of_sphere, slab};
  found = volumes(mesh_for(order));
  EXPECT_NEAR(found[1], low, 1e-9 * low);
  EXPECT_NEAR(found[2], cap, 0.03 * cap);
  EXPECT_NEAR(found[0] + found[1] + found[2], all, 1e-9 * all);
}

TEST(SolidMesher, WallsHaveElementsByTheirThickness) {
  const Sizes sizes{{{Vec3::Zero(), 2e-3, 1e-3}}, 8e-3, 100e-3, 2.0};
  EXPECT_DOUBLE_EQ(sizes.at({4e-3, 0.0, 0.0}, 10e-3), 1e-3 + 0.35 * 2e-3);    // by the contact
  EXPECT_DOUBLE_EQ(sizes.at({20e-3, 0.0, 0.0}, 10e-3), 5e-3);                 // two across
  EXPECT_DOUBLE_EQ(sizes.at({30e-3, 0.0, 0.0}, 10e-3), 5e-3 + 0.1 * 5e-3);    // far away
  EXPECT_DOUBLE_EQ(sizes.at({20e-3, 0.0, 0.0}, 20e-3), 1e-3 + 0.35 * 18e-3);  // thick
  EXPECT_DOUBLE_EQ(sizes.at({1e-3, 0.0, 0.0}, 0.5e-3), 1e-3);                 // no less than there
  EXPECT_DOUBLE_EQ(sizes.at({60e-3, 0.0, 0.0}, HUGE_VAL), 8e-3);
}

TEST(SolidMesher, MirrorsCutExactlyAndSizesAreKept) {
  MeshOrder order = box();
  order.mirrors = {{0, 0.020}, {1, 0.018}};
  const Mesh mesh = mesh_for(order);
  EXPECT_NEAR(volumes(mesh)[0], 0.020 * 0.018 * 0.020, 1e-15);
  double sum = 0.0;
  int near = 0;
  for (const Element& element : mesh.elements) {
    const Vec3& a = mesh.nodes[std::size_t(element[0])];
    const Vec3& b = mesh.nodes[std::size_t(element[1])];
    EXPECT_LT((a - b).norm(), 2.3 * order.sizes.at(0.5 * (a + b), HUGE_VAL) + 0.002);
    if ((a - order.sizes.spots[0].centre).norm() > 0.002) continue;
    sum += (a - b).norm();
    ++near;
  }
  ASSERT_GT(near, 5);
  EXPECT_NEAR(sum / near, 0.0015, 0.0006);
  for (const Vec3& node : mesh.nodes) {
    EXPECT_GE(node.x(), 0.020);
    EXPECT_GE(node.y(), 0.018);
  }
}

// TetGen alone left some 580 of 4300 tetrahedra below these contacts up to 20 times as long as
// wanted, and the finest of three meshes 14 to 20 % too stiff.
TEST(SolidMesher, LeavesNoLongTetrahedraBelowAContactOnABentSurface) {
  const double contact = 2.824e-3;
  for (const double elements : {4.0, 4.2, 4.4}) {
    const MeshOrder order{
        .shape = geometry::Cylinder{27.237e-3, 54.89e-3},
        .sizes = {{{{27.16e-3, 19.42e-3, 54.473e-3}, 1.25 * contact, contact / elements}},
                  24.8e-3,
                  136e-3}};
    const Mesh mesh = mesh_for(order);
    // As many as where TetGen gives nothing up, and not 46 000.
    EXPECT_GT(mesh.elements.size(), 6000U) << elements;
    EXPECT_LT(mesh.elements.size(), 14000U) << elements;
    for (const Element& element : mesh.elements)
      for (const auto& [i, j] : geometry::corner_edges) {
        const Vec3& a = mesh.nodes[std::size_t(element[std::size_t(i)])];
        const Vec3& b = mesh.nodes[std::size_t(element[std::size_t(j)])];
        EXPECT_LT((a - b).norm(), 5.0 * order.sizes.at(0.5 * (a + b), HUGE_VAL)) << elements;
      }
  }
}

TEST(SolidMesher, MiddlesLieOnTheTrueBoundary) {
  const Vec3 half(0.030, 0.026, 0.018);
  MeshOrder order{.shape = geometry::Ellipsoid{2.0 * half},
                  .mirrors = {{1, half.y()}},
                  .base = Plane{2, 0.0036},
                  .sizes = {{{Vec3(half.x(), half.y(), 2.0 * half.z()), 0.003, 0.002}}, 0.010}};
  const Mesh mesh = mesh_for(order);
  const double want = 0.5 * ball * half.prod();
  EXPECT_NEAR(volumes(mesh)[0], want, 0.005 * want);  // quadratic faces of up to 10 mm
  int on = 0;
  int all = 0;
  for (const OuterFace& face : mesh.boundary)
    for (const int node : face.nodes) {
      const Vec3& place = mesh.nodes[std::size_t(node)];
      if (std::abs(place.y() - half.y()) < 1e-9) continue;
      ++all;
      on += std::abs((place - half).cwiseQuotient(half).norm() - 1.0) < 1e-6 ? 1 : 0;
    }
  EXPECT_EQ(on, all);
}

// A block of 60 x 60 x 20 mm whose top is a hollow of 24 mm radius.
geometry::Surface dish(int cells) {
  constexpr double side = 0.060, height = 0.020, radius = 0.024, deep = 0.003;
  const Vec3 centre(0.5 * side, 0.5 * side, height - deep + radius);
  geometry::Surface made;
  for (const bool top : {true, false})
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) {
        Vec3 at(side * i / cells, side * j / cells, top ? height : 0.0);
        const double beside = (at - centre).head<2>().norm();
        if (top && beside < radius)
          at.z() = std::min(height, centre.z() - std::sqrt(radius * radius - beside * beside));
        made.vertices.push_back(at);
      }
  const int row = cells + 1;
  const auto quad = [&](int a, int b, int c, int d) {
    made.triangles.push_back({a, b, c});
    made.triangles.push_back({a, c, d});
  };
  const auto at = [&](int layer, int i, int j) { return (layer * row + j) * row + i; };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      quad(at(0, i, j), at(0, i + 1, j), at(0, i + 1, j + 1), at(0, i, j + 1));
      quad(at(1, i, j), at(1, i, j + 1), at(1, i + 1, j + 1), at(1, i + 1, j));
    }
  for (int k = 0; k < cells; ++k) {
    quad(at(0, k + 1, 0), at(0, k, 0), at(1, k, 0), at(1, k + 1, 0));
    quad(at(0, k, cells), at(0, k + 1, cells), at(1, k + 1, cells), at(1, k, cells));
    quad(at(0, 0, k), at(0, 0, k + 1), at(1, 0, k + 1), at(1, 0, k));
    quad(at(0, cells, k + 1), at(0, cells, k), at(1, cells, k), at(1, cells, k + 1));
  }
  return made;
}

// A coarser surface has vertices beside the true one. (A dish was touched too early.)
TEST(SolidMesher, CornersLieOnTheSurfaceOfAFile) {
  const geometry::SmoothSurface surface(dish(30));
  const Vec3 top(0.030, 0.030, 0.017);
  MeshOrder order;
  order.surface = &surface;
  order.sizes = {{{top, 0.003, 0.0012}}, 0.008};
  const Mesh mesh = mesh_for(order);
  const geometry::BoxTree tree(surface.surface());
  int corners = 0;
  for (const OuterFace& face : mesh.boundary)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& place = mesh.nodes[std::size_t(face.nodes[i])];
      if ((place - top).norm() > 0.008) continue;
      const Vec3 there = surface.closest_point(place, tree.nearest(place)).position;
      EXPECT_LT((there - place).norm(), 5e-6);
      ++corners;
    }
  EXPECT_GT(corners, 100);
}

// Whole, and cut in two by a mirror through the cavity.
TEST(SolidMesher, ACavityStaysEmpty) {
  const auto sphere = [](double size) {
    return geometry::sampled(geometry::Ellipsoid{Vec3::Constant(size)}, {0.1 * size, 0.1 * size})
        .parts.front()
        .surface;
  };
  const Vec3 middle = Vec3::Constant(0.020);
  geometry::Surface surface = sphere(0.040);
  const int outer = int(surface.vertices.size());
  geometry::Surface inner = sphere(0.016);
  for (const Vec3& vertex : inner.vertices)
    surface.vertices.push_back(vertex + Vec3::Constant(0.012));
  for (const auto& [a, b, c] : inner.triangles)
    surface.triangles.push_back({outer + a, outer + c, outer + b});
  const geometry::SmoothSurface smooth(surface);
  const double want = ball * (std::pow(0.020, 3) - std::pow(0.008, 3));
  for (const bool cut : {false, true}) {
    MeshOrder order = box();
    order.shape.reset();
    order.surface = &smooth;
    order.sizes = {{{Vec3(0.020, 0.020, 0.040), 0.003, 0.002}}, 0.006};
    if (cut) order.mirrors = {{1, 0.020}};
    const Mesh mesh = mesh_for(order);
    EXPECT_NEAR(volumes(mesh)[0], cut ? 0.5 * want : want, 0.01 * want);
    for (const Vec3& node : mesh.nodes) EXPECT_GT((node - middle).norm(), 0.0070);  // chords
  }
}

TEST(SolidMesher, RefinesGivenTetrahedraWithTheirRegions) {
  geometry::TetMesh given =
      geometry::cuboid({0.040, 0.036, 0.020}, {4, 4, 2}, geometry::CellPattern::mirrored);
  given.regions.assign(given.tetrahedra.size(), 0);
  double upper = 0.0;
  for (std::size_t t = 0; t < given.tetrahedra.size(); ++t) {
    double z = 0.0;
    for (const int node : given.tetrahedra[t]) z += 0.25 * given.nodes[std::size_t(node)].z();
    if (z > 0.010) given.regions[t] = 1;
    if (z > 0.010) upper += geometry::signed_volume(given, int(t));
  }
  MeshOrder order = box();
  order.shape.reset();
  order.mesh = &given;
  const Mesh mesh = mesh_for(order);
  EXPECT_GT(mesh.elements.size(), 2 * given.tetrahedra.size());
  EXPECT_NEAR(volumes(mesh)[1], upper, 1e-12 * upper);
}

// Held up to 7 mm, of layers of 10 mm: a face whose centre is held is held as a whole.
TEST(SolidMesher, DividesFacesOfAFileAcrossTheBorderOfTheBase) {
  const geometry::TetMesh given =
      geometry::cuboid({0.040, 0.036, 0.020}, {4, 4, 2}, geometry::CellPattern::mirrored);
  const auto mesh_held_to = [&](double level) {
    MeshOrder order;
    order.mesh = &given;
    order.base = Plane{.at = level, .inclined = Vec3::UnitZ()};
    order.sizes.largest = 1.0;
    return mesh_for(order);
  };
  const Mesh mesh = mesh_held_to(0.007);
  double held = 0.0;
  for (const OuterFace& face : mesh.boundary) {
    const auto corner = [&](std::size_t i) -> const Vec3& {
      return mesh.nodes[std::size_t(face.nodes[i])];
    };
    if ((corner(0) + corner(1) + corner(2)).z() / 3.0 <= 0.007)
      held += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  const double border = 2.0 * (0.040 + 0.036);
  EXPECT_NEAR(held, 0.040 * 0.036 + 0.007 * border, 0.0025 * border);  // half of an edge of 5 mm
  EXPECT_EQ(mesh_held_to(0.0).elements.size(), given.tetrahedra.size());
}

TEST(SolidMesher, RefusesALumpThatSticksOut) {
  MeshOrder order = box();
  order.inclusions = {
      {.region = 1, .sphere = geometry::Inclusion{Vec3(0.020, 0.018, 0.018), 0.003, 0}}};
  EXPECT_THROW((void)mesh_for(order), MeshError);
}

TEST(SolidMesher, GivesTheSameMeshTwice) {
  const MeshOrder order = box();
  const Mesh one = mesh_for(order);
  const Mesh two = mesh_for(order);
  EXPECT_EQ(one.nodes, two.nodes);
  EXPECT_EQ(one.elements, two.elements);
}

TEST(SolidMesher, KnowsMirrorImages) {
  geometry::Surface surface =
      geometry::facets(geometry::sampled(geometry::Cuboid{Vec3(0.03, 0.04, 0.05)}, {0.010, 0.010}));
  EXPECT_TRUE(symmetric(surface, {0, 0.015}));
  EXPECT_FALSE(symmetric(surface, {0, 0.016}));
  surface.vertices.front() += Vec3(0.0, -0.001, 0.0);
  EXPECT_FALSE(symmetric(surface, {1, 0.020}));
}

}  // namespace
}  // namespace palpate::solid
