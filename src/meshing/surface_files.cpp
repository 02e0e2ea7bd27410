// Checks the file, reads it with OpenMesh in a child process, and compares the counts.
#include "meshing/surface_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "meshing/child_bytes.h"
#include "meshing/child_process.h"
#include "meshing/openmesh_library.h"
#include "meshing/surface_text.h"

namespace palpate::meshing {
namespace {

using openmesh_library::Polygons;

constexpr ChildLimits limits{60.0, 8.0 * 1024 * 1024 * 1024};  // s, bytes: far above any need

// OpenMesh's success flag, the number of vertices, their coordinates; then each face's number of
// corners and corners.
std::string packed(const Polygons& polygons) {
  std::string bytes(1, polygons.good ? '1' : '0');
  const std::size_t vertices = polygons.vertices.size();
  append(bytes, &vertices, 1);
  for (const Vec3& vertex : polygons.vertices) append(bytes, vertex.data(), 3);
  for (const std::vector<int>& corners : polygons.corners) {
    const std::size_t count = corners.size();
    append(bytes, &count, 1);
    append(bytes, corners.data(), count);
  }
  return bytes;
}

Polygons unpacked(const std::string& bytes) {
  ChildBytes from(bytes, "OpenMesh");
  Polygons polygons;
  char good = '0';
  from.take(&good, 1);
  polygons.good = good == '1';
  std::size_t vertices = 0;
  from.take(&vertices, 1);
  for (std::size_t v = 0; v < vertices; ++v) from.take(polygons.vertices.emplace_back().data(), 3);
  while (!from.done()) {
    std::size_t count = 0;
    from.take(&count, 1);
    from.take(polygons.corners.emplace_back(), count);
  }
  return polygons;
}

// The triangles of a polygon from its corner `start`.
std::vector<std::array<int, 3>> fan(const std::vector<int>& corners, std::size_t start) {
  std::vector<std::array<int, 3>> triangles;
  const std::size_t n = corners.size();
  for (std::size_t i = 1; i + 1 < n; ++i)
    triangles.push_back({corners[start], corners[(start + i) % n], corners[(start + i + 1) % n]});
  return triangles;
}

class Reading {
 public:
  Reading(const std::string& path, const Polygons& polygons) : path_(path), polygons_(polygons) {}

  void check(const SurfaceText& text, bool stl) const {
    if (text.faces == 0) fail("holds no faces; export the surface again");
    if (!polygons_.good || polygons_.corners.size() != text.faces ||
        (!stl && polygons_.vertices.size() != text.vertices))
      fail("OpenMesh read " + std::to_string(polygons_.vertices.size()) + " of " +
           std::to_string(text.vertices) + " vertices and " +
           std::to_string(polygons_.corners.size()) + " of " + std::to_string(text.faces) +
           " faces; export the file again, or in another format");
    for (std::size_t v = 0; v < polygons_.vertices.size(); ++v)
      if (!polygons_.vertices[v].allFinite())
        fail("vertex " + std::to_string(v) +
             " (counting from 0) has a coordinate that is not a finite number; export it again");
    for (std::size_t f = 0; f < polygons_.corners.size(); ++f) face(f);
  }

  [[nodiscard]] geometry::Surface surface(double metres_per_unit) const {
    geometry::Surface surface;
    const std::vector<int> representative = welded();
    std::vector<int> number(polygons_.vertices.size(), -1);
    for (std::size_t f = 0; f < polygons_.corners.size(); ++f)
      for (std::array<int, 3> triangle : triangles(f)) {
        for (int& corner : triangle) {
          const int vertex = representative[as_index(corner)];
          int& own = number[as_index(vertex)];
          if (own < 0) {
            own = static_cast<int>(surface.vertices.size());
            surface.vertices.push_back(at(vertex) * metres_per_unit);
          }
          corner = own;
        }
        surface.triangles.push_back(triangle);
      }
    return surface;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw MeshError(path_ + ": " + what); }

  [[nodiscard]] const Vec3& at(int vertex) const { return polygons_.vertices[as_index(vertex)]; }

  void face(std::size_t f) const {
    const auto last = static_cast<int>(polygons_.vertices.size()) - 1;
    std::vector<int> sorted = polygons_.corners[f];
    std::sort(sorted.begin(), sorted.end());
    for (const int corner : sorted)
      if (corner < 0 || corner > last)
        fail("face " + std::to_string(f) + " (counting from 0) names vertex " +
             std::to_string(corner) + ", but the vertices run from 0 to " + std::to_string(last) +
             "; export the file again");
    const auto twin = std::adjacent_find(sorted.begin(), sorted.end());
    if (twin != sorted.end())
      fail("face " + std::to_string(f) + " (counting from 0) has vertex " + std::to_string(*twin) +
           " twice; remove the face, or split it there");
  }

  // The polygon may be slightly non-planar, but every triangle must have its orientation.
  [[nodiscard]] std::vector<std::array<int, 3>> triangles(std::size_t f) const {
    const std::vector<int>& corners = polygons_.corners[f];
    if (corners.size() == 3) return fan(corners, 0);
    const auto normal = [&](const std::array<int, 3>& t) {
      return Vec3((at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])));
    };
    Vec3 mean = Vec3::Zero();
    for (const auto& triangle : fan(corners, 0)) mean += normal(triangle);
    for (std::size_t start = 0; start < corners.size(); ++start) {
      auto tried = fan(corners, start);
      if (std::all_of(tried.begin(), tried.end(),
                      [&](const auto& triangle) { return normal(triangle).dot(mean) > 0.0; }))
        return tried;
    }
    fail("face " + std::to_string(f) + " (counting from 0) is a polygon of " +
         std::to_string(corners.size()) +
         " corners that cannot be cut into triangles from one of them; triangulate the surface in "
         "the program it comes from");
  }

  // For each vertex, the first one with equal coordinates (0 and -0 are equal).
  [[nodiscard]] std::vector<int> welded() const {
    std::map<std::array<double, 3>, int> first;
    std::vector<int> representative;
    for (const Vec3& vertex : polygons_.vertices)
      representative.push_back(first
                                   .try_emplace({vertex.x(), vertex.y(), vertex.z()},
                                                static_cast<int>(representative.size()))
                                   .first->second);
    return representative;
  }

  const std::string& path_;
  const Polygons& polygons_;
};

std::string format_of(const std::string& path) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  for (const char* known : {".stl", ".obj", ".ply", ".off"})
    if (ending == known) return ending.substr(1);
  throw InputError({path, 0, 0},
                   "a surface wants the ending `.stl`, `.obj`, `.ply` or `.off`; export it as one "
                   "of these");
}

SurfaceText go_over(const std::string& path, const std::string& format) {
  if (format == "stl") return go_over_stl(path);
  if (format == "obj") return go_over_obj(path);
  if (format == "ply") return go_over_ply(path);
  return go_over_off(path);
}

}  // namespace

geometry::Surface read_surface(const std::string& path, double metres_per_unit) {
  const std::string format = format_of(path);
  const SurfaceText text = go_over(path, format);
  const ChildResult result = run_in_child(
      [&] { return packed(openmesh_library::run(text.content, format, text.binary)); }, limits);
  const auto* answer = std::get_if<ChildAnswer>(&result);
  if (answer == nullptr)
    throw MeshError(path + ": OpenMesh could not read it; export it again, or in another format");
  const Polygons polygons = unpacked(answer->bytes);
  const Reading reading(path, polygons);
  reading.check(text, format == "stl");
  return reading.surface(metres_per_unit);
}

}  // namespace palpate::meshing
