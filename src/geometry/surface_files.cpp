// First our own look at the file, then OpenMesh in a child process, then what became of the counts.
#include "geometry/surface_files.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>

#include "base/error.h"
#include "geometry/child_process.h"
#include "geometry/openmesh_library.h"
#include "geometry/surface_text.h"

namespace palpate::geometry {
namespace {

using openmesh_library::Polygons;

constexpr ChildLimits limits{60.0, 8.0 * 1024 * 1024 * 1024};  // s, bytes: far beyond any need

template <typename Item>
void append(std::string& bytes, const Item* items, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(items), count * sizeof(Item));
}

// OpenMesh's opinion, the number of vertices, their coordinates; then each face's length and
// corners. Both ends are one program.
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

class Unpacking {
 public:
  explicit Unpacking(const std::string& bytes) : bytes_(bytes) {}

  template <typename Item>
  void take(Item* items, std::size_t count) {
    if (count > (bytes_.size() - at_) / sizeof(Item))
      throw MeshError("OpenMesh gave half an answer; run it again");
    if (count > 0) std::memcpy(items, bytes_.data() + at_, count * sizeof(Item));
    at_ += count * sizeof(Item);
  }
  [[nodiscard]] bool done() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

Polygons unpacked(const std::string& bytes) {
  Unpacking from(bytes);
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
    std::vector<int>& corners = polygons.corners.emplace_back();
    for (std::size_t c = 0; c < count; ++c) from.take(&corners.emplace_back(), 1);
  }
  return polygons;
}

// Corner `start` sees all others: the fan from there, none of whose triangles turns back.
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

  [[nodiscard]] Surface surface(double metres_per_unit) const {
    Surface surface;
    const std::vector<int> representative = welded();
    std::vector<int> number(polygons_.vertices.size(), -1);
    for (std::size_t f = 0; f < polygons_.corners.size(); ++f)
      for (std::array<int, 3> triangle : triangles(f)) {
        for (int& corner : triangle) {
          const int vertex = representative[static_cast<std::size_t>(corner)];
          int& own = number[static_cast<std::size_t>(vertex)];
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

  [[nodiscard]] const Vec3& at(int vertex) const {
    return polygons_.vertices[static_cast<std::size_t>(vertex)];
  }

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

  // The polygon need not be quite flat; no triangle may turn its back on the others.
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

  // The first vertex in each one's place. Zero and minus zero are one place.
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
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& letter : ending)
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
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

Surface read_surface(const std::string& path, double metres_per_unit) {
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

}  // namespace palpate::geometry
