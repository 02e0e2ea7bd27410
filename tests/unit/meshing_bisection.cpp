// Halving tetrahedra, cutting meshes at a height, and following the smooth boundary.
#include "meshing/bisection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geometry/cuboid.h"
#include "meshing/mesh_check.h"
#include "meshing/tetgen.h"
#include "meshing/tetgen_body.h"

namespace palpate::meshing {
namespace {

constexpr double limit = 60.0;  // s, for TetGen

double longest_edge(const geometry::TetMesh& mesh, std::size_t t) {
  double longest = 0.0;
  for (const auto& [a, b] : geometry::corner_edges)
    longest = std::max(longest, (mesh.nodes[as_index(mesh.tetrahedra[t][as_index(a)])] -
                                 mesh.nodes[as_index(mesh.tetrahedra[t][as_index(b)])])
                                    .norm());
  return longest;
}

geometry::TetMesh halved(const geometry::TetMesh& mesh, const std::vector<char>& marks) {
  Bisection bisection(mesh, [](const Bisection::Middle& edge) { return edge.between; });
  bisection.halve(marks);
  return bisection.mesh();
}

TEST(Bisection, KeepsRandomlyMarkedMeshesSound) {
  std::mt19937 random(3);
  for (const bool lattice : {true, false}) {
    const Vec3 size(0.06, 0.05, 0.03);
    geometry::TetMesh mesh = lattice
                                 ? geometry::cuboid(size, {3, 4, 6}, geometry::CellPattern::kuhn)
                                 : tetgen_cuboid(size, 150, limit);
    const geometry::TetMesh start = mesh;
    for (int round = 0; round < 3; ++round) {
      std::vector<char> marks(mesh.tetrahedra.size(), 0);
      for (char& mark : marks) mark = random() % 8 == 0 ? 3 : 0;
      mesh = halved(mesh, marks);
      EXPECT_NO_THROW(check(mesh, "the refined mesh", size.prod())) << lattice << round;
    }
    ASSERT_GT(mesh.nodes.size(), 2 * start.nodes.size());
    for (std::size_t n = 0; n < start.nodes.size(); ++n)
      EXPECT_EQ(mesh.nodes[n], start.nodes[n]) << n;
  }
}

TEST(Bisection, HalvesEdgesInThreeTimesAndNothingElse) {
  const geometry::TetMesh mesh =
      geometry::cuboid(Vec3(0.08, 0.08, 0.08), {8, 8, 8}, geometry::CellPattern::kuhn);
  std::vector<char> marks(mesh.tetrahedra.size(), 0);
  const std::size_t marked = marks.size() / 2;
  marks[marked] = 3;
  Vec3 centre = Vec3::Zero();
  for (const int node : mesh.tetrahedra[marked]) centre += 0.25 * mesh.nodes[as_index(node)];
  const geometry::TetMesh finer = halved(mesh, marks);
  const double before = longest_edge(mesh, 0);
  std::size_t same = 0;
  for (std::size_t t = 0; t < finer.tetrahedra.size(); ++t) {
    Vec3 middle = Vec3::Zero();
    for (const int node : finer.tetrahedra[t]) middle += 0.25 * finer.nodes[as_index(node)];
    if ((middle - centre).norm() < 1e-3) {
      EXPECT_LE(longest_edge(finer, t), 0.51 * before);
    }
    same += std::abs(longest_edge(finer, t) - before) < 1e-12 ? 1U : 0U;
  }
  EXPECT_GT(same, mesh.tetrahedra.size() - 120);
}

TEST(Bisection, KeepsTheVolumeOfEveryRegion) {
  const geometry::Shape shape = geometry::Cuboid{Vec3(0.04, 0.04, 0.03)};
  const std::vector<geometry::Inclusion> inclusions{{Vec3(0.02, 0.02, 0.017), 0.006, 1}};
  geometry::TetMesh mesh = tetgen_shape(shape, inclusions, {.nodes = 300}, limit);
  const double ball = 4.0 / 3.0 * std::numbers::pi * std::pow(0.006, 3);
  TrueBoundary boundary(mesh, shape, inclusions, {});
  for (int round = 0; round < 2; ++round) {
    std::vector<char> marks;
    for (const int region : mesh.regions) marks.push_back(region == 1 ? 3 : 0);
    Bisection bisection(mesh, [&](const Bisection::Middle& edge) { return boundary.place(edge); });
    bisection.halve(marks);
    mesh = bisection.mesh();
    boundary.restore_inclusions(mesh);
    check(mesh, "the refined mesh", 0.04 * 0.04 * 0.03);
    double inside = 0.0;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      if (mesh.regions[t] == 1) inside += geometry::signed_volume(mesh, static_cast<int>(t));
    EXPECT_NEAR(inside / ball, 1.0, 1e-6);
  }
}

// Every halving of all edges leaves a quarter of the volume that flat faces cut off.
TEST(TrueBoundary, IsApproachedByShapesAndBySurfacesWithoutShape) {
  const geometry::Shape shape = geometry::Ellipsoid{Vec3(0.06, 0.05, 0.04)};
  const geometry::TetMesh start = tetgen_shape(shape, {}, {.nodes = 250}, limit);
  const double whole = std::numbers::pi / 6.0 * 0.06 * 0.05 * 0.04;
  for (const bool known : {true, false}) {
    geometry::TetMesh mesh = start;
    TrueBoundary boundary(start, known ? std::optional(shape) : std::nullopt, {}, {});
    Bisection bisection(mesh, [&](const Bisection::Middle& edge) { return boundary.place(edge); });
    bisection.halve(std::vector<char>(mesh.tetrahedra.size(), 3));
    mesh = bisection.mesh();
    check(mesh, "the refined mesh", 0.0);
    const double before = 1.0 - geometry::volume(start) / whole;
    const double after = 1.0 - geometry::volume(mesh) / whole;
    EXPECT_LT(std::abs(after), (known ? 0.3 : 0.35) * before) << before;
    double worst = 0.0;
    for (const int node : geometry::outer_surface(mesh).nodes) {
      const Vec3 place = (mesh.nodes[as_index(node)] - Vec3(0.03, 0.025, 0.02))
                             .cwiseQuotient(Vec3(0.03, 0.025, 0.02));
      worst = std::max(worst, std::abs(place.norm() - 1.0));
    }
    EXPECT_LT(worst, known ? 1e-9 : 0.012);
  }
}

TEST(TrueBoundary, KeepsTheFlatEndsAndLayersOfALimb) {
  const geometry::LayeredLimb limb{.length = 0.12};
  geometry::TetMesh mesh = tetgen_shape(limb, {}, {.nodes = 900}, limit);
  TrueBoundary boundary(mesh, geometry::Shape(limb), {}, {});
  Bisection bisection(mesh, [&](const Bisection::Middle& edge) { return boundary.place(edge); });
  bisection.halve(std::vector<char>(mesh.tetrahedra.size(), 2));
  const geometry::TetMesh finer = bisection.mesh();
  check(finer, "the refined mesh", 0.0);
  // The volumes inside the skin's surface, the muscle's and the bone's.
  const auto inside = [](const geometry::TetMesh& of) {
    std::array<double, 3> volumes{};
    for (std::size_t t = 0; t < of.tetrahedra.size(); ++t)
      for (int r = 0; r <= of.regions[t]; ++r)
        volumes[as_index(r)] += geometry::signed_volume(of, static_cast<int>(t));
    return volumes;
  };
  const auto frustum = [&](double depth) {
    const double a = limb.radius - depth;
    const double b = limb.end_radius - depth;
    return std::numbers::pi * limb.length / 3.0 * (a * a + a * b + b * b);
  };
  const std::array<double, 3> exact{
      frustum(0.0), frustum(limb.skin_thickness),
      std::numbers::pi * limb.length * limb.bone_radius * limb.bone_radius};
  for (std::size_t r = 0; r < 3; ++r)
    EXPECT_LT(std::abs(inside(finer)[r] / exact[r] - 1.0),
              0.6 * std::abs(inside(mesh)[r] / exact[r] - 1.0))
        << r;
  for (const Vec3& node : finer.nodes) {
    EXPECT_GE(node.y(), -1e-12);
    EXPECT_LE(node.y(), limb.length + 1e-12);
  }
}

TEST(CutAt, LeavesNoEdgeAcrossThePlane) {
  const Vec3 size(0.05, 0.04, 0.03);
  const geometry::TetMesh start = tetgen_cuboid(size, 200, limit);
  for (const double z : {0.004, 0.0123, 0.021, 0.0299}) {
    const geometry::TetMesh mesh = cut_at(start, z, false, geometry::Cuboid{size});
    check(mesh, "the cut mesh", size.prod());
    for (const auto& [a, b] : geometry::edges(mesh)) {
      const double one = mesh.nodes[as_index(a)].z() - z;
      const double other = mesh.nodes[as_index(b)].z() - z;
      EXPECT_GE(one * other, 0.0) << z;
    }
  }
}

TEST(CutAt, CutsTheSkinAloneAndStaysOnTheShape) {
  const geometry::Shape shape = geometry::Ellipsoid{Vec3(0.06, 0.05, 0.04)};
  const geometry::TetMesh start = tetgen_shape(shape, {}, {.nodes = 400}, limit);
  const double z = 0.004;
  const geometry::TetMesh mesh = cut_at(start, z, true, shape);
  check(mesh, "the cut mesh", 0.0);
  int at_height = 0;
  for (const auto& face : geometry::boundary_faces(mesh))
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& one = mesh.nodes[as_index(face[k])];
      const Vec3& other = mesh.nodes[as_index(face[(k + 1) % 3])];
      const double low = std::min(one.z(), other.z());
      const double high = std::max(one.z(), other.z());
      EXPECT_FALSE(low < z - 0.02 * (high - low) && high > z + 0.02 * (high - low));
      at_height += one.z() == z ? 1 : 0;
    }
  EXPECT_GT(at_height, 30);
  for (const int node : geometry::outer_surface(mesh).nodes) {
    const Vec3 place = (mesh.nodes[as_index(node)] - Vec3(0.03, 0.025, 0.02))
                           .cwiseQuotient(Vec3(0.03, 0.025, 0.02));
    EXPECT_NEAR(place.norm(), 1.0, 0.012);
  }
}

}  // namespace
}  // namespace palpate::meshing
