// TetGen in its own process: near the target, the same every time, silent, and failing with advice.
#include "meshing/tetgen.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <map>
#include <set>
#include <thread>

#include "geometry/cuboid.h"
#include "meshing/mesh_check.h"
#include "tetgen_calls.h"

namespace palpate::meshing {
namespace {

using test::mesh_complaint;
using test::time_given;

const Vec3 cube(0.015, 0.020, 0.030);

void expect_same(const geometry::TetMesh& a, const geometry::TetMesh& b) {
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
}

geometry::Surface box(const Vec3& size) {
  const geometry::TetMesh mesh = geometry::cuboid(size, {1, 1, 1}, geometry::CellPattern::kuhn);
  return {mesh.nodes, geometry::boundary_faces(mesh)};
}

class NearTarget : public testing::TestWithParam<int> {};

TEST_P(NearTarget, within_three_percent_and_sound) {
  const int target = GetParam();
  const geometry::TetMesh mesh = tetgen_cuboid(cube, target, time_given);
  const auto count = static_cast<double>(mesh.nodes.size());
  EXPECT_NEAR(count, target, 0.03 * target);  // the promise in tetgen.h
  EXPECT_NO_THROW(check(mesh, "box", cube.prod()));
}

TEST_P(NearTarget, edges_on_the_surface_are_as_long_as_inside) {
  const geometry::TetMesh mesh = tetgen_cuboid(cube, GetParam(), time_given);
  std::set<std::array<int, 2>> on_surface;
  for (const auto& face : geometry::boundary_faces(mesh))
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(face[i], face[(i + 1) % 3]);
      on_surface.insert({low, high});
    }
  double surface_sum = 0.0;
  double inner_sum = 0.0;
  double inner_count = 0.0;
  for (const auto& edge : geometry::edges(mesh)) {
    const double length = (mesh.nodes[static_cast<std::size_t>(edge[0])] -
                           mesh.nodes[static_cast<std::size_t>(edge[1])])
                              .norm();
    if (on_surface.count(edge)) {
      surface_sum += length;
    } else {
      inner_sum += length;
      inner_count += 1.0;
    }
  }
  const double surface_mean = surface_sum / static_cast<double>(on_surface.size());
  // Measured 0.88 to 1.02; a surface that TetGen leaves coarse has 2 and more.
  EXPECT_NEAR(surface_mean / (inner_sum / inner_count), 1.0, 0.25);
}

INSTANTIATE_TEST_SUITE_P(Counts, NearTarget, testing::Values(140, 728, 3000));

TEST(TetGen, top_is_flat_and_whole) {
  const geometry::Surface surface =
      geometry::outer_surface(tetgen_cuboid(cube, 728, time_given)).surface;
  Vec3 top = Vec3::Zero();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& corners = surface.triangles[t];
    if (std::all_of(corners.begin(), corners.end(), [&](int corner) {
          return surface.vertices[static_cast<std::size_t>(corner)].z() == cube.z();
        }))
      top += 0.5 * twice_area(surface, static_cast<int>(t));
  }
  EXPECT_NEAR(top.z(), 3e-4, 1e-15);  // rounding of some 100 triangles
}

TEST(TetGen, two_runs_give_the_same_bits) {
  expect_same(tetgen_cuboid(cube, 728, time_given), tetgen_cuboid(cube, 728, time_given));
}

// TetGen's predicates keep filters that depend on the size of the body, so sizes differ here.
TEST(TetGen, four_threads_at_once_give_what_one_gives) {
  const std::array<Vec3, 4> sizes{cube, 10.0 * cube, Vec3(0.06, 0.06, 0.03), Vec3(1, 2, 3)};
  std::array<geometry::TetMesh, 4> alone;
  for (std::size_t i = 0; i < 4; ++i) alone[i] = tetgen_cuboid(sizes[i], 500, time_given);
  for (int round = 0; round < 5; ++round) {
    std::array<geometry::TetMesh, 4> together;
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < 4; ++i)
      threads.emplace_back([&, i] { together[i] = tetgen_cuboid(sizes[i], 500, time_given); });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < 4; ++i) expect_same(together[i], alone[i]);
  }
}

TEST(TetGen, signals_do_not_disturb_the_answer) {
  const geometry::TetMesh quiet = tetgen_cuboid(cube, 728, time_given);
  const auto before = std::signal(SIGALRM, [](int) {});
  const itimerval every_millisecond{{0, 1000}, {0, 1000}};
  setitimer(ITIMER_REAL, &every_millisecond, nullptr);
  const geometry::TetMesh disturbed = tetgen_cuboid(cube, 728, time_given);
  const itimerval never{};
  setitimer(ITIMER_REAL, &never, nullptr);
  std::signal(SIGALRM, before);
  expect_same(disturbed, quiet);
}

TEST(TetGen, prints_nothing_even_when_asked_to_talk) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  (void)tetgen_surface(box(cube), "pqVV", time_given);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// Processor time of all children that have ended, s.
double seconds_of_children() {
  rusage used{};
  ::getrusage(RUSAGE_CHILDREN, &used);
  return static_cast<double>(used.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(used.ru_utime.tv_usec);
}

TEST(TetGen, stops_at_its_time_limit_and_leaves_no_child) {
  const double before = seconds_of_children();
  const std::string message = mesh_complaint([] { (void)tetgen_cuboid(cube, 1000000, 0.05); });
  EXPECT_TRUE(message.ends_with("ask for fewer nodes or allow more time")) << message;
  // s; this mesh takes about 10 s a try, and a machine that is busy gives a child less, not more.
  EXPECT_LT(seconds_of_children() - before, 5.0);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
  EXPECT_EQ(mesh_complaint([] { (void)tetgen_surface(box(cube), "p", 0.0); }),
            "TetGen did not finish within 0 s; ask for fewer nodes or allow more time");
}

TEST(TetGen, refuses_fewer_nodes_than_a_box_has) {
  EXPECT_EQ(mesh_complaint([] { (void)tetgen_cuboid(cube, 7, time_given); }),
            "a box cannot be meshed with 7 nodes, as it has 8 corners; ask for 8 nodes or more");
  EXPECT_EQ(tetgen_cuboid(cube, 8, time_given).nodes.size(), 8u);
}

// A rod of 100 x 2 x 1 needs nodes all along to keep its shapes good.
TEST(TetGen, refuses_a_target_it_cannot_come_near) {
  const std::string message = mesh_complaint([] {
    (void)tetgen_cuboid({0.1, 0.002, 0.001}, 20, time_given);
  });
  EXPECT_TRUE(message.starts_with("no box mesh near 20 nodes was found, the nearest has "))
      << message;
  EXPECT_TRUE(message.ends_with("; ask for that many or more")) << message;
}

TEST(TetGen, names_a_surface_that_cuts_itself) {
  geometry::Surface surface = box({1, 1, 1});
  const auto first = static_cast<int>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(),
                          {{0.3, 0.3, -0.5}, {0.7, 0.4, -0.5}, {0.5, 0.5, 0.5}});
  surface.triangles.push_back({first, first + 1, first + 2});
  EXPECT_EQ(mesh_complaint([&] { (void)tetgen_surface(surface, "pq", time_given); }),
            "TetGen found that the surface cuts itself; mend the surface where its facets cross");
}

TEST(TetGen, names_an_open_surface) {
  geometry::Surface surface = box({1, 1, 1});
  surface.triangles.pop_back();
  EXPECT_EQ(mesh_complaint([&] { (void)tetgen_surface(surface, "pq", time_given); }),
            "TetGen found no inside; close the surface, so that every edge has two faces");
}

TEST(TetGen, survives_a_crash) {
  geometry::Surface surface = box({1, 1, 1});
  surface.triangles[0][0] = 1 << 28;  // far beyond the vertices
  const std::string message =
      mesh_complaint([&] { (void)tetgen_surface(surface, "pq", time_given); });
  EXPECT_TRUE(message.starts_with("TetGen ")) << message;
}

TEST(TetGen, meshes_any_closed_surface) {
  // An octahedron |x| + |y| + |z| = 1 has the volume 4/3.
  const geometry::Surface surface{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  const geometry::TetMesh mesh = tetgen_surface(surface, "pq1.414a0.01", time_given);
  EXPECT_GT(mesh.tetrahedra.size(), 133u);  // 4/3 in pieces of at most 0.01
  EXPECT_NO_THROW(check(mesh, "octahedron", 4.0 / 3.0));
}

// A box of side 1 within one of side 3.
TEST(TetGen, numbers_the_regions_where_asked) {
  geometry::Surface surface = box({3, 3, 3});
  const auto first = static_cast<int>(surface.vertices.size());
  for (const Vec3& vertex : box({1, 1, 1}).vertices)
    surface.vertices.push_back(vertex + Vec3(1, 1, 1));
  for (const auto& [a, b, c] : box({1, 1, 1}).triangles)
    surface.triangles.push_back({first + a, first + b, first + c});
  EXPECT_TRUE(tetgen_surface(surface, "pq", time_given).regions.empty());
  const geometry::TetMesh mesh = tetgen_surface(surface, "pqA", time_given);
  ASSERT_EQ(mesh.regions.size(), mesh.tetrahedra.size());
  std::map<int, double> volumes;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    volumes[mesh.regions[t]] += geometry::signed_volume(mesh, static_cast<int>(t));
  ASSERT_EQ(volumes.size(), 2u);
  const auto [less, more] = std::minmax(volumes.begin()->second, volumes.rbegin()->second);
  EXPECT_NEAR(less, 1.0, 1e-12);   // rounding
  EXPECT_NEAR(more, 26.0, 1e-12);  // rounding
}

}  // namespace
}  // namespace palpate::meshing
