// Boxes, and regions that are not where the body is.
#include "scene/places.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "geometry/cuboid.h"
#include "geometry/shapes.h"
#include "meshing/mesh_files.h"
#include "meshing/surface_files.h"
#include "part_of_mesh.h"
#include "run/choose.h"
#include "run/picture.h"
#include "run/refined_mesh.h"
#include "run_text.h"
#include "scene/proportions.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"

namespace palpate::scene {
namespace {

const std::string with_inclusion =
    "[tissue]\nyoung_modulus = \"10 kPa\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"
    "[[region]]\nkind = \"sphere\"\nradius = \"5 mm\"\n";

std::string refusal_of(const std::string& text) {
  try {
    const scenario::Family family = scenario::parse(text, "press.toml", {});
    (void)run::build_scene(family.cases.front(), family);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Places, a_box_has_no_rounding_for_zero) {
  EXPECT_EQ(box_text({Vec3(-1.3e-18, -0.02, 0.0), Vec3(0.06, 1.3e-18, 0.03)}),
            "x 0 to 60, y -20 to 0, z 0 to 30 mm");
}

TEST(Places, the_part_of_a_ball_in_a_half_space_is_that_of_its_cap) {
  const geometry::Surface box =
      geometry::sampled(geometry::Cuboid{Vec3(1.0, 1.0, 1.0)}, {0.1, 0.1}).parts.front().surface;
  for (const double height : {-0.1, 0.0, 0.03, 0.06, 0.11}) {
    // A cap of the height h of a ball of radius r has the part h^2 (3 r - h) / (4 r^3).
    const double r = 0.1;
    const double h = std::clamp(r + height, 0.0, 2.0 * r);
    EXPECT_NEAR(share_inside(box, {Vec3(0.5, 0.5, height), r, 0}),
                h * h * (3.0 * r - h) / (4.0 * r * r * r), 0.002)  // as promised
        << height;
  }
}

TEST(Places, an_inclusion_outside_is_refused_with_both_boxes) {
  EXPECT_EQ(
      refusal_of(with_inclusion + "centre = [\"70 mm\", \"30 mm\", \"15 mm\"]\n"),
      "press.toml:9:10: `[[region]]` 1 lies outside the body: it has x 65 to 75, y 25 to 35, z "
      "10 to 20 mm, the body x 0 to 60, y 0 to 60, z 0 to 30 mm, from the lowest corner of its "
      "box; change `centre` or `radius`");
  EXPECT_TRUE(refusal_of(with_inclusion + "centre = [\"30 mm\", \"30 mm\", \"27 mm\"]\n")
                  .starts_with("press.toml:9:10: only "));
}

TEST(Places, a_slab_and_a_base_are_asked_too) {
  const std::string press =
      "[tissue]\nyoung_modulus = \"10 kPa\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n";
  EXPECT_NE(
      refusal_of(press + "[[region]]\nkind = \"slab\"\nbottom = \"-20 mm\"\ntop = \"-5 mm\"\n")
          .find("`[[region]]` 1 lies outside the body: it has z -20 to -5 mm, the body z 0 to 30"),
      std::string::npos);
  EXPECT_NE(refusal_of("[tissue]\nyoung_modulus = \"10 kPa\"\nbase_height = \"31 mm\"\n[[step]]\n"
                       "kind = \"indent\"\nto = \"1 mm\"\n")
                .find("the base ends at a height of 31 mm, but the body has 0 to 30 mm"),
            std::string::npos);
}

// A box of 60 x 40 x 20 mm about the origin as a file, with another axis up or pressed from a side.
class PlacedBody : public testing::Test {
 protected:
  PlacedBody() {
    geometry::Surface box =
        geometry::sampled(geometry::Cuboid{Vec3(60, 40, 20)}, {5.0, 5.0}).parts.front().surface;
    for (Vec3& vertex : box.vertices) vertex -= Vec3(30, 20, 10);
    std::filesystem::create_directories(folder_);
    meshing::write_surface(folder_ + "/box.off", box, 1.0);
  }
  ~PlacedBody() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] scenario::Resolved placed(const std::string& shape, const std::string& rest) const {
    const scenario::Family family =
        scenario::parse("[tissue]\nshape = { file = \"box.off\", unit = \"mm\"" + shape + " }\n" +
                            "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n" + rest,
                        folder_ + "/press.toml", {});
    return run::choose(family.cases.front()).chosen;
  }

  std::string folder_ = testing::TempDir() + "palpate_placed" + std::to_string(::getpid());
};

TEST_F(PlacedBody, the_way_of_the_finger_becomes_minus_z) {
  const scenario::Resolved up = placed(", up = \"-y\"", "");
  EXPECT_EQ(Vec3(up.tissue.turn * -Vec3::UnitY()), Vec3(Vec3::UnitZ()));
  EXPECT_EQ(up.tissue.base_up, Vec3(Vec3::UnitZ()));
  const scenario::Resolved side = placed("", "[finger]\ntowards = \"x\"\n");
  EXPECT_EQ(Vec3(side.tissue.turn * Vec3::UnitX()), Vec3(-Vec3::UnitZ()));
  EXPECT_EQ(side.tissue.base_up, Vec3(side.tissue.turn * Vec3::UnitZ()));
  EXPECT_NEAR(side.tissue.turn.determinant(), 1.0, 1e-12);  // rounding
}

// A box with a cavity whose lowest corner is at `at`, in triangles of these sizes.
geometry::Surface hollow_box(const Vec3& size, double cell, const Vec3& cavity, double cavity_cell,
                             const Vec3& at) {
  const auto box = [](const Vec3& of, double edge) {
    return geometry::sampled(geometry::Cuboid{of}, {edge, edge}).parts.front().surface;
  };
  geometry::Surface hollow = box(size, cell);
  const geometry::Surface inner = box(cavity, cavity_cell);
  const int first = static_cast<int>(hollow.vertices.size());
  for (const Vec3& vertex : inner.vertices) hollow.vertices.emplace_back(vertex + at);
  for (const auto& [a, b, c] : inner.triangles)
    hollow.triangles.push_back({first + a, first + c, first + b});
  return hollow;
}

// A cube of 30 mm with a cubic cavity of 18 mm in its middle, both off the nodes of a square.
class HollowCube : public PlacedBody {
 protected:
  HollowCube() {
    meshing::write_surface(folder_ + "/box.off",
                           hollow_box(Vec3(30, 30, 30), 10.0, Vec3(18, 18, 18), 6.0, Vec3(6, 6, 6)),
                           1.0);
  }

  [[nodiscard]] scenario::Family family(const std::string& rest) const {
    return scenario::parse(
        "[tissue]\nshape = { file = \"box.off\", unit = \"mm\" }\n[solver]\nmodel = \"solid\"\n" +
            rest,
        folder_ + "/press.toml", {});
  }
  [[nodiscard]] std::string refusal(const std::string& rest) const {
    try {
      const scenario::Family read = family(rest);
      (void)run::build_scene(read.cases.front(), read);
    } catch (const InputError& error) {
      const std::string text = error.what();
      return text.substr(text.find("press.toml"));
    }
    return "no error";
  }
};

TEST_F(HollowCube, the_tissue_under_the_finger_has_no_cavity) {
  const scenario::Family read = family(
      "[finger]\nmaterial = \"rigid\"\nradius = \"8 mm\"\n[[step]]\nkind = \"indent\"\nto = \"7 "
      "mm\"\n");
  const Choice choice = run::choose(read.cases.front());
  EXPECT_NEAR(choice.touch.thickness, 0.006, 1e-12);  // rounding
  EXPECT_NEAR(choice.touch.tissue_to_base, 0.012, 1e-12);
  EXPECT_NEAR(choice.touch.to_base, 0.030, 1e-12);
  const auto notes = disproportions(choice.chosen, choice.touch, choice.expected);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(notes.front().starts_with(
      "the press takes 58 % of the tissue, which is 12 mm thick between the finger and what holds "
      "it (without 18 mm that are hollow)"))
      << notes.front();
}

TEST_F(HollowCube, places_that_are_not_in_the_body_are_refused) {
  const std::string press = "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n";
  EXPECT_TRUE(
      refusal(press + "[finger]\nradius = \"5 mm\"\nat = [\"900 mm\", \"15 mm\", \"14 mm\"]\n")
          .starts_with("press.toml:10:6: `at` is 870 mm from the surface of the body, which "
                       "has x 0 to 30, y 0 to 30, z 0 to 30 mm, in the file's coordinates"));
  EXPECT_EQ(
      refusal(press + "[[region]]\nkind = \"sphere\"\nradius = \"5 mm\"\n"
                      "centre = [\"15 mm\", \"15 mm\", \"15 mm\"]\n"),
      "press.toml:11:10: `[[region]]` 1 lies in a cavity of the body: it has x 10 to 20, y 10 "
      "to 20, z 10 to 20 mm, the cavity x 6 to 24, y 6 to 24, z 6 to 24 mm, in the file's "
      "coordinates; change `centre` or `radius`");
}

// One mesh was 1.6 % above three.
TEST_F(HollowCube, two_meshes_know_the_wall_that_bends) {
  const record::CaseRecord pressed = test::run_text(
      "[tissue]\nyoung_modulus = \"20 kPa\"\npoisson_ratio = 0.4\nviscosity = \"none\"\nshape = { "
      "file = \"" +
      folder_ +
      "/box.off\", unit = \"mm\" }\n[solver]\nmodel = \"solid\"\n[finger]\nmaterial = "
      "\"rigid\"\nradius = \"5 mm\"\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n");
  constexpr double witness = 14.372e-3;  // N
  EXPECT_NEAR(pressed.contact.back().contact_force, witness, 0.008 * witness);
}

// Held by the lowest tenth of its diagonal: 6 mm of two sides, and the ends between them.
TEST_F(PlacedBody, the_base_has_the_area_of_the_held_band) {
  meshing::write_surface(
      folder_ + "/box.off",
      geometry::sampled(geometry::Cuboid{Vec3(30, 30, 30)}, {30.0, 30.0}).parts.front().surface,
      1.0);
  const scenario::Family read = scenario::parse(
      "[tissue]\nshape = { file = \"box.off\", unit = \"mm\", up = \"1 1 0\" }\n"
      "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n",
      folder_ + "/press.toml", {});
  SpecimenShapes shapes;
  const scenario::Resolved found = run::choose(read.cases.front(), shapes).chosen;
  const auto& body = shapes.surface(found, folder_).surface->surface();
  EXPECT_NEAR(base_area(found, body, Vec3::Zero(), 0.0).of_surface,
              (2 * 6.0 * 30.0 + 2 * 18.0) / 5400.0, 1e-6);  // rounding of the file
}

TEST_F(PlacedBody, a_place_has_no_rounding_for_zero) {
  const scenario::Resolved side = placed("", "[finger]\ntowards = \"x\"\n");
  EXPECT_EQ(place_text(side, side.tissue.turn * Vec3(0.05, -8.7e-18, 0.01)), "(50, 0, 10) mm");
}

TEST_F(PlacedBody, what_was_made_of_a_mesh_file_is_told) {
  std::ofstream(folder_ + "/box.mesh")
      << "MeshVersionFormatted 2\nDimension 3\nVertices\n8\n0 0 0 0\n30 0 0 0\n30 30 0 0\n"
         "0 30 0 0\n0 0 30 0\n30 0 30 0\n30 30 30 0\n0 30 30 0\n"
         "Hexahedra\n1\n1 2 3 4 5 6 7 8 0\nEnd\n";
  const scenario::Family family = scenario::parse(
      "[tissue]\nmesh = { kind = \"file\", file = \"box.mesh\", unit = \"mm\" }\n"
      "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n",
      folder_ + "/press.toml", {});
  EXPECT_EQ(run::choose(family.cases.front()).touch.warning,
            "1 hexahedra, prisms and pyramids of box.mesh were cut into tetrahedra");
}

// The notes on a press with these lines of `[finger]`, of a shape that has these keys.
class NotedBody : public PlacedBody {
 protected:
  [[nodiscard]] std::vector<std::string> notes(const std::string& finger,
                                               const std::string& unit = "mm") const {
    const scenario::Family family = scenario::parse(
        "[tissue]\nshape = { file = \"box.off\", unit = \"" + unit +
            "\" }\n[solver]\nmodel = \"solid\"\n[[step]]\nkind = \"indent\"\nto = \"2 " + unit +
            "\"\n[finger]\nmaterial = \"rigid\"\n" + finger,
        folder_ + "/press.toml", {});
    const Choice choice = run::choose(family.cases.front());
    return disproportions(choice.chosen, choice.touch, choice.expected);
  }
};

// Of a box that is pressed on a slope, whose own box is longer than the body.
TEST_F(NotedBody, the_longest_side_is_that_of_the_file) {
  const auto found = notes("radius = \"70 um\"\ntowards = \"-1 -1 0\"\n", "um");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found.front().ends_with("in `cm` it would be 0.6 m long, in `mm` 0.06 m"))
      << found.front();
}

// A roof of 60 degrees along x, 30 mm high. Beside its ridge the normal is that of one side.
TEST_F(NotedBody, a_press_along_a_normal_beside_a_ridge_is_told) {
  const double half = 30.0 / std::sqrt(3.0);
  geometry::Surface roof;
  for (const double x : {0.0, 60.0})
    for (const auto& [y, z] : {std::pair(-half, 0.0), {half, 0.0}, {0.0, 30.0}})
      roof.vertices.emplace_back(x, y, z);
  roof.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                    {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  meshing::write_surface(folder_ + "/box.off", roof, 1.0);
  const std::string beside = "radius = \"8 mm\"\nat = [\"30 mm\", \"1 mm\", \"28 mm\"]\n";
  const auto found = notes(beside);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found.front().starts_with("the press is along the normal at the place of `at`"))
      << found.front();
  EXPECT_TRUE(notes(beside + "towards = \"-z\"\n").empty());
  EXPECT_TRUE(notes("radius = \"8 mm\"\nat = [\"30 mm\", \"9 mm\", \"15 mm\"]\n").empty());
}

// However small the ball is.
TEST_F(NotedBody, a_press_on_a_ball_is_along_the_mean_of_its_normals) {
  meshing::write_surface(
      folder_ + "/box.off",
      geometry::sampled(geometry::Ellipsoid{Vec3(20, 20, 20)}, {2.0, 2.0}).parts.front().surface,
      1.0);
  EXPECT_TRUE(notes("radius = \"9 mm\"\nat = [\"18 mm\", \"10 mm\", \"16 mm\"]\n").empty());
}

// A frame of 60 mm in the plane and 10 mm height with a hole of 20 mm.
geometry::Surface square_ring() {
  geometry::Surface ring;
  for (const double half : {30.0, 10.0})
    for (const double z : {0.0, 10.0})
      for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
        ring.vertices.emplace_back(half * x, half * y, z);
  const auto side = [&](int a, int b, int c, int d) {
    ring.triangles.push_back({a, b, c});
    ring.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    side(i, j, j + 4, i + 4);            // outside
    side(j + 8, i + 8, i + 12, j + 12);  // in the hole
    side(i + 4, j + 4, j + 12, i + 12);  // top
    side(j, i, i + 8, j + 8);            // bottom
  }
  return ring;
}

TEST_F(PlacedBody, a_finger_without_a_place_presses_a_ring_on_its_top) {
  meshing::write_surface(folder_ + "/box.off", square_ring(), 1.0);
  const scenario::Resolved small = placed("", "[finger]\nradius = \"5 mm\"\n");
  EXPECT_TRUE(small.finger.moved);
  const double x = std::abs(small.finger.x.value()), y = std::abs(small.finger.y.value());
  EXPECT_TRUE(std::max(x, y) > 0.010 && std::max(x, y) < 0.030) << x << " " << y;
  // In the middle of a corner of the top, as far as can be from the two sides and from the hole's
  // corner: 30 - x = sqrt(2) (x - 10).
  const double best = 1e-3 * (30.0 + std::sqrt(2.0) * 10.0) / (1.0 + std::sqrt(2.0));
  EXPECT_NEAR(x, best, 1e-3);  // places are some tenths of a millimetre apart
  EXPECT_NEAR(y, best, 1e-3);
  // A large one would rest on the edges of the hole, and one with a place keeps it.
  EXPECT_TRUE(placed("", "[finger]\nradius = \"25 mm\"\n").finger.moved);
  EXPECT_FALSE(placed("", "[finger]\nx = \"20 mm\"\n").finger.moved);
}

// The finger comes from outside: along the normal of a wall of the hole it meets the other side.
TEST_F(PlacedBody, a_place_on_an_inner_wall_is_refused_or_told) {
  meshing::write_surface(folder_ + "/box.off", square_ring(), 1.0);
  const auto read = [&](const std::string& towards, const std::string& x = "10 mm") {
    return scenario::parse(
        "[tissue]\nshape = { file = \"box.off\", unit = \"mm\" }\n[[step]]\nkind = \"indent\"\n"
        "to = \"1 mm\"\n[finger]\nradius = \"4 mm\"\nat = [\"" +
            x + "\", \"0 mm\", \"5 mm\"]\n" + towards,
        folder_ + "/press.toml", {});
  };
  const std::string meets =
      "the finger comes from outside the body and meets it at (-30, 0, 5) mm, 40 mm before the "
      "place of `at`";
  const scenario::Family normal = read("");
  try {
    (void)run::build_scene(normal.cases.front(), normal);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().front().place.line, 8);
    EXPECT_EQ(error.problems().front().message,
              meets +
                  ", which lies on an inner wall, or on a surface so rough that its normal leads "
                  "through another place; give a place on the outside, `finger.towards`, or a "
                  "smoother surface");
  }
  const auto notes = [](const scenario::Family& family) {
    const Choice choice = run::choose(family.cases.front());
    return disproportions(choice.chosen, choice.touch, choice.expected);
  };
  const auto across = notes(read("towards = \"x\"\n"));
  ASSERT_EQ(across.size(), 1u);
  EXPECT_EQ(across.front(),
            meets + "; change `finger.at` or `finger.towards` if that is not meant");
  EXPECT_TRUE(notes(read("", "-30 mm")).empty());
}

// 20 mm wide and 30 mm high, with a hollow of 8 mm and 10 mm depth in its top.
TEST_F(PlacedBody, a_finger_without_a_place_presses_no_rim) {
  geometry::Surface post;
  for (const auto& [half, z] : {std::pair(10.0, 0.0), {10.0, 30.0}, {4.0, 30.0}, {4.0, 20.0}})
    for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
      post.vertices.emplace_back(half * x, half * y, z);
  const auto side = [&](int a, int b, int c, int d) {
    post.triangles.push_back({a, b, c});
    post.triangles.push_back({a, c, d});
  };
  side(3, 2, 1, 0);
  side(12, 13, 14, 15);
  for (int ring = 0; ring < 3; ++ring)
    for (int i = 0; i < 4; ++i) {
      const int a = 4 * ring + i, b = 4 * ring + (i + 1) % 4;
      side(a, b, b + 4, a + 4);
    }
  meshing::write_surface(folder_ + "/box.off", post, 1.0);
  const scenario::Resolved large = placed("", "[finger]\nradius = \"6 mm\"\n");
  EXPECT_TRUE(large.finger.moved);
  EXPECT_GT(std::max(std::abs(*large.finger.x), std::abs(*large.finger.y)), 0.006);
  // A small one fits into the hollow, and presses its floor.
  EXPECT_FALSE(placed("", "[finger]\nradius = \"2 mm\"\n").finger.moved);
}

TEST_F(PlacedBody, a_place_is_taken_to_the_surface_and_pressed_along_its_normal) {
  const scenario::Resolved side =
      placed("",
             "[finger]\nat = [\"5 mm\", \"50 mm\", \"3 mm\"]\n[[region]]\n"
             "kind = \"sphere\"\nradius = \"2 mm\"\ncentre = [\"5 mm\", \"10 mm\", \"3 mm\"]\n");
  EXPECT_NEAR((side.tissue.turn * Vec3::UnitY() - Vec3::UnitZ()).norm(), 0.0, 1e-9);  // rounding
  const auto& inclusion = std::get<scenario::Inclusion>(side.regions.front().part);
  EXPECT_NEAR(inclusion.centre[0], *side.finger.x, 1e-9);  // the inclusion lies below the finger
  EXPECT_NEAR(inclusion.centre[1], *side.finger.y, 1e-9);
  EXPECT_NEAR(inclusion.centre[2], 0.010, 1e-9);
}

// A box of 60 x 60 x 40 mm with a cavity of 20 x 20 x 10 mm, 5 mm below its top.
class HollowBody : public PlacedBody {
 protected:
  HollowBody() {
    meshing::write_surface(
        folder_ + "/box.off",
        hollow_box(Vec3(60, 60, 40), 5.0, Vec3(20, 20, 10), 5.0, Vec3(20, 20, 25)), 1.0);
  }

  [[nodiscard]] std::pair<double, double> force(const std::string& body) const {
    const std::string text = "[tissue]\nyoung_modulus = \"10 kPa\"\nviscosity = \"none\"\n" + body +
                             "[solver]\nmodel = \"coupled_springs\"\n[finger]\nradius = \"6 mm\"\n"
                             "[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n";
    const scenario::Family family = scenario::parse(text, folder_ + "/press.toml", {});
    const record::CaseRecord record =
        test::run_scene(run::build_scene(family.cases.front(), family));
    EXPECT_EQ(record.outcome, record::Outcome::completed) << record.reason;
    return {record.contact.back().contact_force, test::found(record, "stated_error")};
  }
};

TEST_F(HollowBody, is_as_soft_from_a_surface_as_from_tetrahedra) {
  const geometry::TetMesh mesh =
      geometry::cuboid({0.060, 0.060, 0.040}, {12, 12, 8}, geometry::CellPattern::mirrored);
  const geometry::TetMesh hollow = test::part_of(mesh, [](const Vec3& middle) {
    return ((middle - Vec3(0.030, 0.030, 0.030)).cwiseAbs().array() >=
            Vec3(0.010, 0.010, 0.005).array())
        .any();
  });
  meshing::write_node_ele(folder_ + "/hollow.node", hollow);
  const auto [by_mesh, stated] =
      force("shape = { kind = \"as_meshed\" }\nmesh = { file = \"hollow.node\", unit = \"m\" }\n");
  const auto [by_surface, also_stated] = force("shape = { file = \"box.off\", unit = \"mm\" }\n");
  EXPECT_NEAR(by_surface, by_mesh, (stated + also_stated) * by_mesh);
  const auto [filled, of_filled] =
      force("shape = { file = \"box.off\", unit = \"mm\", part = 1 }\n");
  EXPECT_GT(filled, (1.0 + stated + of_filled) * by_mesh);
}

// 1 mm from the cavity's wall, and 4 mm from the top.
TEST_F(HollowBody, is_pressed_from_outside_wherever_the_place_is) {
  const scenario::Resolved pressed =
      placed("", "[finger]\nat = [\"32 mm\", \"29 mm\", \"36 mm\"]\n");
  EXPECT_NEAR((pressed.tissue.turn - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-12);
  EXPECT_NEAR(*pressed.finger.x, 0.032, 1e-9);
}

TEST_F(HollowBody, shows_its_cavity) {
  const scenario::Family family = scenario::parse(
      "[tissue]\nshape = { file = \"box.off\", unit = \"mm\" }\n[[step]]\nkind = \"indent\"\n"
      "to = \"0.1 mm\"\n",
      folder_ + "/press.toml", {});
  const record::ScenePicture picture =
      run::picture_of(run::build_scene(family.cases.front(), family));
  EXPECT_EQ(picture.materials.back(), "cavity");
  double volume = 0.0;
  for (const auto& face : picture.faces)
    if (face.region == 1) {
      EXPECT_EQ(face.within, 0);
      volume += face.corners[0].dot(face.corners[1].cross(face.corners[2])) / 6.0;
    }
  EXPECT_NEAR(volume, 0.020 * 0.020 * 0.010, 1e-12);
}

TEST_F(PlacedBody, what_does_not_go_together_is_refused) {
  const auto refusal = [&](const std::string& shape, const std::string& rest) {
    try {
      (void)placed(shape, rest);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refusal(", up = \"up\"", "").find("`up` wants a direction, got `up`"),
            std::string::npos);
  EXPECT_NE(
      refusal(", up = \"y\"", "[finger]\nx = \"1 mm\"\n").find("give the place as `finger.at`"),
      std::string::npos);
  EXPECT_NE(refusal("", "[finger]\nat = [\"1 mm\"]\n").find("`at` wants three lengths, got 1"),
            std::string::npos);
  EXPECT_NE(refusal("", "[finger]\ntowards = \"x\"\n[[region]]\nkind = \"slab\"\ntop = \"5 mm\"\n")
                .find("a `slab` is for a finger that comes from above"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::scene
