// Checks OBJ, OFF and STL files, by lines or records. For PLY see surface_ply.cpp.
#include "meshing/surface_text.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "base/text.h"
#include "meshing/table_lines.h"

namespace palpate::meshing {
namespace {

using Point = std::array<float, 3>;

constexpr double most_items = 1e9;      // fits an int
constexpr std::size_t stl_header = 84;  // bytes: 80 of text, the number of facets
constexpr std::size_t stl_facet = 50;   // bytes: a normal, three corners, two spare ones

void expect_text(const std::string& path, const char* format) {
  if (!is_text(read_text(path)))
    fail(path, std::string("is not a text file in ") + format +
                   " format; export it again, or give it the ending of its real format");
}

// Reads the words `first` to `first` + 2 as coordinates and appends them to `content`.
Point point(const TableLines& lines, std::size_t first, std::string& content) {
  if (lines.words().size() < first + 3)
    lines.fail("a vertex wants three coordinates, got " +
               std::to_string(lines.words().size() - std::min(first, lines.words().size())) +
               "; the file may be cut short: export it again");
  no_comma(lines);
  Point at{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double value = lines.number(first + axis, "a coordinate");
    if (std::abs(value) > static_cast<double>(FLT_MAX))
      lines.fail_at(first + axis, "a coordinate wants single precision, got `" +
                                      std::string(lines.words()[first + axis]) +
                                      "`; use a larger unit");
    at[axis] = static_cast<float>(value);
    content += " " + number_text(value);
  }
  content += "\n";
  return at;
}

bool degenerate(const std::array<Point, 3>& corners) {
  return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
}

std::string two_in_one_place(std::size_t face) {
  return "facet " + std::to_string(face) +
         " (counting from 0) has two corners in one place; remove it or merge close vertices";
}

// Runs a pass over the lines. Mistakes in the content become MeshError.
template <typename Pass>
SurfaceText over_lines(const std::string& path, const char* format, const Pass& pass) {
  expect_text(path, format);
  TableLines lines(path);
  try {
    return pass(std::move(lines));
  } catch (const InputError& error) {
    throw MeshError(error.what());
  }
}

std::string corner_count(std::size_t corners) {
  return "a face wants three corners or more, got " + std::to_string(corners) +
         "; the file may be cut short: export it again";
}

// Appends a face's corners, which count from `first`; each must be an existing vertex, named once.
void add_face(const TableLines& lines, const std::vector<int>& corners, int first,
              SurfaceText& text) {
  const int last = static_cast<int>(text.vertices) + first - 1;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] < first || corners[i] > last)
      lines.fail("the face names vertex `" + std::to_string(corners[i]) +
                 "`, but the vertices run from " + std::to_string(first) + " to " +
                 std::to_string(last) + "; the file may be cut short: export it again");
    if (std::find(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(i), corners[i]) !=
        corners.begin() + static_cast<std::ptrdiff_t>(i))
      lines.fail("the face has vertex `" + std::to_string(corners[i]) +
                 "` twice; remove the face, or split it there");
    text.content += " " + std::to_string(corners[i]);
  }
  text.content += "\n";
  ++text.faces;
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

SurfaceText obj(TableLines lines) {
  SurfaceText text;
  TableLines ahead = lines;  // a face may name a later vertex
  while (ahead.next())
    if (ahead.words()[0] == "v") ++text.vertices;
  int vertices_so_far = 0;
  while (lines.next()) {
    if (lines.words().back().ends_with('\\'))
      lines.fail("a line that goes on in the next one is not understood; write it as one line");
    if (lines.words()[0] == "v") {
      text.content += "v";
      point(lines, 1, text.content);
      ++vertices_so_far;
    } else if (lines.words()[0] == "f") {
      const std::size_t words = lines.words().size();
      if (words < 4) lines.fail(corner_count(words - 1));
      std::vector<int> corners;
      for (std::size_t i = 1; i < words; ++i)
        corners.push_back(obj_vertex(lines, i, vertices_so_far));
      text.content += "f";
      add_face(lines, corners, 1, text);
    }
  }
  return text;
}

// Goes to item `i` of `count`.
void item(TableLines& lines, const std::string& what, std::size_t i, std::size_t count) {
  if (!lines.next())
    lines.fail("the file ends after " + std::to_string(i) + " of " + std::to_string(count) + " " +
               what + "; it is cut short: export it again");
}

std::size_t count(const TableLines& lines, std::size_t i, const std::string& what) {
  const int number = i < lines.words().size() ? lines.whole(i, what) : -1;
  if (number < 0)
    lines.fail(what +
               " is missing or negative; after `OFF` write the numbers of vertices, faces "
               "and edges");
  return as_index(number);
}

SurfaceText off(TableLines lines) {
  SurfaceText text;
  const bool found = lines.next();
  const std::string_view header = found ? lines.words()[0] : std::string_view();
  if (!header.ends_with("OFF") || header.find_first_of("4n") != std::string_view::npos)
    lines.fail(
        "the file wants to begin with `OFF`; export it again, or give it the ending of its "
        "real format");
  std::size_t at = 1;  // the counts may be in the line of `OFF` or in the next line
  if (lines.words().size() == 1) {
    at = 0;
    item(lines, "header lines", 1, 2);
  }
  text.vertices = count(lines, at, "the number of vertices");
  const std::size_t faces = count(lines, at + 1, "the number of faces");
  text.content = "OFF\n" + std::to_string(text.vertices) + " " + std::to_string(faces) + " 0\n";
  for (std::size_t i = 0; i < text.vertices; ++i) {
    item(lines, "vertices", i, text.vertices);
    point(lines, 0, text.content);
  }
  for (std::size_t i = 0; i < faces; ++i) {
    item(lines, "faces", i, faces);
    const auto corners = as_index(std::max(0, lines.whole(0, "a corner count")));
    if (corners < 3 || lines.words().size() <= corners)
      lines.fail(corner_count(std::min(corners, lines.words().size() - 1)));
    std::vector<int> corner;
    for (std::size_t c = 1; c <= corners; ++c) corner.push_back(lines.whole(c, "a corner"));
    text.content += std::to_string(corners);
    add_face(lines, corner, 0, text);
  }
  if (lines.next())
    lines.fail("the header counts " + std::to_string(text.vertices) + " vertices and " +
               std::to_string(faces) + " faces, but another line follows; mend the counts");
  return text;
}

// Normals and names are left out: OpenMesh takes any line containing `outer` for a facet.
SurfaceText ascii_stl(TableLines lines) {
  constexpr std::array<std::string_view, 7> keywords{"facet",  "outer",   "vertex",  "vertex",
                                                     "vertex", "endloop", "endfacet"};
  SurfaceText text;
  std::array<Point, 3> corners{};
  std::size_t state = 0;
  bool open = false;  // between `solid` and `endsolid`
  while (lines.next()) {
    const std::string keyword = lower_case(lines.words()[0]);
    if (state == 0 && keyword == (open ? "endsolid" : "solid")) {
      open = !open;
      continue;
    }
    if (!open || keyword != keywords[state])
      lines.fail("the line wants `" + std::string(open ? keywords[state] : "solid") + "`, got `" +
                 std::string(lines.words()[0]) + "`; export the file again");
    if (keyword == "vertex") {
      text.content += "vertex";
      corners[state - 2] = point(lines, 1, text.content);
      if (state == 4 && degenerate(corners)) lines.fail(two_in_one_place(text.faces));
    } else {
      text.content += keyword + "\n";
    }
    state = (state + 1) % keywords.size();
    if (state == 0) ++text.faces;
  }
  if (open)
    lines.fail("the file ends before `endsolid`, in or after facet " + std::to_string(text.faces) +
               "; it is cut short: export it again");
  return text;
}

SurfaceText binary_stl(const std::string& path, std::string&& content) {
  SurfaceText text;
  text.binary = true;
  std::uint32_t facets = 0;
  if (content.size() >= stl_header)
    std::memcpy(&facets, content.data() + stl_header - sizeof(facets), sizeof(facets));
  if (content.size() != stl_header + stl_facet * facets)
    fail(path,
         "is neither an ASCII STL, which begins with `solid`, nor a binary one, which would "
         "have " +
             std::to_string(stl_header + stl_facet * facets) + " bytes for its " +
             std::to_string(facets) + " facets, not " + std::to_string(content.size()) +
             "; it is cut short or of another format: export it again");
  for (text.faces = 0; text.faces < facets; ++text.faces) {
    std::array<Point, 3> corners{};
    // The normal, three floats, comes first.
    std::memcpy(corners.data(), content.data() + stl_header + stl_facet * text.faces + 12,
                sizeof(corners));
    for (const Point& corner : corners)
      for (const float coordinate : corner)
        if (!std::isfinite(coordinate))
          fail(path, "facet " + std::to_string(text.faces) +
                         " has a coordinate that is not a finite number; export the file again");
    if (degenerate(corners)) fail(path, two_in_one_place(text.faces));
  }
  text.content.swap(content);
  return text;
}

}  // namespace

void fail(const std::string& path, const std::string& message) {
  throw MeshError(path + ": " + message);
}

bool is_text(const std::string& content) {
  constexpr std::size_t longest_word = 200;
  std::size_t word = 0;
  for (const char letter : content) {
    const auto code = static_cast<unsigned char>(letter);
    if ((code < ' ' && (code < '\t' || code > '\r')) || code == 127) return false;
    word = code <= ' ' ? 0 : word + 1;
    if (word > longest_word) return false;
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

SurfaceText go_over_obj(const std::string& path) { return over_lines(path, "OBJ", obj); }

SurfaceText go_over_off(const std::string& path) { return over_lines(path, "OFF", off); }

SurfaceText go_over_stl(const std::string& path) {
  std::string content = read_text(path);
  // Many binary files begin with `solid` too. Their facet count, if below 2^24, contains a zero
  // byte, which text does not.
  if (content.empty() || !is_text(content)) return binary_stl(path, std::move(content));
  return over_lines(path, "STL", ascii_stl);
}

}  // namespace palpate::meshing
