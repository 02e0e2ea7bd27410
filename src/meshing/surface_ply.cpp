// Reads PLY files, ASCII or binary of either byte order.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "base/text.h"
#include "meshing/binary_numbers.h"
#include "meshing/cells.h"
#include "meshing/surface_files.h"
#include "meshing/table_lines.h"

namespace palpate::meshing {
namespace {

using Type = NumberType;

constexpr std::array types{
    number_type<std::int8_t>("char", "int8"),    number_type<std::uint8_t>("uchar", "uint8"),
    number_type<std::int16_t>("short", "int16"), number_type<std::uint16_t>("ushort", "uint16"),
    number_type<std::int32_t>("int", "int32"),   number_type<std::uint32_t>("uint", "uint32"),
    number_type<float>("float", "float32"),      number_type<double>("double", "float64")};

const Type* type_of(std::string_view word) { return type_named(types, word); }

struct Property {
  std::string name;
  const Type* type = nullptr;    // of the value, or of each item of a list; null if unknown
  const Type* length = nullptr;  // of a list's length; null if it is not a list

  [[nodiscard]] bool is_corners() const {
    return length != nullptr && (name == "vertex_indices" || name == "vertex_index");
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

// Parses `property float x` or `property list uchar int vertex_indices`; no type for anything else.
Property property(const std::vector<std::string>& words) {
  if (words.size() == 3) return {words[2], type_of(words[1]), nullptr};
  if (words.size() != 5 || words[1] != "list") return {};
  const Type* const length = type_of(words[2]);
  if (length == nullptr || !length->whole) return {};
  return {words[4], type_of(words[3]), length};
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
           "does not begin with `ply`; export it again, or give it the ending of its real format");
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
    } else if (words[0] == "property" && !header.elements.empty() &&
               property(words).type != nullptr) {
      header.elements.back().properties.push_back(property(words));
    } else {
      fail(path,
           "line " + std::to_string(line) + " of its header is not understood; export it again");
    }
  }
  return header;
}

// Requires vertices with x, y and z, then faces with a single list, the corners. Returns the
// elements up to the faces.
std::span<const Element> needed(const std::string& path, const Header& header) {
  bool vertices = false;
  for (std::size_t i = 0; i < header.elements.size(); ++i) {
    const Element& element = header.elements[i];
    if (element.properties.empty())
      fail(path, "element `" + element.name + "` has no property; export it again");
    const auto has = [&](const char* name) {
      return std::ranges::any_of(element.properties, [&](const Property& p) {
        return p.name == name && !p.length && !p.type->whole;
      });
    };
    std::size_t corners = 0;
    const bool faces = element.name == "face" || element.name == "tristrips";
    for (const Property& property : element.properties) {
      if (faces && property.is_corners() && property.type->whole) ++corners;
    }
    if (element.name == "vertex") {
      if (!has("x") || !has("y") || !has("z"))
        fail(path,
             "its vertices want `x`, `y` and `z` of type `float` or `double`; export it again");
      vertices = true;
    }
    if (faces) {
      if (!vertices || corners != 1)
        fail(path,
             "wants vertices first and then faces with one list `vertex_indices`; export it again");
      return std::span(header.elements).first(i + 1);
    }
  }
  fail(path, "its header wants an element `vertex` and an element `face`; export it again");
}

// The numbers of an ASCII file, line by line.
class AsciiBody {
 public:
  explicit AsciiBody(const std::string& path) : lines_(path) {
    while (lines_.next() && lines_.words()[0] != "end_header") {
    }
  }

  void begin(const Element& element, std::size_t i) {
    if (!lines_.next())
      lines_.fail("the file ends after " + std::to_string(i) + " of " +
                  std::to_string(element.count) + " lines of element `" + element.name +
                  "`; it is cut short: export it again");
    no_comma(lines_);
    word_ = 0;
  }
  double number(const Property& property) {
    require(property);
    return lines_.number(word_++, "`" + property.name + "`");
  }
  void corners(const Property& property, std::vector<int>& corners) {
    require(property);
    const auto count = as_index(std::max(0, lines_.whole(word_++, "a corner count")));
    const std::size_t left = lines_.words().size() - word_;
    if (count < 3 || left < count) lines_.fail(too_few_corners(std::min(count, left)));
    for (std::size_t c = 0; c < count; ++c) corners.push_back(lines_.whole(word_++, "a corner"));
  }
  void pass_over(const Property& property) {
    require(property);
    const auto count = as_index(std::max(0, lines_.whole(word_++, "a count")));
    if (lines_.words().size() - word_ < count)
      lines_.fail("the line ends in list `" + property.name +
                  "`; the file may be cut short: export it again");
    word_ += count;
  }
  void end() const {
    if (word_ != lines_.words().size())
      lines_.fail("the line has " + std::to_string(lines_.words().size()) +
                  " words, but its properties make " + std::to_string(word_) +
                  "; export the file again");
  }
  void end_of_file(std::size_t faces) {
    if (lines_.next())
      lines_.fail("the header counts " + std::to_string(faces) +
                  " faces, but another line follows; mend the count");
  }
  [[nodiscard]] std::string face(std::size_t) const { return "the face"; }
  [[noreturn]] void fail(const std::string& message) const { lines_.fail(message); }

 private:
  void require(const Property& property) const {
    if (word_ >= lines_.words().size())
      lines_.fail("the line ends before `" + property.name +
                  "`; the file may be cut short: export it again");
  }

  TableLines lines_;
  std::size_t word_ = 0;  // the next one
};

// The numbers of a binary file.
class BinaryBody {
 public:
  BinaryBody(const std::string& path, const std::string& content, std::size_t at, bool big_endian)
      : path_(path), content_(content), at_(at), big_endian_(big_endian) {}

  void begin(const Element& element, std::size_t i) {
    element_ = &element;
    i_ = i;
  }
  double number(const Property& property) { return next(*property.type); }
  void corners(const Property& property, std::vector<int>& corners) {
    const double count = next(*property.length);
    if (count < 3.0)
      fail(face(i_) + " wants three corners or more, got " + number_text(count) +
           "; export the file again");
    for (double c = 0.0; c < count; ++c)  // a number beyond an int names no vertex
      corners.push_back(static_cast<int>(std::min(next(*property.type), 2147483647.0)));
  }
  void pass_over(const Property& property) {
    for (double left = next(*property.length); left > 0.0; --left) (void)next(*property.type);
  }
  void end() const {}
  void end_of_file(std::size_t faces) const {
    if (at_ != content_.size())
      fail(std::to_string(content_.size() - at_) + " bytes follow the last of " +
           std::to_string(faces) + " faces; the count is wrong: export it again");
  }
  [[nodiscard]] std::string face(std::size_t i) const {
    return "face " + std::to_string(i) + " (counting from 0)";
  }
  [[noreturn]] void fail(const std::string& message) const { meshing::fail(path_, message); }

 private:
  double next(const Type& type) {
    if (content_.size() - at_ < type.bytes)
      fail("the file ends in number " + std::to_string(i_) + " of " +
           std::to_string(element_->count) + " of element `" + element_->name +
           "`; it is cut short: export it again");
    at_ += type.bytes;
    return type.read(content_.data() + at_ - type.bytes, big_endian_);
  }

  const std::string& path_;
  const std::string& content_;
  std::size_t at_;
  bool big_endian_;
  const Element* element_ = nullptr;
  std::size_t i_ = 0;
};

template <class Body>
Polygons polygons(Body&& body, std::span<const Element> elements, bool ends_with_faces) {
  Polygons found;
  const auto take = [&](std::vector<int> corners, std::size_t i) {
    const std::string wrong = wrong_corners(body.face(i), corners, 0, found.vertices.size());
    if (!wrong.empty()) body.fail(wrong);
    found.corners.push_back(std::move(corners));
  };
  for (const Element& element : elements) {
    const bool strips = element.name == "tristrips";
    const bool faces = strips || element.name == "face";
    for (std::size_t i = 0; i < element.count; ++i) {
      body.begin(element, i);
      Vec3 vertex = Vec3::Zero();
      std::vector<int> corners;
      for (const Property& property : element.properties) {
        if (faces && property.is_corners()) {
          body.corners(property, corners);
          continue;
        }
        if (property.length != nullptr) {  // texture and the like
          body.pass_over(property);
          continue;
        }
        const double value = body.number(property);
        for (const auto& [axis, name] : {std::pair(0, "x"), std::pair(1, "y"), std::pair(2, "z")})
          if (property.name == name) vertex[axis] = value;
      }
      body.end();
      if (element.name == "vertex") {
        if (!vertex.allFinite())
          body.fail(
              "vertex " + std::to_string(i) +
              " (counting from 0) has a coordinate that is not a finite number; export it again");
        found.vertices.push_back(vertex);
      } else if (strips) {
        // A negative number ends a strip.
        for (std::size_t from = 0; from < corners.size();) {
          const auto end = std::find_if(corners.begin() + static_cast<std::ptrdiff_t>(from),
                                        corners.end(), [](int corner) { return corner < 0; });
          const std::size_t to = static_cast<std::size_t>(end - corners.begin());
          for (auto& triangle :
               triangles_of_strip(std::span<const int>(corners).subspan(from, to - from)))
            take(std::move(triangle), i);
          from = to + 1;
        }
      } else if (faces) {
        take(std::move(corners), i);
      }
    }
  }
  if (ends_with_faces) body.end_of_file(elements.back().count);
  return found;
}

}  // namespace

Polygons read_ply(const std::string& path) {
  const std::string content = read_text(path);
  const Header found = header(path, content);
  if (!is_text(content.substr(0, found.bytes)))
    fail(path, "its header is not text; export it again");
  const std::span<const Element> elements = needed(path, found);
  const bool ends_with_faces = elements.size() == found.elements.size();
  if (found.format == "ascii") {
    if (!is_text(content))
      fail(path, "is not a text file, though its header says `ascii`; export it again");
    return polygons(AsciiBody(path), elements, ends_with_faces);
  }
  const bool big_endian = found.format == "binary_big_endian";
  if (!big_endian && found.format != "binary_little_endian")
    fail(path,
         "has no known `format` in its header; write it as `ascii` or `binary_little_endian`");
  return polygons(BinaryBody(path, content, found.bytes, big_endian), elements, ends_with_faces);
}

}  // namespace palpate::meshing
