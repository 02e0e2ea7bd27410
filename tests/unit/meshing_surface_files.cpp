// One surface in every format, unit and way of writing it; what is read over; quads; size.
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <locale>
#include <numbers>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "geometry/cuboid.h"
#include "meshing/surface_files.h"
#include "meshing/surface_repair.h"

namespace palpate::meshing {
namespace {

constexpr double mm = 1e-3;

// An egg with a mark, so that no axis can be taken for another; every format can hold its
// coordinates without rounding.
geometry::Surface egg(int rings, int sectors) {
  geometry::Surface surface;
  surface.vertices.emplace_back(0.1, 0.2, -7.3);
  for (int r = 1; r < rings; ++r)
    for (int s = 0; s < sectors; ++s) {
      const double theta = std::numbers::pi * r / rings;
      const double phi = 2.0 * std::numbers::pi * s / sectors;
      surface.vertices.emplace_back(3.0 * std::sin(theta) * std::cos(phi) + 0.1,
                                    4.0 * std::sin(theta) * std::sin(phi) + 0.2,
                                    -7.0 * std::cos(theta) - 0.3);
    }
  surface.vertices.emplace_back(0.1, 0.2, 6.7);
  const int last = static_cast<int>(surface.vertices.size()) - 1;
  const auto at = [&](int r, int s) { return 1 + (r - 1) * sectors + s % sectors; };
  for (int s = 0; s < sectors; ++s) surface.triangles.push_back({0, at(1, s + 1), at(1, s)});
  for (int r = 1; r + 1 < rings; ++r)
    for (int s = 0; s < sectors; ++s) {
      surface.triangles.push_back({at(r, s), at(r, s + 1), at(r + 1, s + 1)});
      surface.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r + 1, s)});
    }
  for (int s = 0; s < sectors; ++s)
    surface.triangles.push_back({last, at(rings - 1, s), at(rings - 1, s + 1)});
  for (Vec3& vertex : surface.vertices) vertex = vertex.cast<float>().cast<double>();
  return surface;
}

template <typename Number>
void put(std::string& bytes, Number number, bool big_endian = false) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof(Number));
  if (big_endian) std::reverse(std::begin(raw), std::end(raw));
  bytes.append(raw, sizeof(Number));
}

std::string xyz(const Vec3& p) {
  return number_text(p.x()) + " " + number_text(p.y()) + " " + number_text(p.z()) + "\n";
}

std::string ascii_stl(const geometry::Surface& surface) {
  std::string text = "solid outer_skin of an egg\n";
  for (const auto& triangle : surface.triangles) {
    text += "  facet normal nan nan nan\n    outer loop\n";
    for (const int v : triangle)
      text += "      vertex " + xyz(surface.vertices[static_cast<std::size_t>(v)]);
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid outer_skin of an egg\n";
}

std::string binary_stl(const geometry::Surface& surface) {
  std::string bytes = "solid to confuse";
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
  for (const auto& triangle : surface.triangles) {
    for (int i = 0; i < 3; ++i) put(bytes, 0.0F);
    for (const int v : triangle)
      for (int axis = 0; axis < 3; ++axis)
        put(bytes, static_cast<float>(surface.vertices[static_cast<std::size_t>(v)][axis]));
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string obj(const geometry::Surface& surface) {
  std::string text = "# an egg\nmtllib /dev/zero\no outer\nvt 0 0\nvn 0 0 1\nusemtl shell\n";
  for (const Vec3& vertex : surface.vertices) text += "v " + xyz(vertex);
  const auto count = static_cast<int>(surface.vertices.size());
  for (const auto& [a, b, c] : surface.triangles)  // every way to name a vertex
    text += "f " + std::to_string(a + 1) + "/1/1 " + std::to_string(b + 1) + "//1 " +
            std::to_string(c - count) + "\n";
  return text;
}

std::string off(const geometry::Surface& surface) {
  std::string text = "# an egg\nOFF " + std::to_string(surface.vertices.size()) + " " +
                     std::to_string(surface.triangles.size()) + " 0\n\n";
  for (const Vec3& vertex : surface.vertices) text += xyz(vertex);
  for (const auto& [a, b, c] : surface.triangles)
    text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) +
            " 255 0 0  # red\n";
  return text;
}

std::string ply_header(const geometry::Surface& surface, const std::string& format) {
  return "ply\nformat " + format + " 1.0\ncomment an egg # from above\nelement vertex " +
         std::to_string(surface.vertices.size()) +
         "\nproperty double x\nproperty float quality\nproperty double y\nproperty double z\n"
         "property uchar red\nelement face " +
         std::to_string(surface.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nproperty uchar flags\nend_header\n";
}

std::string ascii_ply(const geometry::Surface& surface) {
  std::string text = ply_header(surface, "ascii");
  for (const Vec3& p : surface.vertices)
    text += number_text(p.x()) + " 0.5 " + number_text(p.y()) + " " + number_text(p.z()) + " 255\n";
  for (const auto& [a, b, c] : surface.triangles)
    text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + " 7\n";
  return text;
}

std::string binary_ply(const geometry::Surface& surface, bool big_endian) {
  std::string bytes =
      ply_header(surface, big_endian ? "binary_big_endian" : "binary_little_endian");
  for (const Vec3& p : surface.vertices) {
    put(bytes, p.x(), big_endian);
    put(bytes, 0.5F, big_endian);
    put(bytes, p.y(), big_endian);
    put(bytes, p.z(), big_endian);
    put(bytes, std::uint8_t{255});
  }
  for (const auto& triangle : surface.triangles) {
    put(bytes, std::uint8_t{3});
    for (const int v : triangle) put(bytes, static_cast<std::int32_t>(v), big_endian);
    put(bytes, std::uint8_t{7});
  }
  return bytes;
}

class SurfaceFiles : public testing::Test {
 protected:
  SurfaceFiles() { std::filesystem::create_directories(folder_); }
  ~SurfaceFiles() override { std::filesystem::remove_all(folder_); }

  // Reads `content`, and sees that nothing is printed.
  [[nodiscard]] geometry::Surface read(const std::string& name, const std::string& content,
                                       double metres_per_unit = 1.0) const {
    const std::string path = (folder_ / name).string();
    write_atomically(path, content);
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    geometry::Surface surface;
    std::string error;
    try {
      surface = read_surface(path, metres_per_unit);
    } catch (const std::exception& caught) {
      error = caught.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(error, "");
    return surface;
  }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("palpate_surface_" + std::to_string(getpid()));
};

// The same triangles in the same order, corner by corner.
void expect_same(const geometry::Surface& got, const geometry::Surface& want,
                 double metres_per_unit) {
  ASSERT_EQ(got.triangles.size(), want.triangles.size());
  EXPECT_EQ(got.vertices.size(), want.vertices.size());
  for (std::size_t t = 0; t < want.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& g = got.vertices[static_cast<std::size_t>(got.triangles[t][i])];
      const Vec3 w =
          want.vertices[static_cast<std::size_t>(want.triangles[t][i])] * metres_per_unit;
      ASSERT_EQ(g, w) << t;
    }
}

struct Format {
  const char* name;
  std::function<std::string(const geometry::Surface&)> write;
};

const std::vector<Format> formats{
    {"ascii.stl", ascii_stl},
    {"binary.STL", binary_stl},
    {"egg.obj", obj},
    {"egg.Off", off},
    {"ascii.ply", ascii_ply},
    {"little.ply", [](const geometry::Surface& s) { return binary_ply(s, false); }},
    {"big.ply", [](const geometry::Surface& s) { return binary_ply(s, true); }}};

TEST_F(SurfaceFiles, every_format_and_unit_gives_the_same_surface) {
  const geometry::Surface want = egg(12, 17);
  for (const Format& format : formats)
    for (const double unit : {1e-3, 1e-2, 1.0}) {
      SCOPED_TRACE(format.name);
      const geometry::Surface got = read(format.name, format.write(want), unit);
      expect_same(got, want, unit);
      if (unit < 1.0) {
        EXPECT_NO_THROW(check_closed(got, format.name));
      }
    }
}

// Reading in the order of the faces' naming makes the formats agree in the numbers as well.
TEST_F(SurfaceFiles, every_format_gives_the_same_bits) {
  const geometry::Surface want = read("ascii.stl", ascii_stl(egg(5, 6)), mm);
  for (const Format& format : formats) {
    const geometry::Surface got = read(format.name, format.write(egg(5, 6)), mm);
    EXPECT_EQ(got.vertices, want.vertices) << format.name;
    EXPECT_EQ(got.triangles, want.triangles) << format.name;
  }
}

TEST_F(SurfaceFiles, numbers_keep_double_precision) {
  geometry::Surface want = egg(5, 6);
  for (Vec3& vertex : want.vertices) vertex /= 3.0;
  for (const Format& format : formats) {
    if (format.name == std::string("binary.STL")) continue;  // which has single precision
    SCOPED_TRACE(format.name);
    expect_same(read(format.name, format.write(want), mm), want, mm);
  }
}

TEST_F(SurfaceFiles, line_ends_of_other_systems_and_a_missing_last_one) {
  const geometry::Surface want = egg(4, 5);
  for (const auto& write : {ascii_stl, obj, off, ascii_ply}) {
    std::string text;
    for (const char letter : write(want)) {
      if (letter == '\n') text += '\r';
      text += letter;
    }
    text.resize(text.size() - 2);
    const char* name = text.starts_with("solid") ? "a.stl"
                       : text.starts_with("ply") ? "a.ply"
                       : text.find("OFF") < 20   ? "a.off"
                                                 : "a.obj";
    SCOPED_TRACE(name);
    expect_same(read(name, text), want, 1.0);
  }
}

TEST_F(SurfaceFiles, end_solid_may_be_two_words) {
  const geometry::Surface want = egg(4, 5);
  std::string text = ascii_stl(want);
  text.replace(text.find("endsolid"), 8, "end solid");
  expect_same(read("a.stl", text), want, 1.0);
}

// ZBrush ends its files with a zero byte, and keeps colours in comments.
TEST_F(SurfaceFiles, long_comments_and_zero_bytes_at_the_end_are_left_out) {
  const geometry::Surface want = egg(4, 5);
  expect_same(read("b.obj", "#MRGB " + std::string(512, 'f') + "\n" + obj(want)), want, 1.0);
  expect_same(read("a.obj", obj(want) + std::string(1, '\0')), want, 1.0);
  expect_same(read("a.off", off(want) + std::string(3, '\0')), want, 1.0);
}

struct Comma : std::numpunct<char> {
  [[nodiscard]] char do_decimal_point() const override { return ','; }
  [[nodiscard]] char do_thousands_sep() const override { return '.'; }
  [[nodiscard]] std::string do_grouping() const override { return "\3"; }
};

TEST_F(SurfaceFiles, the_locale_does_not_matter) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  for (const Format& format : formats) {
    SCOPED_TRACE(format.name);
    expect_same(read(format.name, format.write(egg(4, 5))), egg(4, 5), 1.0);
  }
  std::locale::global(before);
}

TEST_F(SurfaceFiles, tiny_coordinates_are_not_welded_together) {
  geometry::Surface want = egg(6, 7);
  for (Vec3& vertex : want.vertices) vertex *= 0x1p-30;
  for (const Format& format : formats) {
    SCOPED_TRACE(format.name);
    expect_same(read(format.name, format.write(want)), want, 1.0);
  }
}

// As exporters write them whose faces have vertices of their own.
TEST_F(SurfaceFiles, vertices_in_one_place_become_one) {
  const geometry::Surface want = egg(5, 6);
  geometry::Surface torn;
  for (const auto& triangle : want.triangles) {
    const auto first = static_cast<int>(torn.vertices.size());
    for (const int v : triangle)
      torn.vertices.push_back(want.vertices[static_cast<std::size_t>(v)]);
    torn.triangles.push_back({first, first + 1, first + 2});
  }
  expect_same(read("torn.off", off(torn)), want, 1.0);
  expect_same(read("torn.ply", binary_ply(torn, false)), want, 1.0);
}

TEST_F(SurfaceFiles, vertices_without_a_face_are_left_out) {
  const geometry::Surface surface =
      read("a.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 8 8 8\nv 0 1 0\nf 2 3 5\n");
  EXPECT_EQ(surface.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(surface.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}}));
}

TEST_F(SurfaceFiles, obj_vertices_may_follow_their_face) {
  EXPECT_EQ(read("a.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0").vertices.size(), 3u);
}

TEST_F(SurfaceFiles, squares_are_cut_in_two) {
  const std::string cube =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const geometry::Surface surface = read("cube.obj", cube, 1e-2);
  EXPECT_EQ(surface.triangles.size(), 12u);
  EXPECT_NO_THROW(check_closed(surface, "cube"));
  EXPECT_NEAR(geometry::enclosed(surface).volume, 1e-6,
              1e-15 * 1e-6 * 100);  // rounding of some 100 products
}

TEST_F(SurfaceFiles, a_dart_is_cut_from_its_hollow_corner) {
  const geometry::Surface surface =
      read("dart.off", "OFF\n4 1 0\n0 0 0\n2 1 0\n4 0 0\n2 5 0\n4 0 1 2 3\n");
  ASSERT_EQ(surface.triangles.size(), 2u);
  for (int t = 0; t < 2; ++t) EXPECT_GT(geometry::twice_area(surface, t).z(), 0.0);
  EXPECT_DOUBLE_EQ(geometry::area(surface), 8.0);
}

// Twice the area of the dart's hull is 16; no fan from one corner has all triangles turned alike.
TEST_F(SurfaceFiles, a_polygon_that_no_corner_sees_whole_is_cut_all_the_same) {
  const geometry::Surface surface =
      read("z.off", "OFF\n6 1 0\n0 0 0\n4 0 0\n1 1 0\n4 4 0\n0 4 0\n3 3 0\n6 0 1 2 3 4 5\n");
  ASSERT_EQ(surface.triangles.size(), 4u);
  double sum = 0.0;
  for (int t = 0; t < 4; ++t) sum += 0.5 * geometry::twice_area(surface, t).z();
  EXPECT_DOUBLE_EQ(sum, 4.0);  // what is folded over counts against it
}

TEST_F(SurfaceFiles, strips_are_triangles_turned_one_way) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
      "property float z\n";
  const std::string places = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
  const geometry::Surface ply = read(
      "a.ply", head + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                   places + "8 0 1 2 3 -1 2 3 4\n");
  ASSERT_EQ(ply.triangles.size(), 3u);
  for (int t = 0; t < 3; ++t) EXPECT_EQ(geometry::twice_area(ply, t).z(), 1.0);
  const geometry::Surface vtk = read("a.vtk",
                                     "# vtk DataFile Version 3.0\nstrips\nASCII\nDATASET POLYDATA\n"
                                     "POINTS 5 float\n" +
                                         places + "TRIANGLE_STRIPS 1 6\n5 0 1 2 3 4\n");
  ASSERT_EQ(vtk.triangles.size(), 3u);
  EXPECT_EQ(geometry::area(vtk), 1.5);
  for (int t = 0; t < 3; ++t) EXPECT_EQ(geometry::twice_area(vtk, t).z(), 1.0);
}

TEST_F(SurfaceFiles, a_hundred_thousand_faces) {
  const geometry::Surface want = egg(200, 251);
  ASSERT_GT(want.triangles.size(), 99000u);
  for (const Format& format : formats) {
    SCOPED_TRACE(format.name);
    const geometry::Surface got = read(format.name, format.write(want), mm);
    EXPECT_EQ(got.triangles.size(), want.triangles.size());
    if (format.name == std::string("egg.obj")) {
      EXPECT_NO_THROW(check_closed(got, "egg"));
    }
  }
}

}  // namespace
}  // namespace palpate::meshing
