// Surface files with one number, line or face that is wrong: the sentence says which.
#include <limits>

#include "broken_surface.h"

namespace palpate::meshing {
namespace {

TEST_F(BrokenSurfaces, numbers_that_are_none) {
  for (const std::string bad : {"nan", "inf", "-inf", "1e400", "0x1p3", "1.0D0", "one"}) {
    const std::string want =
        "a coordinate wants a finite number, got `" + bad + "`; write it like `12.5` or `1.25e1`";
    EXPECT_EQ(complaint("a.obj", with(good_obj, "v 1 0 0", "v " + bad + " 0 0")),
              "input: a.obj:2:3: " + want);
    EXPECT_EQ(complaint("a.off", with(good_off, "1 0 0", "1 " + bad + " 0")),
              "input: a.off:4:3: " + want);
    EXPECT_EQ(complaint("a.stl", with(good_stl, "vertex 0 1 0", "vertex 0 1 " + bad)),
              "input: a.stl:5:12: " + want);
    EXPECT_EQ(complaint("a.ply", with(good_ply, "\n1 0 0", "\n" + bad + " 0 0")),
              "input: a.ply:11:1: `x` wants a finite number, got `" + bad +
                  "`; write it like `12.5` or `1.25e1`");
  }
  EXPECT_EQ(
      complaint("b.obj", with(good_obj, "v 1 0 0", "v 1e309 0 0")),
      "input: b.obj:2:3: a coordinate wants a finite number, got `1e309`; write it like `12.5` "
      "or `1.25e1`");
  EXPECT_NE(complaint("b.obj", with(good_obj, "v 1 0 0", "v 1e39 0 0")).find("is 1e+37 m long"),
            std::string::npos);
}

TEST_F(BrokenSurfaces, decimal_commas) {
  const std::string want = "a number has a comma; write decimal points, and blanks between numbers";
  EXPECT_EQ(complaint("a.obj", with(good_obj, "v 1 0 0", "v 1,5 0 0")), "input: a.obj:2: " + want);
  EXPECT_EQ(complaint("a.off", with(good_off, "1 0 0", "1 0 0,5")), "input: a.off:4: " + want);
  EXPECT_EQ(complaint("a.stl", with(good_stl, "vertex 0 1 0", "vertex 0 1,5 0")),
            "input: a.stl:5: " + want);
  EXPECT_EQ(complaint("a.ply", with(good_ply, "\n1 0 0", "\n1,5 0 0")), "input: a.ply:11: " + want);
}

TEST_F(BrokenSurfaces, binary_numbers_that_are_none) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf}) {
    EXPECT_EQ(complaint("a.stl", with(binary_stl(), 84 + 50 + 12 + 4, bad)),
              "input: a.stl: facet 1 has a coordinate that is not a finite number; export the file "
              "again");
    const std::size_t body = binary_ply().find("end_header\n") + 11;
    EXPECT_EQ(complaint("a.ply", with(binary_ply(), body + 12, bad)),
              "input: a.ply: vertex 1 (counting from 0) has a coordinate that is not a finite "
              "number; export it again");
  }
}

TEST_F(BrokenSurfaces, vertices_that_are_not_there) {
  for (const std::string bad : {"5", "-5", "0"})
    EXPECT_EQ(complaint("a.obj", with(good_obj, "f 1 2 4", "f 1 2 " + bad)),
              "input: a.obj:6: the face names vertex `" + std::string(bad == "-5" ? "0" : bad) +
                  "`, but the vertices run from 1 to 4; the file may be cut short: export it "
                  "again");
  EXPECT_EQ(complaint("b.obj", with(good_obj, "f 1 2 4", "f 1 2 x/1")),
            "input: b.obj:6:7: a corner wants the number of a vertex, got `x/1`; write it like "
            "`12`, or `-1` for the last vertex so far");
  for (const std::string bad : {"4", "-1"}) {
    const std::string want = "the face names vertex `" + bad +
                             "`, but the vertices run from 0 to 3; the file may be cut short: "
                             "export it again";
    EXPECT_EQ(complaint("a.off", with(good_off, "3 0 1 3", "3 0 1 " + bad)),
              "input: a.off:8: " + want);
    EXPECT_EQ(complaint("a.ply", with(good_ply, "3 0 1 3", "3 0 1 " + bad)),
              "input: a.ply:15: " + want);
  }
  const std::size_t last = binary_ply().size() - 4;
  for (const std::int32_t bad : {4, -1, std::numeric_limits<std::int32_t>::max()})
    EXPECT_EQ(
        complaint("b.ply", with(binary_ply(), last, bad)),
        "input: b.ply: face 3 (counting from 0) names vertex `" + std::to_string(bad) +
            "`, but the vertices run from 0 to 3; the file may be cut short: export it again");
}

TEST_F(BrokenSurfaces, negative_obj_numbers_are_good) {
  EXPECT_EQ(complaint("a.obj", with(good_obj, "f 2 3 4", "f -3 -2 -1")), "sound");
}

// Exporters leave such faces where they round: reading keeps them, and the repair removes them.
TEST_F(BrokenSurfaces, faces_with_a_vertex_twice) {
  const auto want = [](const std::string& face) {
    return "mesh: surface `paw`: face 1 (" + face +
           ") near (0, 0, 0) mm has vertex 0 twice; remove it, and close the hole where it leaves "
           "one";
  };
  EXPECT_EQ(complaint("a.obj", with(good_obj, "f 1 2 4", "f 1 2 1")), want("0, 2, 0"));
  EXPECT_EQ(complaint("a.off", with(good_off, "3 0 1 3", "3 0 1 0")), want("0, 2, 0"));
  EXPECT_EQ(complaint("a.ply", with(good_ply, "3 0 1 3", "3 0 1 0")), want("0, 2, 0"));
  EXPECT_EQ(complaint("a.stl", with(good_stl, facet("0 0 0", "1 0 0", "0 0 1"),
                                    facet("0 0 0", "0 0 1", "-0 0 0"))),
            want("0, 3, 0"));
  EXPECT_EQ(complaint("b.stl", with(binary_stl(), 84 + 50 + 12 + 12, 0.0F)), want("0, 0, 3"));
}

TEST_F(BrokenSurfaces, faces_of_two_corners) {
  EXPECT_EQ(complaint("a.obj", with(good_obj, "f 1 2 4", "f 1 2")),
            "input: a.obj:6: a face wants three corners or more, got 2; the file may be cut short: "
            "export it again");
  EXPECT_EQ(complaint("a.off", with(good_off, "3 0 1 3", "2 0 1")),
            "input: a.off:8: a face wants three corners or more, got 2; mend the line, or the "
            "counts of the header if this is a vertex");
  EXPECT_EQ(
      complaint("a.ply", with(good_ply, "3 0 1 3", "2 0 1")),
      "input: a.ply:15: a face wants three corners or more, got 2; the file may be cut short: "
      "export it again");
  const std::size_t second = binary_ply().size() - 3 * 13;
  EXPECT_EQ(complaint("b.ply", with(binary_ply(), second, '\0')),
            "input: b.ply: face 1 (counting from 0) wants three corners or more, got 0; export the "
            "file again");
}

// A comb of three teeth.
TEST_F(BrokenSurfaces, a_polygon_that_no_corner_sees_whole) {
  EXPECT_EQ(complaint("a.off",
                      "OFF\n12 1 0\n0 0 0\n5 0 0\n5 5 0\n4 5 0\n4 1 0\n3 1 0\n3 5 0\n2 5 0\n"
                      "2 1 0\n1 1 0\n1 5 0\n0 5 0\n12 0 1 2 3 4 5 6 7 8 9 10 11\n"),
            "mesh: surface `paw`: face 2 (0, 3, 4) near (30, 10, 0) mm has no area: its height is "
            "below 1e-6 of its longest edge (20 mm); merge its close vertices or swap its longest "
            "edge");
}

TEST_F(BrokenSurfaces, ply_headers) {
  const auto ply = [](const std::string& header) { return "ply\nformat ascii 1.0\n" + header; };
  EXPECT_EQ(complaint("a.ply", with(good_ply, "ascii", "utf8")),
            "input: a.ply: has no known `format` in its header; write it as `ascii` or "
            "`binary_little_endian`");
  EXPECT_EQ(complaint("a.ply", with(good_ply, "float y", "string y")),
            "input: a.ply: line 5 of its header is not understood; export it again");
  EXPECT_EQ(complaint("a.ply", with(good_ply, "float y", "float w")),
            "input: a.ply: its vertices want `x`, `y` and `z` of type `float` or `double`; export "
            "it again");
  EXPECT_EQ(complaint("a.ply", with(good_ply, "float y", "int y")),
            "input: a.ply: its vertices want `x`, `y` and `z` of type `float` or `double`; export "
            "it again");
  const std::string textured = complaint(
      "a.ply", with(good_ply, "vertex_indices\n",
                    "vertex_indices\nproperty list uchar float texcoord\n"));  // without its values
  EXPECT_NE(textured.find("the line ends before `texcoord`"), std::string::npos) << textured;
  EXPECT_EQ(complaint("a.ply", ply("end_header\n")),
            "input: a.ply: its header wants an element `vertex` and an element `face`; export it "
            "again");
  EXPECT_EQ(complaint("a.ply", ply("element vertex 3\nelement face 1\nend_header\n")),
            "input: a.ply: element `vertex` has no property; export it again");
}

TEST_F(BrokenSurfaces, stl_lines_out_of_order) {
  EXPECT_EQ(complaint("a.stl", with(good_stl, "endloop\n", "")),
            "input: a.stl:7: the line wants `endloop`, got `endfacet`; export the file again");
  EXPECT_EQ(complaint("a.stl", with(good_stl, "vertex 0 1 0\n", "")),
            "input: a.stl:6: the line wants `vertex`, got `endloop`; export the file again");
}

TEST_F(BrokenSurfaces, obj_lines_that_go_on) {
  EXPECT_EQ(complaint("a.obj", with(good_obj, "f 1 2 4", "f 1 \\\n 2\\\n4")),
            complaint("a.obj", good_obj));
  EXPECT_EQ(
      complaint("a.obj", with(good_obj, "f 1 2 4", "f 1 \\\n  two \\\n4")),
      "input: a.obj:7:3: a corner wants the number of a vertex, got `two`; write it like `12`, "
      "or `-1` for the last vertex so far");
  EXPECT_EQ(complaint("a.obj", good_obj + "\\\n\\"), complaint("a.obj", good_obj));
}

// What only the surface as a whole can tell.
TEST_F(BrokenSurfaces, read_well_but_not_sound) {
  EXPECT_NE(complaint("a.obj", with(good_obj, "f 2 3 4\n", "")).find("is open: 3 edges in 1 hole"),
            std::string::npos);
  EXPECT_NE(
      complaint("a.obj", with(good_obj, "f 2 3 4", "f 3 2 4")).find("faces the side opposite"),
      std::string::npos);
  EXPECT_NE(complaint("a.obj", good_obj + "f 2 3 4\n").find("faces 3 and 4 have the same vertices"),
            std::string::npos);
  EXPECT_NE(complaint("a.obj", with(good_obj, "v 0 0 1", "v 0 0 -1")).find("is inside out"),
            std::string::npos);
  EXPECT_NE(complaint("a.obj", with(good_obj, "v 0 0 1", "v 0 0 5000")).find("is 50 m long"),
            std::string::npos);
  EXPECT_NE(complaint("a.obj", with(good_obj, "v 0 0 1", "v 0 0 1e-9")).find("has no area"),
            std::string::npos);
  EXPECT_NE(complaint("a.obj", with(good_obj, "v 0 0 1", "v 1 0 0")).find("has vertex 2 twice"),
            std::string::npos)
      << complaint("a.obj", with(good_obj, "v 0 0 1", "v 1 0 0"));
  EXPECT_NE(complaint("a.obj", good_obj + "v 3 0 0\nv 4 0 0\nv 3 1 0\nv 3 0 1\nf 5 7 6\nf 5 6 8\n"
                                          "f 5 8 7\nf 6 7 8\n")
                .find("has 2 parts"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::meshing
