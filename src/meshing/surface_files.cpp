// Merges the vertices of the polygons that a file has, and cuts these into triangles.
#include "meshing/surface_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "base/text.h"
#include "meshing/cells.h"

namespace palpate::meshing {
namespace {

constexpr double most_items = 1e9;      // fits an int
constexpr std::size_t stl_header = 84;  // bytes: 80 of text, the number of facets
constexpr std::size_t stl_facet = 50;   // bytes: a normal, three corners, two spare ones

TableLines lines_of(const std::string& path, const char* format) {
  const std::string content = read_text(path);
  const std::size_t end = content.find_last_not_of('\0') + 1;  // zero bytes may follow
  if (!is_text(end == 0 ? content : content.substr(0, end)))
    fail(path, std::string("is not a text file in ") + format +
                   " format; export it again, or give it the ending of its real format");
  return TableLines(path);
}

// The words `first` to `first` + 2 as coordinates.
Vec3 point(const TableLines& lines, std::size_t first) {
  if (lines.words().size() < first + 3)
    lines.fail("a vertex wants three coordinates, got " +
               std::to_string(lines.words().size() - std::min(first, lines.words().size())) +
               "; the file may be cut short: export it again");
  no_comma(lines);
  Vec3 at;
  for (std::size_t axis = 0; axis < 3; ++axis)
    at[static_cast<Eigen::Index>(axis)] = lines.number(first + axis, "a coordinate");
  return at;
}

// Appends a facet with vertices of its own.
void add_facet(const std::array<Vec3, 3>& corners, Polygons& polygons) {
  const auto next = static_cast<int>(polygons.vertices.size());
  polygons.vertices.insert(polygons.vertices.end(), corners.begin(), corners.end());
  polygons.corners.push_back({next, next + 1, next + 2});
}

// Appends a face's corners, which count from `first`, among so many vertices.
void add_face(const TableLines& lines, std::vector<int>&& corners, int first, std::size_t vertices,
              Polygons& polygons) {
  const std::string wrong = wrong_corners("the face", corners, first, vertices);
  if (!wrong.empty()) lines.fail(wrong);
  for (int& corner : corners) corner -= first;
  polygons.corners.push_back(std::move(corners));
}

// `7`, `7/1`, `7//3` or `-1/-1/-1`: a vertex counted from 1, or backwards from the last one so far.
int obj_vertex(const TableLines& lines, std::size_t i, int vertices_so_far) {
  const std::string_view word = lines.words()[i];
  const auto number = whole_number(word.substr(0, word.find('/')));
  if (!number || std::trunc(*number) != *number || std::abs(*number) > most_items)
    lines.fail_at(i, "a corner wants the number of a vertex, got `" + std::string(word) +
                         "`; write it like `12`, or `-1` for the last vertex so far");
  const int vertex = static_cast<int>(*number);
  return vertex < 0 ? vertices_so_far + vertex + 1 : vertex;
}

Polygons obj(TableLines lines) {
  std::size_t vertices = 0;
  TableLines ahead = lines;  // a face may name a later vertex
  while (ahead.next_joined())
    if (ahead.words()[0] == "v") ++vertices;
  Polygons polygons;
  while (lines.next_joined()) {
    if (lines.words()[0] == "v") {
      polygons.vertices.push_back(point(lines, 1));
    } else if (lines.words()[0] == "f") {
      const std::size_t words = lines.words().size();
      if (words < 4) lines.fail(too_few_corners(words - 1));
      std::vector<int> corners;
      for (std::size_t i = 1; i < words; ++i)
        corners.push_back(obj_vertex(lines, i, static_cast<int>(polygons.vertices.size())));
      add_face(lines, std::move(corners), 1, vertices, polygons);
    }
  }
  return polygons;
}

std::size_t count(const TableLines& lines, std::size_t i, const std::string& what) {
  const int number = i < lines.words().size() ? lines.whole(i, what) : -1;
  if (number < 0)
    lines.fail(
        what +
        " is missing or negative; after `OFF` write the numbers of vertices, faces and edges");
  return as_index(number);
}

Polygons off(TableLines lines) {
  const bool found = lines.next();
  const std::string_view header = found ? lines.words()[0] : std::string_view();
  if (!header.ends_with("OFF") || header.find_first_of("4n") != std::string_view::npos)
    lines.fail(
        "the file wants to begin with `OFF`; export it again, or give it the ending of its real "
        "format");
  std::size_t at = 1;  // the counts may be in the line of `OFF` or in the next line
  if (lines.words().size() == 1) {
    at = 0;
    if (!lines.next()) lines.fail("the file ends after `OFF`; it is cut short: export it again");
  }
  const std::size_t vertices = count(lines, at, "the number of vertices");
  const std::size_t faces = count(lines, at + 1, "the number of faces");
  std::size_t following = 0;
  for (TableLines ahead = lines; ahead.next();) ++following;
  if (following != vertices + faces)
    lines.fail("the header counts " + std::to_string(vertices) + " vertices and " +
               std::to_string(faces) + " faces, but " + std::to_string(following) +
               " lines follow; mend the counts, or export the file again if it is cut short");
  Polygons polygons;
  for (std::size_t i = 0; i < vertices && lines.next(); ++i)
    polygons.vertices.push_back(point(lines, 0));
  for (std::size_t i = 0; i < faces && lines.next(); ++i) {
    const auto corners = as_index(std::max(0, lines.whole(0, "a corner count")));
    if (corners < 3 || lines.words().size() <= corners)
      lines.fail("a face wants three corners or more, got " +
                 std::to_string(std::min(corners, lines.words().size() - 1)) +
                 "; mend the line, or the counts of the header if this is a vertex");
    std::vector<int> corner;
    for (std::size_t c = 1; c <= corners; ++c) corner.push_back(lines.whole(c, "a corner"));
    add_face(lines, std::move(corner), 0, vertices, polygons);
  }
  return polygons;
}

// Normals and names are ignored.
Polygons ascii_stl(TableLines lines) {
  constexpr std::array<std::string_view, 7> keywords{"facet",  "outer",   "vertex",  "vertex",
                                                     "vertex", "endloop", "endfacet"};
  Polygons polygons;
  std::array<Vec3, 3> corners;
  std::size_t state = 0;
  bool open = false;  // between `solid` and `endsolid`
  while (lines.next()) {
    std::string keyword = lower_case(lines.words()[0]);
    if (keyword == "end" && lines.words().size() > 1)  // some programs write `end solid`
      keyword += lower_case(lines.words()[1]);
    if (state == 0 && keyword == (open ? "endsolid" : "solid")) {
      open = !open;
      continue;
    }
    if (!open || keyword != keywords[state])
      lines.fail("the line wants `" + std::string(open ? keywords[state] : "solid") + "`, got `" +
                 std::string(lines.words()[0]) + "`; export the file again");
    if (keyword == "vertex") corners[state - 2] = point(lines, 1);
    if (state == 4) add_facet(corners, polygons);
    state = (state + 1) % keywords.size();
  }
  if (open)
    lines.fail("the file ends before `endsolid`, in or after facet " +
               std::to_string(polygons.corners.size()) + "; it is cut short: export it again");
  return polygons;
}

Polygons binary_stl(const std::string& path, const std::string& content) {
  std::uint32_t facets = 0;
  if (content.size() >= stl_header)
    std::memcpy(&facets, content.data() + stl_header - sizeof(facets), sizeof(facets));
  if (content.size() != stl_header + stl_facet * facets)
    fail(path,
         "is neither an ASCII STL, which begins with `solid`, nor a binary one, which would have " +
             std::to_string(stl_header + stl_facet * facets) + " bytes for its " +
             std::to_string(facets) + " facets, not " + std::to_string(content.size()) +
             "; it is cut short or of another format: export it again");
  Polygons polygons;
  for (std::size_t facet = 0; facet < facets; ++facet) {
    std::array<std::array<float, 3>, 3> numbers{};
    // The normal, three floats, comes first.
    std::memcpy(numbers.data(), content.data() + stl_header + stl_facet * facet + 12,
                sizeof(numbers));
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = Eigen::Vector3f(numbers[i].data()).cast<double>();
      if (!corners[i].allFinite())
        fail(path, "facet " + std::to_string(facet) +
                       " has a coordinate that is not a finite number; export the file again");
    }
    add_facet(corners, polygons);
  }
  return polygons;
}

}  // namespace

void fail(const std::string& path, const std::string& message) {
  throw InputError({path}, message);
}

bool is_text(const std::string& content) {
  constexpr std::size_t longest_word = 200;  // outside of comments: ZBrush keeps colours there
  std::size_t word = 0;
  bool comment = false;
  for (const char letter : content) {
    const auto code = static_cast<unsigned char>(letter);
    if ((code < ' ' && (code < '\t' || code > '\r')) || code == 127) return false;
    comment = letter != '\n' && (comment || letter == '#');
    word = code <= ' ' ? 0 : word + 1;
    if (word > longest_word && !comment) return false;
  }
  return true;
}

void no_comma(const TableLines& lines) {
  const char* const first = lines.words().front().data();
  const char* const last = lines.words().back().data();  // in the same line
  const auto comma = std::string_view(first, as_index(last - first)).find(',');
  if (comma != std::string_view::npos)
    lines.fail("a number has a comma; write decimal points, and blanks between numbers");
}

std::string too_few_corners(std::size_t corners) {
  return "a face wants three corners or more, got " + std::to_string(corners) +
         "; the file may be cut short: export it again";
}

std::string wrong_corners(const std::string& face, const std::vector<int>& corners, int first,
                          std::size_t vertices) {
  const int last = static_cast<int>(vertices) + first - 1;
  for (const int corner : corners)
    if (corner < first || corner > last)
      return face + " names vertex `" + std::to_string(corner) + "`, but the vertices run from " +
             std::to_string(first) + " to " + std::to_string(last) +
             "; the file may be cut short: export it again";
  return "";
}

Polygons read_obj(const std::string& path) { return obj(lines_of(path, "OBJ")); }

Polygons read_off(const std::string& path) { return off(lines_of(path, "OFF")); }

Polygons read_stl(const std::string& path) {
  const std::string content = read_text(path);
  // Many binary files begin with `solid` too. Their facet count, if below 2^24, contains a zero
  // byte, which text does not.
  if (content.empty() || !is_text(content)) return binary_stl(path, content);
  return ascii_stl(lines_of(path, "STL"));
}

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
    throw KeyError("tissue.shape.file",
                   path +
                       ": holds solid cells; name it in `tissue.mesh` in place of "
                       "`tissue.shape`, as `mesh = { file = ..., unit = \"mm\" }`");
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
