// Checks PLY files, ASCII or binary of either byte order: the header against the data.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "base/text.h"
#include "meshing/surface_text.h"
#include "meshing/table_lines.h"

namespace palpate::meshing {
namespace {

struct Property {
  std::string name;
  std::size_t bytes = 0;        // of the value, or of each item of a list
  std::size_t count_bytes = 0;  // of a list's length; 0 if it is not a list
  bool whole = false;           // the value or the items are whole numbers

  [[nodiscard]] bool is_corners() const {
    return count_bytes > 0 && (name == "vertex_indices" || name == "vertex_index");
  }
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  std::string format;  // "ascii", "binary_little_endian" or "binary_big_endian"
  std::vector<Element> elements;
  std::size_t bytes = 0;  // including `end_header` and its line feed
};

std::size_t bytes_of(const std::string& type) {
  static const std::map<std::string, std::size_t> sizes{
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

bool is_whole(const std::string& type) {
  return type.find("int") != type.npos || type.find("char") != type.npos ||
         type.find("short") != type.npos;
}

// Parses `property float x` or `property list uchar int vertex_indices`; 0 bytes for anything else.
Property property(const std::vector<std::string>& words) {
  if (words.size() == 3) return {words[2], bytes_of(words[1]), 0, is_whole(words[1])};
  if (words.size() == 5 && words[1] == "list" && is_whole(words[2]))
    return {words[4], bytes_of(words[3]), bytes_of(words[2]), is_whole(words[3])};
  return {};
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  for (std::string& word : split(trimmed(line), ' '))
    if (!word.empty()) words.push_back(std::move(word));
  return words;
}

Header header(const std::string& path, std::string_view content) {
  Header header;
  for (int line = 1;; ++line) {
    const std::size_t end = content.find('\n', header.bytes);
    if (line == 1 && trimmed(content.substr(0, std::min<std::size_t>(end, 5))) != "ply")
      fail(path,
           "does not begin with `ply`; export it again, or give it the ending of its real "
           "format");
    if (end == std::string_view::npos)
      fail(path, "ends before `end_header`; it is cut short: export it again");
    const std::string_view text = content.substr(header.bytes, end - header.bytes);
    header.bytes = end + 1;
    const std::vector<std::string> words = words_of(text);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info" || line == 1) continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() == 3 && words[2] == "1.0") {
      header.format = words[1];
    } else if (words[0] == "element" && words.size() == 3) {
      const double count = whole_number(words[2]).value_or(-1.0);
      if (!(count >= 0.0 && count <= 1e9 && std::trunc(count) == count))
        fail(path, "line " + std::to_string(line) +
                       " of its header wants a count from 0 to 1e9; export it again");
      header.elements.push_back({words[1], static_cast<std::size_t>(count), {}});
    } else if (words[0] == "property" && !header.elements.empty() && property(words).bytes > 0) {
      header.elements.back().properties.push_back(property(words));
    } else {
      fail(path,
           "line " + std::to_string(line) + " of its header is not understood; export it again");
    }
  }
  return header;
}

// Requires what OpenMesh reads: vertices with x, y and z, then faces with a single list, the
// corners.
void check_header(const std::string& path, const Header& header, SurfaceText& text) {
  bool vertices = false;
  for (const Element& element : header.elements) {
    if (element.properties.empty())
      fail(path, "element `" + element.name + "` has no property; export it again");
    const auto has = [&](const char* name) {
      return std::any_of(
          element.properties.begin(), element.properties.end(),
          [&](const Property& p) { return p.name == name && p.count_bytes == 0 && !p.whole; });
    };
    std::size_t corners = 0;
    for (const Property& property : element.properties) {
      if (element.name == "face" && property.is_corners() && property.whole)
        ++corners;
      else if (property.count_bytes > 0)
        fail(path, "element `" + element.name + "` has a list `" + property.name +
                       "`; export it without texture and other extras");
    }
    if (element.name == "vertex") {
      if (!has("x") || !has("y") || !has("z"))
        fail(path,
             "its vertices want `x`, `y` and `z` of type `float` or `double`; export it again");
      text.vertices = element.count;
      vertices = true;
    }
    if (element.name == "face") {
      if (!vertices || corners != 1)
        fail(path,
             "wants vertices first and then faces with one list `vertex_indices`; export it "
             "again");
      text.faces = element.count;
      return;  // elements after the faces are not read
    }
  }
  fail(path, "its header wants an element `vertex` and an element `face`; export it again");
}

void ascii(TableLines lines, const Header& header, SurfaceText& text) {
  while (lines.next() && lines.words()[0] != "end_header") {
  }
  for (const Element& element : header.elements) {
    for (std::size_t i = 0; i < element.count; ++i) {
      if (!lines.next())
        lines.fail("the file ends after " + std::to_string(i) + " of " +
                   std::to_string(element.count) + " lines of element `" + element.name +
                   "`; it is cut short: export it again");
      no_comma(lines);
      std::size_t word = 0;
      for (const Property& property : element.properties) {
        if (word >= lines.words().size())
          lines.fail("the line ends before `" + property.name +
                     "`; the file may be cut short: export it again");
        if (!property.is_corners()) {
          const double value = lines.number(word++, "`" + property.name + "`");
          if (std::abs(value) > 3e38)
            lines.fail_at(word - 1,
                          "`" + property.name + "` wants single precision; use a larger unit");
          continue;
        }
        const auto corners = as_index(std::max(0, lines.whole(word++, "a corner count")));
        if (corners < 3 || lines.words().size() - word < corners)
          lines.fail("a face wants three corners or more, got " +
                     std::to_string(std::min(corners, lines.words().size() - word)) +
                     "; the file may be cut short: export it again");
        for (std::size_t c = 0; c < corners; ++c) {
          const int corner = lines.whole(word++, "a corner");
          if (corner < 0 || as_index(corner) >= text.vertices)
            lines.fail("the face names vertex `" + std::to_string(corner) +
                       "`, but the vertices run from 0 to " + std::to_string(text.vertices - 1) +
                       "; the file may be cut short: export it again");
        }
      }
      if (word != lines.words().size())
        lines.fail("the line has " + std::to_string(lines.words().size()) +
                   " words, but its properties make " + std::to_string(word) +
                   "; export the file again");
    }
    if (element.name == "face") break;
  }
  if (header.elements.back().name == "face" && lines.next())
    lines.fail("the header counts " + std::to_string(text.faces) +
               " faces, but another line follows; mend the count");
}

std::size_t list_length(const char* bytes, std::size_t count, bool big_endian) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value = value * 256 + static_cast<unsigned char>(bytes[big_endian ? i : count - 1 - i]);
  return value;
}

void binary(const std::string& path, const std::string& content, const Header& header) {
  const bool big_endian = header.format == "binary_big_endian";
  std::size_t at = header.bytes;
  for (const Element& element : header.elements) {
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        std::size_t items = 1;
        if (property.count_bytes > 0 && at + property.count_bytes <= content.size()) {
          items = list_length(content.data() + at, property.count_bytes, big_endian);
          at += property.count_bytes;
          if (items < 3)
            fail(path, "face " + std::to_string(i) +
                           " (counting from 0) wants three corners or "
                           "more, got " +
                           std::to_string(items) + "; export the file again");
        }
        at += items * property.bytes;
        if (at > content.size())
          fail(path, "the file ends in number " + std::to_string(i) + " of " +
                         std::to_string(element.count) + " of element `" + element.name +
                         "`; it is cut short: export it again");
      }
    }
    if (element.name != "face") continue;
    if (&element == &header.elements.back() && at != content.size())
      fail(path, std::to_string(content.size() - at) + " bytes follow the last of " +
                     std::to_string(element.count) + " faces; the count is wrong: export it again");
    return;
  }
}

}  // namespace

SurfaceText go_over_ply(const std::string& path) {
  SurfaceText text;
  text.content = read_text(path);
  const Header found = header(path, text.content);
  if (!is_text(text.content.substr(0, found.bytes)))
    fail(path, "its header is not text; export it again");
  check_header(path, found, text);
  if (found.format == "ascii") {
    if (!is_text(text.content))
      fail(path, "is not a text file, though its header says `ascii`; export it again");
    try {
      ascii(TableLines(path), found, text);
    } catch (const InputError& error) {
      throw MeshError(error.what());
    }
  } else if (found.format == "binary_little_endian" || found.format == "binary_big_endian") {
    text.binary = true;
    binary(path, text.content, found);
  } else {
    fail(path,
         "has no known `format` in its header; write it as `ascii` or `binary_little_endian`");
  }
  return text;
}

}  // namespace palpate::meshing
