// Files that are no surface, or not quite: each gets its sentence, and nothing is printed.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "base/error.h"
#include "base/files.h"
#include "geometry/surface_check.h"
#include "geometry/surface_files.h"

namespace palpate::geometry {
namespace {

// A corner of a cube of 1 cm in each format: vertex 0 in the origin, the others on the axes.
const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const std::string kOff =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const std::string kPlyHeader =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n";
const std::string kPly = "ply\nformat ascii 1.0\n" + kPlyHeader +
                         "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const std::array<std::array<float, 3>, 4> kPoints{
    {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}}};
const std::array<std::array<std::int32_t, 3>, 4> kFaces{
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 1\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
         "\nendloop\nendfacet\n";
}

const std::string kStl = "solid paw\n" + facet("0 0 0", "0 1 0", "1 0 0") +
                         facet("0 0 0", "1 0 0", "0 0 1") + facet("0 0 0", "0 0 1", "0 1 0") +
                         facet("1 0 0", "0 1 0", "0 0 1") + "endsolid paw\n";

template <typename Item>
void put(std::string& bytes, const Item& item) {
  bytes.append(reinterpret_cast<const char*>(&item), sizeof(item));
}

std::string binary_stl(std::uint32_t count = 4) {
  std::string bytes(80, ' ');
  put(bytes, count);
  for (const auto& face : kFaces) {
    bytes.append(12, '\0');
    for (const std::int32_t v : face) put(bytes, kPoints[static_cast<std::size_t>(v)]);
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string binary_ply() {
  std::string bytes = "ply\nformat binary_little_endian 1.0\n" + kPlyHeader;
  for (const auto& point : kPoints) put(bytes, point);
  for (const auto& face : kFaces) {
    bytes += '\3';
    put(bytes, face);
  }
  return bytes;
}

template <typename Item>
std::string with(std::string bytes, std::size_t at, const Item& item) {
  std::memcpy(bytes.data() + at, &item, sizeof(item));
  return bytes;
}

std::string with(std::string text, const std::string& old, const std::string& fresh) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), fresh);
}

class BrokenSurfaces : public testing::Test {
 protected:
  BrokenSurfaces() { std::filesystem::create_directories(folder_); }
  ~BrokenSurfaces() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

  // What reading and checking says, in cm, its kind in front and without the folder.
  [[nodiscard]] std::string verdict(const std::string& name) const {
    std::string text = "sound";
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
      check_closed(read_surface(path(name), 1e-2), "paw");
    } catch (const MeshError& error) {
      text = std::string("mesh: ") + error.what();
    } catch (const InputError& error) {
      text = std::string("input: ") + error.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "") << text;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << text;
    const std::size_t folder = text.find(path(""));
    if (folder != std::string::npos) text.erase(folder, path("").size());
    return text;
  }

  [[nodiscard]] std::string complaint(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;  // thousands of them: no flushing
    return verdict(name);
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("palpate_broken_" + std::to_string(getpid()));
};

TEST_F(BrokenSurfaces, whole_ones_are_sound) {
  EXPECT_EQ(complaint("a.obj", kObj), "sound");
  EXPECT_EQ(complaint("a.off", kOff), "sound");
  EXPECT_EQ(complaint("a.ply", kPly), "sound");
  EXPECT_EQ(complaint("a.stl", kStl), "sound");
  EXPECT_EQ(complaint("b.ply", binary_ply()), "sound");
  EXPECT_EQ(complaint("b.stl", binary_stl()), "sound");
}

TEST_F(BrokenSurfaces, files_that_cannot_be_read) {
  EXPECT_EQ(verdict("none.stl"),
            "input: none.stl: cannot be read: No such file or directory; check the path");
  EXPECT_EQ(complaint("a.step", kObj),
            "input: a.step: a surface wants the ending `.stl`, `.obj`, `.ply` or `.off`; export it "
            "as one of these");
  EXPECT_TRUE(complaint("stl", kStl).starts_with("input: stl: a surface wants the ending"));
  for (const char* name : {"folder.stl", "folder.obj", "folder.ply", "folder.off"}) {
    std::filesystem::create_directory(path(name));
    EXPECT_EQ(verdict(name),
              std::string("input: ") + name + ": is not a file; give the path of a file");
  }
  if (getuid() == 0) return;  // who may read everything
  write_atomically(path("locked.obj"), kObj);
  ::chmod(path("locked.obj").c_str(), 0);
  EXPECT_EQ(verdict("locked.obj"), "input: locked.obj: cannot be read; check its permissions");
}

TEST_F(BrokenSurfaces, empty_files) {
  EXPECT_EQ(complaint("a.obj", ""), "mesh: a.obj: holds no faces; export the surface again");
  EXPECT_EQ(complaint("b.obj", "# nothing\n"),
            "mesh: b.obj: holds no faces; export the surface again");
  EXPECT_EQ(complaint("a.off", ""),
            "mesh: a.off: the file wants to begin with `OFF`; export it again, or give it the "
            "ending of its real format");
  EXPECT_EQ(complaint("a.ply", ""),
            "mesh: a.ply: does not begin with `ply`; export it again, or give it the ending of its "
            "real format");
  EXPECT_EQ(complaint("a.stl", ""),
            "mesh: a.stl: is neither an ASCII STL, which begins with `solid`, nor a binary one, "
            "which would have 84 bytes for its 0 facets, not 0; it is cut short or of another "
            "format: export it again");
}

TEST_F(BrokenSurfaces, no_faces) {
  const std::string want = "holds no faces; export the surface again";
  EXPECT_EQ(complaint("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "mesh: a.obj: " + want);
  EXPECT_EQ(complaint("a.off", "OFF\n1 0 0\n0 0 0\n"), "mesh: a.off: " + want);
  EXPECT_EQ(complaint("a.stl", "solid\nendsolid\n"), "mesh: a.stl: " + want);
  EXPECT_EQ(complaint("b.stl", std::string(84, '\0')), "mesh: b.stl: " + want);
  EXPECT_EQ(complaint("a.ply", with(with(with(kPly, "face 4", "face 0"), "3 0 2 1\n3 0 1 3\n", ""),
                                    "3 0 3 2\n3 1 2 3\n", "")),
            "mesh: a.ply: " + want);
}

TEST_F(BrokenSurfaces, another_format_under_this_ending) {
  EXPECT_EQ(complaint("a.obj", binary_stl()),
            "mesh: a.obj: is not a text file in OBJ format; export it again, or give it the ending "
            "of its real format");
  EXPECT_EQ(complaint("b.obj", kOff), "mesh: b.obj: holds no faces; export the surface again");
  EXPECT_EQ(complaint("a.off", kObj),
            "mesh: a.off:1: the file wants to begin with `OFF`; export it again, or give it the "
            "ending of its real format");
  EXPECT_EQ(complaint("a.ply", kStl),
            "mesh: a.ply: does not begin with `ply`; export it again, or give it the ending of its "
            "real format");
  EXPECT_EQ(complaint("a.stl", kObj),
            "mesh: a.stl:1: the line wants `solid`, got `v`; export the "
            "file again");
}

TEST_F(BrokenSurfaces, garbage) {
  std::mt19937 random(7);  // its sequence is fixed by the standard
  std::string noise(5000, '\0');
  for (char& letter : noise) letter = static_cast<char>(random() & 255U);
  for (const std::string ending : {"obj", "off", "ply", "stl"}) {
    for (const std::string& content :
         {noise, std::string(4096, '\0'), std::string(100000, 'x'), "\xff\xfe" + noise,
          "ply\nformat ascii 1.0\n" + noise, "OFF\n" + noise, "solid \n" + noise, "v 1 " + noise}) {
      const std::string got = complaint("g." + ending, content);
      EXPECT_TRUE(got.starts_with("mesh: g." + ending + ":")) << got;
      EXPECT_LT(got.size(), 400u) << got;
    }
  }
  EXPECT_EQ(complaint("z.off", std::string(4096, '\0')),
            "mesh: z.off: is not a text file in OFF format; export it again, or give it the ending "
            "of its real format");
}

// Wherever a file ends, it is refused; text may lack its last line end, and an OBJ that ends
// between two lines, or in a number that is still a vertex, is found by its holes.
TEST_F(BrokenSurfaces, cut_short_anywhere) {
  for (const auto& [name, content] :
       std::vector<std::pair<std::string, std::string>>{{"a.obj", kObj},
                                                        {"a.off", kOff},
                                                        {"a.ply", kPly},
                                                        {"a.stl", kStl.substr(0, kStl.size() - 5)},
                                                        {"b.ply", binary_ply()},
                                                        {"b.stl", binary_stl()}})
    for (std::size_t size = 0; size + 1 < content.size(); ++size) {
      const std::string got = complaint(name, content.substr(0, size));
      ASSERT_TRUE(got.starts_with("mesh: ")) << name << " of " << size << " bytes: " << got;
      ASSERT_GT(got.size(), 40u) << got;
    }
}

TEST_F(BrokenSurfaces, says_where_it_is_cut_short) {
  EXPECT_EQ(complaint("a.obj", kObj.substr(0, kObj.size() - 3)),
            "mesh: a.obj:8: a face wants three corners or more, got 2; the file may be cut short: "
            "export it again");
  EXPECT_EQ(complaint("b.obj", "v 0 0 0\nv 1 0"),
            "mesh: b.obj:2: a vertex wants three coordinates, got 2; the file may be cut short: "
            "export it again");
  EXPECT_EQ(complaint("a.off", kOff.substr(0, kOff.size() - 16)),
            "mesh: a.off:8: the file ends after 2 of 4 faces; it is cut short: export it again");
  EXPECT_EQ(complaint("b.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n"),
            "mesh: b.off:4: the file ends after 2 of 4 vertices; it is cut short: export it again");
  EXPECT_EQ(complaint("a.ply", kPly.substr(0, kPly.size() - 9)),
            "mesh: a.ply:16: the file ends after 3 of 4 lines of element `face`; it is cut short: "
            "export it again");
  EXPECT_EQ(complaint("d.ply", kPly.substr(0, kPly.size() - 2)),
            "mesh: d.ply:17: a face wants three corners or more, got 2; the file may be cut short: "
            "export it again");
  EXPECT_EQ(complaint("a.stl", kStl.substr(0, kStl.size() - 13)),
            "mesh: a.stl:29: the file ends before `endsolid`, in or after facet 4; it is cut "
            "short: export it again");
  EXPECT_EQ(complaint("b.ply", binary_ply().substr(0, binary_ply().size() - 1)),
            "mesh: b.ply: the file ends in number 3 of 4 of element `face`; it is cut short: "
            "export it again");
  EXPECT_EQ(complaint("c.ply", binary_ply().substr(0, 100)),
            "mesh: c.ply: ends before `end_header`; it is cut short: export it again");
  EXPECT_EQ(complaint("b.stl", binary_stl().substr(0, 200)),
            "mesh: b.stl: is neither an ASCII STL, which begins with `solid`, nor a binary one, "
            "which would have 284 bytes for its 4 facets, not 200; it is cut short or of another "
            "format: export it again");
}

TEST_F(BrokenSurfaces, counts_that_lie) {
  for (const std::uint32_t count : {0U, 3U, 5U, 4000000000U})
    EXPECT_NE(
        complaint("a.stl", binary_stl(count)).find(std::to_string(count) + " facets, not 284"),
        std::string::npos);
  EXPECT_EQ(complaint("a.off", with(kOff, "4 4 6", "4 3 6")),
            "mesh: a.off:10: the header counts 4 vertices and 3 faces, but another line follows; "
            "mend the counts");
  EXPECT_EQ(complaint("b.off", with(kOff, "4 4 6", "4 5 6")),
            "mesh: b.off:10: the file ends after 4 of 5 faces; it is cut short: export it again");
  EXPECT_EQ(complaint("c.off", with(kOff, "4 4 6", "2000000000 4 6")),
            "mesh: c.off:10: the file ends after 8 of 2000000000 vertices; it is cut short: export "
            "it again");
  EXPECT_EQ(complaint("d.off", with(kOff, "4 4 6", "-4 4 6")),
            "mesh: d.off:2: the number of vertices is missing or negative; after `OFF` write the "
            "numbers of vertices, faces and edges");
  EXPECT_EQ(complaint("a.ply", with(kPly, "face 4", "face 3")),
            "mesh: a.ply:17: the header counts 3 faces, but another line follows; mend the count");
  EXPECT_EQ(complaint("b.ply", with(kPly, "face 4", "face 1000000000")),
            "mesh: b.ply:17: the file ends after 4 of 1000000000 lines of element `face`; it is "
            "cut short: export it again");
  EXPECT_EQ(
      complaint("c.ply", with(binary_ply(), "face 4", "face 3")),
      "mesh: c.ply: 13 bytes follow the last of 3 faces; the count is wrong: export it again");
  EXPECT_EQ(complaint("d.ply", with(binary_ply(), "vertex 4", "vertex 900000000")),
            "mesh: d.ply: the file ends in number 8 of 900000000 of element `vertex`; it is cut "
            "short: export it again");
  EXPECT_EQ(complaint("e.ply", with(kPly, "vertex 4", "vertex 4e99")),
            "mesh: e.ply: line 3 of its header wants a count from 0 to 1e9; export it again");
}

TEST_F(BrokenSurfaces, numbers_that_are_none) {
  for (const std::string bad : {"nan", "inf", "-inf", "1e400", "0x1p3", "1.0D0", "one"}) {
    const std::string want =
        "a coordinate wants a finite number, got `" + bad + "`; write it like `12.5` or `1.25e1`";
    EXPECT_EQ(complaint("a.obj", with(kObj, "v 1 0 0", "v " + bad + " 0 0")),
              "mesh: a.obj:2:3: " + want);
    EXPECT_EQ(complaint("a.off", with(kOff, "1 0 0", "1 " + bad + " 0")),
              "mesh: a.off:4:3: " + want);
    EXPECT_EQ(complaint("a.stl", with(kStl, "vertex 0 1 0", "vertex 0 1 " + bad)),
              "mesh: a.stl:5:12: " + want);
    EXPECT_EQ(complaint("a.ply", with(kPly, "\n1 0 0", "\n" + bad + " 0 0")),
              "mesh: a.ply:11:1: `x` wants a finite number, got `" + bad +
                  "`; write it like `12.5` or `1.25e1`");
  }
  EXPECT_EQ(complaint("b.obj", with(kObj, "v 1 0 0", "v 1e39 0 0")),
            "mesh: b.obj:2:3: a coordinate wants single precision, got `1e39`; use a larger unit");
}

TEST_F(BrokenSurfaces, decimal_commas) {
  const std::string want = "a number has a comma; write decimal points, and blanks between numbers";
  EXPECT_EQ(complaint("a.obj", with(kObj, "v 1 0 0", "v 1,5 0 0")), "mesh: a.obj:2: " + want);
  EXPECT_EQ(complaint("a.off", with(kOff, "1 0 0", "1 0 0,5")), "mesh: a.off:4: " + want);
  EXPECT_EQ(complaint("a.stl", with(kStl, "vertex 0 1 0", "vertex 0 1,5 0")),
            "mesh: a.stl:5: " + want);
  EXPECT_EQ(complaint("a.ply", with(kPly, "\n1 0 0", "\n1,5 0 0")), "mesh: a.ply:11: " + want);
}

TEST_F(BrokenSurfaces, binary_numbers_that_are_none) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf}) {
    EXPECT_EQ(complaint("a.stl", with(binary_stl(), 84 + 50 + 12 + 4, bad)),
              "mesh: a.stl: facet 1 has a coordinate that is not a finite number; export the file "
              "again");
    const std::size_t body = binary_ply().find("end_header\n") + 11;
    EXPECT_EQ(complaint("a.ply", with(binary_ply(), body + 12, bad)),
              "mesh: a.ply: vertex 1 (counting from 0) has a coordinate that is not a finite "
              "number; export it again");
  }
}

TEST_F(BrokenSurfaces, vertices_that_are_not_there) {
  for (const std::string bad : {"5", "-5", "0"})
    EXPECT_EQ(complaint("a.obj", with(kObj, "f 1 2 4", "f 1 2 " + bad)),
              "mesh: a.obj:6: the face names vertex `" + std::string(bad == "-5" ? "0" : bad) +
                  "`, but the vertices run from 1 to 4; the file may be cut short: export it "
                  "again");
  EXPECT_EQ(complaint("b.obj", with(kObj, "f 1 2 4", "f 1 2 x/1")),
            "mesh: b.obj:6:7: a corner wants the number of a vertex, got `x/1`; write it like "
            "`12`, or `-1` for the last vertex so far");
  for (const std::string bad : {"4", "-1"}) {
    const std::string want = "the face names vertex `" + bad +
                             "`, but the vertices run from 0 to 3; the file may be cut short: "
                             "export it again";
    EXPECT_EQ(complaint("a.off", with(kOff, "3 0 1 3", "3 0 1 " + bad)), "mesh: a.off:8: " + want);
    EXPECT_EQ(complaint("a.ply", with(kPly, "3 0 1 3", "3 0 1 " + bad)), "mesh: a.ply:15: " + want);
  }
  const std::size_t last = binary_ply().size() - 4;
  for (const std::int32_t bad : {4, -1, std::numeric_limits<std::int32_t>::max()})
    EXPECT_EQ(complaint("b.ply", with(binary_ply(), last, bad)),
              "mesh: b.ply: face 3 (counting from 0) names vertex " + std::to_string(bad) +
                  ", but the vertices run from 0 to 3; export the file again");
}

TEST_F(BrokenSurfaces, negative_obj_numbers_are_good) {
  EXPECT_EQ(complaint("a.obj", with(kObj, "f 2 3 4", "f -3 -2 -1")), "sound");
}

TEST_F(BrokenSurfaces, faces_with_a_vertex_twice) {
  EXPECT_EQ(complaint("a.obj", with(kObj, "f 1 2 4", "f 1 2 2")),
            "mesh: a.obj:6: the face has vertex `2` twice; remove the face, or split it there");
  EXPECT_EQ(complaint("a.off", with(kOff, "3 0 1 3", "3 0 1 0")),
            "mesh: a.off:8: the face has vertex `0` twice; remove the face, or split it there");
  EXPECT_EQ(complaint("a.ply", with(kPly, "3 0 1 3", "3 0 1 0")),
            "mesh: a.ply: face 1 (counting from 0) has vertex 0 twice; remove the face, or split "
            "it there");
  const std::string want =
      "facet 1 (counting from 0) has two corners in one place; remove it or merge close vertices";
  EXPECT_EQ(complaint("a.stl", with(kStl, facet("0 0 0", "1 0 0", "0 0 1"),
                                    facet("0 0 0", "0 0 1", "-0 0 0"))),
            "mesh: a.stl:13: " + want);
  EXPECT_EQ(complaint("b.stl", with(binary_stl(), 84 + 50 + 12 + 12, 0.0F)),
            "mesh: b.stl: " + want);
}

TEST_F(BrokenSurfaces, faces_of_two_corners) {
  EXPECT_EQ(complaint("a.obj", with(kObj, "f 1 2 4", "f 1 2")),
            "mesh: a.obj:6: a face wants three corners or more, got 2; the file may be cut short: "
            "export it again");
  EXPECT_EQ(complaint("a.off", with(kOff, "3 0 1 3", "2 0 1")),
            "mesh: a.off:8: a face wants three corners or more, got 2; the file may be cut short: "
            "export it again");
  EXPECT_EQ(complaint("a.ply", with(kPly, "3 0 1 3", "2 0 1")),
            "mesh: a.ply:15: a face wants three corners or more, got 2; the file may be cut short: "
            "export it again");
  const std::size_t second = binary_ply().size() - 3 * 13;
  EXPECT_EQ(complaint("b.ply", with(binary_ply(), second, '\0')),
            "mesh: b.ply: face 1 (counting from 0) wants three corners or more, got 0; export the "
            "file again");
}

// A comb of three teeth.
TEST_F(BrokenSurfaces, a_polygon_that_no_corner_sees_whole) {
  EXPECT_EQ(complaint("a.off",
                      "OFF\n12 1 0\n0 0 0\n5 0 0\n5 5 0\n4 5 0\n4 1 0\n3 1 0\n3 5 0\n2 5 0\n"
                      "2 1 0\n1 1 0\n1 5 0\n0 5 0\n12 0 1 2 3 4 5 6 7 8 9 10 11\n"),
            "mesh: a.off: face 0 (counting from 0) is a polygon of 12 corners that cannot be cut "
            "into triangles from one of them; triangulate the surface in the program it comes "
            "from");
}

TEST_F(BrokenSurfaces, ply_headers) {
  const auto ply = [](const std::string& header) { return "ply\nformat ascii 1.0\n" + header; };
  EXPECT_EQ(complaint("a.ply", with(kPly, "ascii", "utf8")),
            "mesh: a.ply: has no known `format` in its header; write it as `ascii` or "
            "`binary_little_endian`");
  EXPECT_EQ(complaint("a.ply", with(kPly, "float y", "string y")),
            "mesh: a.ply: line 5 of its header is not understood; export it again");
  EXPECT_EQ(complaint("a.ply", with(kPly, "float y", "float w")),
            "mesh: a.ply: its vertices want `x`, `y` and `z` of type `float` or `double`; export "
            "it again");
  EXPECT_EQ(complaint("a.ply", with(kPly, "float y", "int y")),
            "mesh: a.ply: its vertices want `x`, `y` and `z` of type `float` or `double`; export "
            "it again");
  EXPECT_EQ(complaint("a.ply", with(kPly, "vertex_indices\n",
                                    "vertex_indices\nproperty list uchar float texcoord\n")),
            "mesh: a.ply: element `face` has a list `texcoord`; export it without texture and "
            "other extras");
  EXPECT_EQ(complaint("a.ply", ply("end_header\n")),
            "mesh: a.ply: its header wants an element `vertex` and an element `face`; export it "
            "again");
  EXPECT_EQ(complaint("a.ply", ply("element vertex 3\nelement face 1\nend_header\n")),
            "mesh: a.ply: element `vertex` has no property; export it again");
}

TEST_F(BrokenSurfaces, stl_lines_out_of_order) {
  EXPECT_EQ(complaint("a.stl", with(kStl, "endloop\n", "")),
            "mesh: a.stl:7: the line wants `endloop`, got `endfacet`; export the file again");
  EXPECT_EQ(complaint("a.stl", with(kStl, "vertex 0 1 0\n", "")),
            "mesh: a.stl:6: the line wants `vertex`, got `endloop`; export the file again");
}

TEST_F(BrokenSurfaces, obj_lines_that_go_on) {
  EXPECT_EQ(complaint("a.obj", with(kObj, "f 1 2 4", "f 1 2 \\\n4")),
            "mesh: a.obj:6: a line that goes on in the next one is not understood; write it as one "
            "line");
}

// What only the surface as a whole can tell.
TEST_F(BrokenSurfaces, read_well_but_not_sound) {
  EXPECT_NE(complaint("a.obj", with(kObj, "f 2 3 4\n", "")).find("is open: 3 edges in 1 hole"),
            std::string::npos);
  EXPECT_NE(complaint("a.obj", with(kObj, "f 2 3 4", "f 3 2 4")).find("face opposite sides"),
            std::string::npos);
  EXPECT_NE(complaint("a.obj", kObj + "f 2 3 4\n").find("faces 3 and 4 have the same vertices"),
            std::string::npos);
  EXPECT_NE(complaint("a.obj", with(kObj, "v 0 0 1", "v 0 0 -1")).find("is inside out"),
            std::string::npos);
  EXPECT_NE(complaint("a.obj", with(kObj, "v 0 0 1", "v 0 0 5000")).find("is 50 m long"),
            std::string::npos);
  EXPECT_NE(complaint("a.obj", with(kObj, "v 0 0 1", "v 0 0 1e-9")).find("has no area"),
            std::string::npos);
  EXPECT_NE(complaint("a.obj", with(kObj, "v 0 0 1", "v 1 0 0")).find("has vertex 2 twice"),
            std::string::npos)
      << complaint("a.obj", with(kObj, "v 0 0 1", "v 1 0 0"));
  EXPECT_NE(complaint("a.obj", kObj + "v 3 0 0\nv 4 0 0\nv 3 1 0\nv 3 0 1\nf 5 7 6\nf 5 6 8\n"
                                      "f 5 8 7\nf 6 7 8\n")
                .find("has 2 parts"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::geometry
