// Reads .vtu and .vtp files, VTK's unstructured grids and polygons in XML.
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "meshing/binary_numbers.h"
#include "meshing/cells.h"

namespace palpate::meshing {
namespace {

constexpr std::array vtu_types{
    number_type<std::int8_t>("Int8", "char"),    number_type<std::uint8_t>("UInt8", "uchar"),
    number_type<std::int16_t>("Int16", "short"), number_type<std::uint16_t>("UInt16", "ushort"),
    number_type<std::int32_t>("Int32", "int"),   number_type<std::uint32_t>("UInt32", "uint"),
    number_type<std::int64_t>("Int64", "long"),  number_type<std::uint64_t>("UInt64", "ulong"),
    number_type<float>("Float32", "float"),      number_type<double>("Float64", "double")};

// An opening or closing tag; `after` is where its content begins.
struct XmlTag {
  std::string name;  // `/Name` of a closing tag
  std::map<std::string, std::string> attributes;
  std::size_t after = 0;

  [[nodiscard]] std::string attribute(const std::string& key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? "" : found->second;
  }
};

// The next tag from a place on; comments and declarations are passed over. VTK's files have no
// entities and no sections of character data.
std::optional<XmlTag> next_tag(std::string_view text, std::size_t from) {
  constexpr std::string_view blanks = " \t\r\n";
  while ((from = text.find('<', from)) != std::string_view::npos) {
    if (text.substr(from, 4) == "<!--") {
      from = text.find("-->", from);
      continue;
    }
    const std::size_t end = text.find('>', from);
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view inside = text.substr(from + 1, end - from - 1);
    from = end + 1;
    if (inside.empty() || inside[0] == '?' || inside[0] == '!') continue;
    XmlTag tag;
    tag.after = end + 1;
    std::size_t at = std::min(inside.find_first_of(" \t\r\n/", 1), inside.size());
    tag.name = inside.substr(0, at);
    while ((at = inside.find_first_not_of(blanks, at)) != std::string_view::npos) {
      const std::size_t equals = inside.find('=', at);
      if (equals == std::string_view::npos) break;
      const std::size_t open = inside.find_first_of("\"'", equals);
      if (open == std::string_view::npos) break;
      const std::size_t close = inside.find(inside[open], open + 1);
      if (close == std::string_view::npos) break;
      tag.attributes[trimmed(inside.substr(at, equals - at))] =
          inside.substr(open + 1, close - open - 1);
      at = close + 1;
    }
    return tag;
  }
  return std::nullopt;
}

// Bytes one after the other, raw or in base64, whose blocks may be padded one by one.
class XmlBytes {
 public:
  XmlBytes(std::string_view text, bool base64) : text_(text), base64_(base64) {}

  // Nothing if there are fewer.
  std::optional<std::string> take(std::uint64_t count) {
    if (count > text_.size()) return std::nullopt;
    if (!base64_) {
      if (count > text_.size() - at_) return std::nullopt;
      at_ += count;
      return std::string(text_.substr(at_ - count, count));
    }
    while (ready_.size() < count)
      if (!decode_four()) return std::nullopt;
    std::string taken = ready_.substr(0, count);
    ready_.erase(0, count);
    return taken;
  }

 private:
  bool decode_four() {
    std::uint32_t bits = 0;
    int letters = 0, padding = 0;
    for (; letters < 4 && at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
      int value = 0;
      if (c >= 'A' && c <= 'Z')
        value = c - 'A';
      else if (c >= 'a' && c <= 'z')
        value = c - 'a' + 26;
      else if (c >= '0' && c <= '9')
        value = c - '0' + 52;
      else if (c == '+' || c == '/')
        value = c == '+' ? 62 : 63;
      else if (c == '=')
        ++padding;
      else
        return false;
      bits = bits << 6U | static_cast<std::uint32_t>(value);
      ++letters;
    }
    if (letters < 4 || padding > 2) return false;
    for (int i = 0; i < 3 - padding; ++i)
      ready_ += static_cast<char>((bits >> (16U - 8U * static_cast<unsigned>(i))) & 0xffU);
    return true;
  }

  std::string_view text_;
  bool base64_;
  std::size_t at_ = 0;
  std::string ready_;
};

class VtuReader {
 public:
  explicit VtuReader(const std::string& path) : path_(path), text_(read_text(path)) {}

  // Format: VTK File Formats, "XML File Formats".
  Cells read() {
    const std::string_view text(text_);
    if (text.rfind("</VTKFile>") == std::string_view::npos) refuse("ends before `</VTKFile>`");
    const std::size_t data = text.find("<AppendedData");
    const std::string_view structure = text.substr(0, data);
    if (data != std::string_view::npos) {
      const auto tag = next_tag(text, data);
      const std::size_t mark = tag ? text.find('_', tag->after) : std::string_view::npos;
      if (mark == std::string_view::npos) refuse("its appended data do not begin with `_`");
      appended_ = text.substr(mark + 1);
      appended_base64_ = tag->attribute("encoding") != "raw";
    }
    std::size_t at = 0;
    while (const auto tag = next_tag(structure, at)) {
      at = tag->after;
      if (tag->name == "VTKFile") {
        open(*tag);
      } else if (tag->name == "Piece") {
        end_piece();
        piece_ = cells_.nodes.size();
      } else if (tag->name == "DataArray") {
        take(*tag, structure);
      } else if (tag->name[0] != '/') {
        section_ = tag->name;
      }
    }
    if (kind_.empty()) refuse("is no file of VTK: `<VTKFile` is missing");
    end_piece();
    if (cells_.solids.empty() && cells_.faces.empty())
      refuse("holds no solid cells and no polygons");
    number_by(regions_, cells_);
    return std::move(cells_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError({path_}, what + "; save the mesh again");
  }

  void open(const XmlTag& tag) {
    kind_ = tag.attribute("type");
    if (kind_ != "UnstructuredGrid" && kind_ != "PolyData")
      refuse("holds data of kind `" + kind_ + "`, and an unstructured grid or polygons are read");
    big_endian_ = tag.attribute("byte_order") == "BigEndian";
    wide_header_ = tag.attribute("header_type") == "UInt64";
    const std::string by = tag.attribute("compressor");
    compressed_ = !by.empty();
    if (compressed_ && by != "vtkZLibDataCompressor")
      refuse("is compressed by `" + by + "`, and only zlib is read");
  }

  void take(const XmlTag& tag, std::string_view structure) {
    const std::string name = tag.attribute("Name");
    const bool cells = section_ == "Cells" || section_ == "Polys";
    if (section_ == "Points")
      points_ = array(tag, structure);
    else if (cells && name == "connectivity")
      connectivity_ = array(tag, structure);
    else if (cells && name == "offsets")
      offsets_ = array(tag, structure);
    else if (cells && name == "types")
      types_ = array(tag, structure);
    else if (section_ == "Strips" && name == "connectivity" && !array(tag, structure).empty())
      refuse("holds strips of triangles, which are not read");
    else if (section_ == "CellData" && numbers_parts(name) && piece_regions_.empty())
      piece_regions_ = array(tag, structure);
  }

  std::vector<double> array(const XmlTag& tag, std::string_view structure) const {
    const NumberType* const type = type_named(vtu_types, tag.attribute("type"));
    if (type == nullptr) refuse("has numbers of type `" + tag.attribute("type") + "`");
    const std::string format = tag.attribute("format");
    if (format == "appended") {
      const auto offset = whole_number(tag.attribute("offset"));
      if (!offset || !(*offset >= 0.0 && *offset <= static_cast<double>(appended_.size())))
        refuse("has an array that begins beyond its end");
      return numbers({appended_.substr(static_cast<std::size_t>(*offset)), appended_base64_},
                     *type);
    }
    const std::size_t end = std::min(structure.find('<', tag.after), structure.size());
    const std::string_view content = structure.substr(tag.after, end - tag.after);
    if (format == "binary") return numbers({content, true}, *type);
    std::vector<double> values;
    constexpr std::string_view blanks = " \t\r\n";
    for (std::size_t at = content.find_first_not_of(blanks); at < content.size();) {
      const std::size_t stop = std::min(content.find_first_of(blanks, at), content.size());
      const auto value = whole_number(content.substr(at, stop - at));
      if (!value) refuse("has `" + std::string(content.substr(at, stop - at)) + "` for a number");
      values.push_back(*value);
      at = content.find_first_not_of(blanks, stop);
    }
    return values;
  }

  [[nodiscard]] std::string must(std::optional<std::string> bytes) const {
    if (!bytes) refuse("has an array that is cut short");
    return std::move(*bytes);
  }
  [[nodiscard]] std::uint64_t header(XmlBytes& from) const {
    return wide_header_ ? number_at<std::uint64_t>(must(from.take(8)).data(), big_endian_)
                        : number_at<std::uint32_t>(must(from.take(4)).data(), big_endian_);
  }

  std::vector<double> numbers(XmlBytes from, const NumberType& type) const {
    const std::string bytes = compressed_ ? inflated(from) : must(from.take(header(from)));
    std::vector<double> values;
    for (std::size_t at = 0; at + type.bytes <= bytes.size(); at += type.bytes)
      values.push_back(type.read(bytes.data() + at, big_endian_));
    return values;
  }

  std::string inflated(XmlBytes& from) const {
    const std::uint64_t blocks = header(from), whole = header(from), last = header(from);
    if (blocks > text_.size()) refuse("has an array that is cut short");
    std::vector<std::uint64_t> sizes;
    for (std::uint64_t i = 0; i < blocks; ++i) sizes.push_back(header(from));
    std::string bytes;
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const std::string packed = must(from.take(sizes[i]));
      const std::uint64_t size = i + 1 == blocks && last > 0 ? last : whole;
      // zlib makes at most 1032 bytes of one.
      if (size > 1100 * (packed.size() + 1)) refuse("has a block that cannot be so large");
      std::string block(size, '\0');
      uLongf made = size;
      if (uncompress(reinterpret_cast<Bytef*>(block.data()), &made,
                     reinterpret_cast<const Bytef*>(packed.data()), packed.size()) != Z_OK ||
          made != size)
        refuse("has an array whose compression is broken");
      bytes += block;
    }
    return bytes;
  }

  // Adds what the piece at hand has.
  void end_piece() {
    for (std::size_t i = 0; i + 2 < points_.size(); i += 3) {
      cells_.nodes.emplace_back(points_[i], points_[i + 1], points_[i + 2]);
      if (!cells_.nodes.back().allFinite())
        refuse("has a point with a coordinate that is not a finite number");
    }
    const std::size_t count = cells_.nodes.size() - piece_;
    const bool polygons = kind_ == "PolyData";
    double begin = 0.0;
    for (std::size_t i = 0; i < offsets_.size(); ++i) {
      const double end = offsets_[i];
      if (!(end >= begin && end <= static_cast<double>(connectivity_.size())))
        refuse("has a cell with a wrong offset");
      std::vector<int> nodes;
      for (double k = begin; k < end; ++k) {
        const double node = connectivity_[static_cast<std::size_t>(k)];
        if (!(node >= 0.0 && node < static_cast<double>(count)))
          refuse("has a cell that names a point that is not there");
        nodes.push_back(static_cast<int>(piece_) + static_cast<int>(node));
      }
      begin = end;
      const double type = polygons ? 7.0 : i < types_.size() ? types_[i] : -1.0;
      if (!(type >= 0.0 && type < 256.0) ||
          !add_vtk_cell(static_cast<int>(type), nodes, static_cast<int>(regions_.size()), cells_))
        refuse("has a cell of type " + number_text(type) +
               ", and only points, lines, polygons, tetrahedra, hexahedra, prisms and pyramids are "
               "read");
      regions_.push_back(i < piece_regions_.size() ? piece_regions_[i] : 0.0);
    }
    for (auto* list : {&points_, &connectivity_, &offsets_, &types_, &piece_regions_})
      list->clear();
  }

  std::string path_, text_;
  std::string kind_, section_;
  bool big_endian_ = false, wide_header_ = false, compressed_ = false, appended_base64_ = false;
  std::string_view appended_;
  std::size_t piece_ = 0;  // the first node of the piece at hand
  std::vector<double> points_, connectivity_, offsets_, types_, piece_regions_;
  std::vector<double> regions_;  // one per cell of all pieces
  Cells cells_;
};

}  // namespace

Cells read_vtu_cells(const std::string& path) { return VtuReader(path).read(); }

}  // namespace palpate::meshing
