// Merges the vertices of the polygons that a file has, and cuts these into triangles.
#include "meshing/surface_files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "meshing/cells.h"
#include "meshing/surface_text.h"

namespace palpate::meshing {
namespace {

// The triangles of a polygon from its corner `start`.
std::vector<std::array<int, 3>> fan(const std::vector<int>& corners, std::size_t start) {
  std::vector<std::array<int, 3>> triangles;
  const std::size_t n = corners.size();
  for (std::size_t i = 1; i + 1 < n; ++i)
    triangles.push_back({corners[start], corners[(start + i) % n], corners[(start + i + 1) % n]});
  return triangles;
}

// A polygon as triangles, from the corner from which they lie flattest. A polygon that is far from
// plane or hollow is folded by that; where its triangles cut others, they are mended with them.
std::vector<std::array<int, 3>> triangles(const Polygons& polygons,
                                          const std::vector<int>& corners) {
  if (corners.size() == 3) return fan(corners, 0);
  const auto at = [&](int vertex) -> const Vec3& { return polygons.vertices[as_index(vertex)]; };
  const auto normal = [&](const std::array<int, 3>& t) {
    return Vec3((at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])));
  };
  Vec3 mean = Vec3::Zero();
  for (const auto& triangle : fan(corners, 0)) mean += normal(triangle);
  std::vector<std::array<int, 3>> best;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t start = 0; start < corners.size() && most <= 0.0; ++start) {
    auto tried = fan(corners, start);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& triangle : tried) least = std::min(least, normal(triangle).dot(mean));
    if (best.empty() || least > most) {
      most = least;
      best = std::move(tried);
    }
  }
  return best;
}

// For each vertex, the first one with equal coordinates (0 and -0 are equal).
std::vector<int> welded(const std::vector<Vec3>& vertices) {
  std::map<std::array<double, 3>, int> first;
  std::vector<int> representative;
  for (const Vec3& vertex : vertices)
    representative.push_back(first
                                 .try_emplace({vertex.x(), vertex.y(), vertex.z()},
                                              static_cast<int>(representative.size()))
                                 .first->second);
  return representative;
}

std::string format_of(const std::string& path) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  for (const char* known : {".stl", ".obj", ".ply", ".off"})
    if (ending == known) return ending.substr(1);
  if (holds_cells(path)) return "cells";
  throw InputError({path, 0, 0},
                   "a surface wants the ending `.stl`, `.obj`, `.ply`, `.off`, `.vtp`, `.vtu`, "
                   "`.vtk`, `.msh`, `.inp` or `.mesh`; export it as one of these");
}

Polygons faces_in(const std::string& path) {
  Cells cells = read_cells(path);
  if (!cells.solids.empty())
    throw InputError({path},
                     "holds solid cells; name it in `tissue.mesh` in place of `tissue.shape`");
  for (std::size_t f = 0; f < cells.faces.size(); ++f) {
    const std::string wrong =
        wrong_corners("face " + std::to_string(f), cells.faces[f], 0, cells.nodes.size());
    if (!wrong.empty()) fail(path, wrong);
  }
  return {std::move(cells.nodes), std::move(cells.faces)};
}

Polygons polygons_of(const std::string& path, const std::string& format) {
  if (format == "cells") return faces_in(path);
  if (format == "stl") return read_stl(path);
  if (format == "obj") return read_obj(path);
  if (format == "ply") return read_ply(path);
  return read_off(path);
}

}  // namespace

geometry::Surface read_surface(const std::string& path, double metres_per_unit) {
  const Polygons polygons = polygons_of(path, format_of(path));
  if (polygons.corners.empty()) fail(path, "holds no faces; export the surface again");
  const std::vector<int> representative = welded(polygons.vertices);
  std::vector<int> number(polygons.vertices.size(), -1);
  geometry::Surface surface;
  for (const std::vector<int>& corners : polygons.corners)
    for (std::array<int, 3> triangle : triangles(polygons, corners)) {
      for (int& corner : triangle) {
        const auto vertex = as_index(representative[as_index(corner)]);
        if (number[vertex] < 0) {
          number[vertex] = static_cast<int>(surface.vertices.size());
          surface.vertices.push_back(polygons.vertices[vertex] * metres_per_unit);
        }
        corner = number[vertex];
      }
      surface.triangles.push_back(triangle);
    }
  return surface;
}

void write_surface(const std::string& path, const geometry::Surface& surface,
                   double metres_per_unit) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  if (ending != ".off" && ending != ".stl")
    throw InputError({path}, "a surface is written as `.off` or `.stl`; give one of these endings");
  std::string text;
  if (ending == ".off") {
    text = "OFF\n" + std::to_string(surface.vertices.size()) + " " +
           std::to_string(surface.triangles.size()) + " 0\n";
    for (const Vec3& vertex : surface.vertices)
      text += number_text(vertex.x() / metres_per_unit) + " " +
              number_text(vertex.y() / metres_per_unit) + " " +
              number_text(vertex.z() / metres_per_unit) + "\n";
    for (const auto& [a, b, c] : surface.triangles)
      text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  } else {
    const auto put = [&](const auto& value) {
      text.append(reinterpret_cast<const char*>(&value), sizeof(value));
    };
    text.assign(80, ' ');
    put(static_cast<std::uint32_t>(surface.triangles.size()));
    for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
      const Vec3 normal = geometry::twice_area(surface, t).normalized();
      for (int axis = 0; axis < 3; ++axis) put(static_cast<float>(normal[axis]));
      for (const int vertex : surface.triangles[as_index(t)])
        for (int axis = 0; axis < 3; ++axis)
          put(static_cast<float>(surface.vertices[as_index(vertex)][axis] / metres_per_unit));
      put(std::uint16_t{0});
    }
  }
  write_atomically(path, text);
}

}  // namespace palpate::meshing
