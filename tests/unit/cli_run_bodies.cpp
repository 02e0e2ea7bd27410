// Bodies from files as people bring them: turned, on a facet, pressed where they are held; and
// inclusions that touch a border.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/cuboid.h"
#include "geometry/shapes.h"
#include "program.h"
#include "record/csv.h"
#include "revolved_bodies.h"
#include "surface_file.h"

namespace palpate::test {
namespace {

class RunBodies : public testing::Test {
 protected:
  Ended run(const std::string& tissue, const std::string& finger, const std::string& more = "",
            const std::string& to = "1.5 mm") {
    write_file(folder_ / "press.toml",
               "[[step]]\nkind = \"indent\"\nto = \"" + to +
                   "\"\n[output]\nfigures = false\n"
                   "pressure_maps = false\ninterval = \"100 ms\"\n[solver]\nmodel = \"solid\"\n"
                   "[finger]\nmaterial = \"rigid\"\nradius = \"8 mm\"\n" +
                   finger +
                   "[tissue]\nyoung_modulus = \"10 kPa\"\npoisson_ratio = 0.4\n"
                   "viscosity = \"none\"\n" +
                   tissue + more);
    return palpate(folder_.path(), {"run", "press.toml", "--force"});
  }
  // N, of the last row.
  double force() const {
    const record::Table table =
        record::read_csv((folder_ / "out/press/force_indentation.csv").string());
    return std::get<double>(table.rows.back()[as_index(table.find("force_N"))]);
  }
  double finding(const std::string& name) const {
    const record::Table table = record::read_csv((folder_ / "out/press/findings.csv").string());
    return std::get<double>(table.rows.front()[as_index(table.find(name))]);
  }
  // A column of 12 x 12 x 24 mm, turned about y by an angle in degrees.
  std::string column(double degrees) {
    geometry::Surface surface =
        geometry::outer_surface(
            geometry::cuboid(Vec3(0.012, 0.012, 0.024), {2, 2, 4}, geometry::CellPattern::mirrored))
            .surface;
    const Eigen::AngleAxisd turn(degrees / 180.0 * M_PI, Vec3::UnitY());
    for (Vec3& vertex : surface.vertices)  // with the digits that files have
      vertex = (1e9 * (turn * vertex)).array().round().matrix() * 1e-9;
    write_off(folder_ / "column.off", surface);
    const Vec3 up = turn * Vec3::UnitZ();
    return "base_height = \"" + number_text(1e3 * 0.018) +
           " mm\"\nshape = { kind = \"file\", file = \"column.off\", unit = \"mm\", up = \"" +
           number_text(up.x()) + " 0 " + number_text(up.z()) + "\" }\n";
  }

  // A plate of 24 x 12 x 4 mm, 20 mm high on a foot of 8 x 12 mm under one end.
  static geometry::Surface shelf() {
    const std::vector<Eigen::Vector2d> corners{{0, 0},   {8, 0},  {8, 20}, {24, 20},
                                               {24, 24}, {8, 24}, {0, 24}, {0, 20}};
    geometry::Surface surface;
    for (const double y : {0.0, 0.012})
      for (const auto& corner : corners)
        surface.vertices.emplace_back(1e-3 * corner.x(), y, 1e-3 * corner.y());
    for (const auto& [a, b, c] : std::vector<std::array<int, 3>>{
             {0, 1, 2}, {0, 2, 7}, {7, 2, 5}, {7, 5, 6}, {2, 3, 4}, {2, 4, 5}}) {
      surface.triangles.push_back({a, b, c});
      surface.triangles.push_back({a + 8, c + 8, b + 8});
    }
    for (int i = 0; i < 8; ++i) {
      const int next = (i + 1) % 8;
      surface.triangles.push_back({i, i + 8, next + 8});
      surface.triangles.push_back({i, next + 8, next});
    }
    return surface;
  }

  TemporaryFolder folder_;
};

TEST_F(RunBodies, a_side_press_without_a_base_behind_it_is_said_to_bend) {
  (void)column(0.0);
  const std::string shape = "shape = { kind = \"file\", file = \"column.off\", unit = \"mm\" }\n";
  const std::string finger = "towards = \"-x\"\nat = [\"12 mm\", \"6 mm\", \"18 mm\"]\n";
  const auto bends = [](const Ended& ended) {
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.err.find("nothing straight behind the press is fixed: the body bends") !=
           std::string::npos;
  };
  EXPECT_TRUE(bends(run(shape, finger, "", "0.5 mm")));
  EXPECT_FALSE(bends(run("base_side = \"-x\"\n" + shape, finger, "", "0.5 mm")));
  // A shelf on a foot that is less far away than it is high.
  write_off(folder_ / "shelf.off", shelf());
  const std::string on_foot = "shape = { kind = \"file\", file = \"shelf.off\", unit = \"mm\" }\n";
  EXPECT_TRUE(bends(run(on_foot, "at = [\"18 mm\", \"6 mm\", \"24 mm\"]\n", "", "0.5 mm")));
  EXPECT_FALSE(bends(run(on_foot, "at = [\"4 mm\", \"6 mm\", \"24 mm\"]\n", "", "0.5 mm")));
}

// A dome of 1 mm on a rim, without elements as wide as eight walls, and its error from two meshes.
TEST_F(RunBodies, a_thin_wall_is_pressed_on_two_meshes) {
  Profile profile;
  constexpr double half = M_PI / 6.0;
  constexpr int parts = 20;
  for (int i = 0; i < parts; ++i)
    profile.push_back({40.5 * std::sin(half * i / parts), 40.5 * std::cos(half * i / parts)});
  const double rim = 40.5 * std::cos(half);
  add_line(profile, {40.5 * std::sin(half), rim}, {26.0, rim}, 3.0);
  add_line(profile, {26.0, rim}, {26.0, rim - 8.0}, 3.0);
  add_line(profile, {26.0, rim - 8.0}, {39.5 * std::sin(half), rim - 8.0}, 3.0);
  for (int i = parts; i >= 0; --i)
    profile.push_back({39.5 * std::sin(half * i / parts), 39.5 * std::cos(half * i / parts)});
  (void)write_surface(profile, 3.0, folder_ / "cap.off");
  const std::string cap = "shape = { kind = \"file\", file = \"cap.off\", unit = \"mm\" }\n";
  const Ended one = run(cap, "", "", "3 mm");
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_EQ(finding("meshes"), 2.0);
  const double stated = finding("stated_error") * force();
  const double found = force();
  const Ended finer =
      palpate(folder_.path(), {"run", "press.toml", "--force", "--set", "solver.tolerance=0.005"});
  ASSERT_EQ(finer.code, 0) << finer.err;
  EXPECT_NEAR(found, force(), stated);
}

// What a wrong unit does: the press is deeper than the body, or the finger wider.
TEST_F(RunBodies, a_press_out_of_proportion_is_refused_or_told) {
  const std::string column_24_mm = column(0.0);
  const auto explained = [&](const std::string& tissue, const std::string& where,
                             const std::string& to) {
    write_file(folder_ / "press.toml", "[[step]]\nkind = \"indent\"\nto = \"" + to +
                                           "\"\n[solver]\nmodel = \"solid\"\n[finger]\nmaterial = "
                                           "\"rigid\"\nradius = \"30 mm\"\n" +
                                           where + "[tissue]\nviscosity = \"none\"\n" + tissue);
    return palpate(folder_.path(), {"explain", "press.toml"});
  };
  const Ended through = explained(column_24_mm, "", "22 mm");
  EXPECT_EQ(through.code, 2);
  EXPECT_TRUE(
      says(through,
           "press.toml:3:6: `to` of 22 mm takes more than 90 % of the tissue, which is 24 mm "
           "thick between the finger and what holds it; press less deep, or check the size of "
           "the body and `unit` of `tissue.shape`"))
      << through.err;
  EXPECT_FALSE(says(through, "it would be")) << through.err;  // 24 mm is a usual size
  const Ended deep = explained(column_24_mm, "", "13 mm");
  EXPECT_EQ(deep.code, 0) << deep.err;
  EXPECT_NE(deep.out.find("the press takes 54 % of the tissue, which is 24 mm thick"),
            std::string::npos)
      << deep.out;
  EXPECT_NE(deep.out.find("the finger of radius 30 mm is wider than the body, which is 12 x 12 x "
                          "24 mm"),
            std::string::npos)
      << deep.out;
  // From a side without a base behind it the column bends away.
  const std::string side = "towards = \"-x\"\nat = [\"12 mm\", \"6 mm\", \"18 mm\"]\n";
  const std::string free = column_24_mm.substr(column_24_mm.find("shape"));
  const Ended bends = explained(free, side, "13 mm");
  EXPECT_EQ(bends.code, 0) << bends.err;
  EXPECT_EQ(bends.out.find("the press takes"), std::string::npos) << bends.out;
  const Ended away = explained(free, side, "25 mm");
  EXPECT_EQ(away.code, 2);
  EXPECT_TRUE(says(away, "`to` of 25 mm is more than the length of the body")) << away.err;
}

TEST_F(RunBodies, a_refusal_names_the_part_that_is_taken) {
  geometry::Surface surface =
      geometry::outer_surface(
          geometry::cuboid(Vec3(0.012, 0.012, 0.024), {2, 2, 4}, geometry::CellPattern::mirrored))
          .surface;
  const geometry::Surface one = surface;
  const int count = static_cast<int>(one.vertices.size());
  for (const Vec3& vertex : one.vertices)
    surface.vertices.push_back(0.1 * vertex + Vec3(0.03, 0.0, 0.0));
  for (const auto& [a, b, c] : one.triangles)
    surface.triangles.push_back({a + count, b + count, c + count});
  write_off(folder_ / "two.off", surface);
  const auto taken = [&](int part, const std::string& centre) {
    return run("shape = { kind = \"file\", file = \"two.off\", unit = \"mm\", part = " +
                   std::to_string(part) + " }\n",
               "", "[[region]]\nkind = \"sphere\"\nradius = \"0.2 mm\"\ncentre = " + centre + "\n",
               "0.2 mm");
  };
  const Ended away = taken(2, "[\"6 mm\", \"6 mm\", \"12 mm\"]");
  EXPECT_EQ(away.code, 2);
  EXPECT_TRUE(says(away, "in the file's coordinates, where it is part 2 of 2")) << away.err;
  const Ended small = taken(2, "[\"30.6 mm\", \"0.6 mm\", \"1.2 mm\"]");
  EXPECT_EQ(small.code, 0) << small.err;
  EXPECT_TRUE(says(small, "with 1000 times its volume")) << small.err;
}

// TetGen, which meshes inclusions, does not serve a mesh that is there.
TEST_F(RunBodies, a_ready_mesh_takes_groups_and_no_inclusions) {
  const Ended ended = run("shape = { kind = \"as_meshed\" }\nmesh = { file = \"" +
                              project_file("golden/meshes/box.node") + "\", unit = \"m\" }\n",
                          "", "[[region]]\nkind = \"sphere\"\n");
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "a ready mesh takes no `sphere` region; give its cells a group"))
      << ended.err;
}

TEST_F(RunBodies, a_turned_column_is_held_as_a_straight_one) {
  const auto at = [](double degrees) {
    const Vec3 top =
        Eigen::AngleAxisd(degrees / 180.0 * M_PI, Vec3::UnitY()) * Vec3(0.006, 0.006, 0.024);
    return "at = [\"" + number_text(1e3 * top.x()) + " mm\", \"" + number_text(1e3 * top.y()) +
           " mm\", \"" + number_text(1e3 * top.z()) + " mm\"]\n";
  };
  Ended ended = run(column(0.0), at(0.0));  // two coordinates of the place are equal
  ASSERT_EQ(ended.code, 0) << ended.err;
  const double straight = force();
  ended = run(column(25.0), at(25.0));
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NEAR(force(), straight, 0.01 * straight);  // free below 18 mm it yields a third more
}

// A roll along y: no vertex lies between its two ends.
TEST_F(RunBodies, long_strips_are_named_with_the_place_and_a_remedy) {
  constexpr int strips = 24;
  geometry::Surface roll;
  for (int i = 0; i < strips; ++i)
    for (const double y : {0.0, 0.06}) {
      const double angle = 2.0 * M_PI * i / strips;
      roll.vertices.emplace_back(0.02 * std::sin(angle), y, 0.02 * std::cos(angle));
    }
  roll.vertices.emplace_back(0.0, 0.0, 0.0);
  roll.vertices.emplace_back(0.0, 0.06, 0.0);
  for (int i = 0; i < strips; ++i) {
    const int a = 2 * i;
    const int b = 2 * ((i + 1) % strips);
    for (const std::array<int, 3>& triangle : {std::array{a, b, b + 1},
                                               {a, b + 1, a + 1},
                                               {2 * strips, b, a},
                                               {2 * strips + 1, a + 1, b + 1}})
      roll.triangles.push_back(triangle);
  }
  write_off(folder_ / "roll.off", roll);
  (void)run("shape = { kind = \"file\", file = \"roll.off\", unit = \"mm\" }\n", "");
  const Ended ended =
      palpate(folder_.path(), {"run", "press.toml", "--force", "--set", "solver.model=hertz"});
  EXPECT_EQ(ended.code, 2) << ended.err;
  EXPECT_TRUE(
      says(ended,
           "curvature at (0, 30, 20) mm, where the finger touches it, cannot be estimated: "
           "the vertices around lie on one or two lines, as those of long strips do; divide "
           "long triangles across"))
      << ended.err;
}

TEST_F(RunBodies, a_press_on_what_is_held_is_refused_at_the_key_that_leads_there) {
  const std::string shape = column(0.0).substr(column(0.0).find("shape"));
  const std::string at = "at = [\"12 mm\", \"6 mm\", \"12 mm\"]\n";
  for (const auto& [finger, place] :
       {std::pair(at + "towards = \"-x\"\n", "press.toml:14:11: "), {at, "press.toml:13:6: "}}) {
    const Ended ended = run("base_side = \"x\"\n" + shape, finger);
    EXPECT_EQ(ended.code, 2);
    EXPECT_TRUE(says(ended, place + std::string("the finger presses the side that the base holds")))
        << ended.err;
  }
}

// A column as Gmsh writes its surface, whose end x = 0 is a group, and with y = 0 another one.
TEST_F(RunBodies, a_group_of_faces_is_held_as_the_side_it_is) {
  const geometry::Surface surface =
      geometry::outer_surface(
          geometry::cuboid(Vec3(0.012, 0.012, 0.024), {2, 2, 4}, geometry::CellPattern::mirrored))
          .surface;
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 4 \"end\"\n2 5 "
      "\"two ends\"\n$EndPhysicalNames\n$Nodes\n" +
      std::to_string(surface.vertices.size()) + "\n";
  for (std::size_t n = 0; n < surface.vertices.size(); ++n) {
    text += std::to_string(n + 1);
    for (const double x : surface.vertices[n]) text += " " + number_text(x);
    text += "\n";
  }
  text += "$EndNodes\n$Elements\n" + std::to_string(surface.triangles.size()) + "\n";
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto on = [&](int axis) {
      return std::all_of(surface.triangles[t].begin(), surface.triangles[t].end(), [&](int corner) {
        return surface.vertices[as_index(corner)][axis] < 1e-9;
      });
    };
    text += std::to_string(t + 1) + " 2 2 " + (on(0) ? "4" : on(1) ? "5" : "0") + " 1";
    for (const int corner : surface.triangles[t]) text += " " + std::to_string(corner + 1);
    text += "\n";
  }
  write_file(folder_ / "column.msh", text + "$EndElements\n");
  const std::string shape = "shape = { kind = \"file\", file = \"column.msh\", unit = \"m\" }\n";
  const std::string top = "at = [\"6 mm\", \"6 mm\", \"24 mm\"]\n";
  Ended ended = run("base_side = \"-x\"\n" + shape, top);
  ASSERT_EQ(ended.code, 0) << ended.err;
  const double by_direction = force();
  ended = run(shape, top);
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_GT(std::abs(force() - by_direction), 0.01 * by_direction);
  for (const char* group : {"end", "4"}) {
    ended = run("base_side = \"" + std::string(group) + "\"\n" + shape, top);
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(force(), by_direction) << group;
  }
  // Half of an end is none.
  std::string half = text + "$EndElements\n";
  for (int k = 0; k < 8; ++k) half.replace(half.find(" 2 2 4 1 "), 9, " 2 2 6 1 ");
  write_file(folder_ / "column.msh", half);
  ended = run("base_side = \"4\"\n" + shape, top);
  EXPECT_EQ(ended.code, 5);
  EXPECT_TRUE(says(ended, "name a group that is the whole end of the body on one side"))
      << ended.err;
  ended = run("base_side = \"left\"\n" + shape, top);
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "there is no group of faces `left`")) << ended.err;
}

// An icosphere of 80 facets on one of them is held by its lowest tenth, as the ball is.
TEST_F(RunBodies, a_facet_of_a_round_body_is_no_flat_underside) {
  geometry::Surface ball = geometry::ellipsoid_surface(Vec3::Zero(), Vec3::Constant(0.03), 0.005);
  const auto& [a, b, c] = ball.triangles.front();
  const Vec3 down = (ball.vertices[as_index(b)] - ball.vertices[as_index(a)])
                        .cross(ball.vertices[as_index(c)] - ball.vertices[as_index(a)])
                        .normalized();
  const auto turn = Eigen::Quaterniond::FromTwoVectors(down, -Vec3::UnitZ());
  for (Vec3& vertex : ball.vertices) vertex = turn * vertex;
  write_off(folder_ / "ball.off", ball);
  const Ended ended = run("shape = { kind = \"file\", file = \"ball.off\", unit = \"mm\" }\n",
                          "x = \"0 mm\"\ny = \"0 mm\"\n");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const double faceted = force();
  ASSERT_EQ(
      run("shape = { kind = \"ellipsoid\", size = [\"30 mm\", \"30 mm\", \"30 mm\"] }\n", "").code,
      0);
  EXPECT_NEAR(faceted, force(), 0.03 * force());
}

// The contact on a ridge of 150 degrees is a third as wide as on a flat: 0.9194 mN by three meshes
// of 3900 to 18 800 nodes, where a flat would have 1.87 and a mesh for a flat's contact 1.02.
TEST_F(RunBodies, a_shallow_press_on_a_blunt_ridge_is_not_one_on_a_flat) {
  const double rise = 20.0 * std::tan(M_PI / 12.0);
  geometry::Surface house;
  for (const double y : {-18.0, 18.0})
    for (const auto& [x, z] :
         {std::pair{-20.0, 0.0}, {20.0, 0.0}, {20.0, 10.0}, {0.0, 10.0 + rise}, {-20.0, 10.0}})
      house.vertices.push_back(1e-3 * Vec3(x, y, z));
  for (int i = 0; i < 5; ++i) {
    const int next = (i + 1) % 5;
    house.triangles.push_back({i, i + 5, next + 5});
    house.triangles.push_back({i, next + 5, next});
    if (i == 0 || i == 4) continue;
    house.triangles.push_back({0, i, next});
    house.triangles.push_back({5, next + 5, i + 5});
  }
  write_off(folder_ / "house.off", house);
  const Ended ended = run("shape = { kind = \"file\", file = \"house.off\", unit = \"mm\" }\n",
                          "x = \"0 mm\"\ny = \"0 mm\"\n", "", "0.12 mm");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const record::Table table = record::read_csv((folder_ / "out/press/findings.csv").string());
  const auto found = [&](const char* name) {
    return std::get<double>(table.rows.front()[as_index(table.find(name))]);
  };
  const double error = found("mesh_error");
  EXPECT_NEAR(error, 0.03 * 0.5 / 0.295, 1e-3);  // the width that is excluded
  // Both with what inertia adds; the width is known before the press, too.
  EXPECT_NEAR(found("predicted_error"), found("stated_error"), 1e-9);
  EXPECT_NEAR(force(), 0.9194e-3, error * 0.9194e-3);
}

TEST_F(RunBodies, an_inclusion_that_touches_a_layer_is_meshed_a_little_smaller) {
  const std::string block =
      "shape = { kind = \"cuboid\", size = [\"44 mm\", \"44 mm\", \"22 mm\"] }\n";
  const std::string finger = "x = \"22 mm\"\ny = \"21 mm\"\n";
  const auto with = [](const char* radius) {
    return "[[region]]\nkind = \"slab\"\nbottom = \"0 mm\"\ntop = \"10 mm\"\n"
           "young_modulus = \"50 kPa\"\n[[region]]\nkind = \"sphere\"\n"
           "centre = [\"23 mm\", \"22 mm\", \"14 mm\"]\nradius = \"" +
           std::string(radius) + " mm\"\nyoung_modulus = \"100 kPa\"\n";
  };
  Ended ended = run(block, finger, with("4"));
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(says(ended, "an inclusion that touches a border is meshed with a radius that is 1 %"))
      << ended.err;
  const double touching = force();
  ended = run(block, finger, with("3.9"));
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_FALSE(says(ended, "touches a border")) << ended.err;
  EXPECT_NEAR(touching, force(), 0.03 * force());
}

}  // namespace
}  // namespace palpate::test
