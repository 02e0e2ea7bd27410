// A corner of a cube in every surface format, to be broken in one place or another, and the
// verdict.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "meshing/mesh_check.h"
#include "meshing/surface_files.h"
#include "meshing/surface_repair.h"

namespace palpate::meshing {

// A corner of a cube of 1 cm in each format: vertex 0 in the origin, the others on the axes.
inline const std::string good_obj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
inline const std::string good_off =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
inline const std::string good_ply_header =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n";
inline const std::string good_ply =
    "ply\nformat ascii 1.0\n" + good_ply_header +
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
inline const std::array<std::array<float, 3>, 4> corner_points{
    {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}}};
inline const std::array<std::array<std::int32_t, 3>, 4> corner_faces{
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

inline std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 1\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
         "\nendloop\nendfacet\n";
}

inline const std::string good_stl =
    "solid paw\n" + facet("0 0 0", "0 1 0", "1 0 0") + facet("0 0 0", "1 0 0", "0 0 1") +
    facet("0 0 0", "0 0 1", "0 1 0") + facet("1 0 0", "0 1 0", "0 0 1") + "endsolid paw\n";

template <typename Item>
void put(std::string& bytes, const Item& item) {
  bytes.append(reinterpret_cast<const char*>(&item), sizeof(item));
}

inline std::string binary_stl(std::uint32_t count = 4) {
  std::string bytes(80, ' ');
  put(bytes, count);
  for (const auto& face : corner_faces) {
    bytes.append(12, '\0');
    for (const std::int32_t v : face) put(bytes, corner_points[static_cast<std::size_t>(v)]);
    bytes.append(2, '\0');
  }
  return bytes;
}

inline std::string binary_ply() {
  std::string bytes = "ply\nformat binary_little_endian 1.0\n" + good_ply_header;
  for (const auto& point : corner_points) put(bytes, point);
  for (const auto& face : corner_faces) {
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

inline std::string with(std::string text, const std::string& old, const std::string& fresh) {
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
      const geometry::Surface surface = read_surface(path(name), 1e-2);
      refuse_size(surface.vertices, "surface `paw`", "cm", "tissue.shape.unit");
      check_closed(surface, "paw");
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

}  // namespace palpate::meshing
