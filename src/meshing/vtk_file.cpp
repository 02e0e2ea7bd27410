// Reads legacy .vtk files of VTK: unstructured grids and polygons, ASCII or binary.
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/text.h"
#include "meshing/binary_numbers.h"
#include "meshing/cells.h"
#include "meshing/table_lines.h"

namespace palpate::meshing {
namespace {

constexpr std::array vtk_types{number_type<std::int8_t>("char", "vtktypeint8"),
                               number_type<std::uint8_t>("unsigned_char", "vtktypeuint8"),
                               number_type<std::int16_t>("short", "vtktypeint16"),
                               number_type<std::uint16_t>("unsigned_short", "vtktypeuint16"),
                               number_type<std::int32_t>("int", "vtktypeint32"),
                               number_type<std::uint32_t>("unsigned_int", "vtktypeuint32"),
                               number_type<std::int64_t>("long", "vtktypeint64"),
                               number_type<std::uint64_t>("unsigned_long", "vtktypeuint64"),
                               number_type<std::int32_t>("vtkidtype", "vtkidtype"),
                               number_type<float>("float", "float"),
                               number_type<double>("double", "double")};

class VtkReader {
 public:
  explicit VtkReader(const std::string& path) : lines_(path) {}

  // Format: VTK File Formats, "Simple Legacy Formats"; version 5.1 stores offsets of cells.
  Cells read() {
    read_header();
    while (step()) {
      const std::string word = lower_case(lines_.words()[0]);
      if (word == "points")
        read_points();
      else if (word == "cells")
        cell_nodes_ = read_lists();
      else if (word == "cell_types")
        cell_types_ = array(count(1), "int");
      else if (word == "polygons" || word == "triangle_strips")
        add_polygons(word == "triangle_strips");
      else if (word == "vertices" || word == "lines")
        read_lists();
      else if (word == "cell_data" || word == "point_data")
        in_cells_ = word == "cell_data", rows_ = count(1);
      else if (word == "field")
        read_field();
      else if (word == "scalars")
        read_scalars();
      else if (word == "vectors" || word == "normals")
        (void)array(3 * rows_, type_word(2));
      else if (word == "metadata")
        lines_.skip_paragraph();
      else if (!cell_types_.empty() || !cells_.faces.empty())
        break;  // what follows are values of other kinds
      else
        lines_.fail_at(0,
                       "`" + word + "` is not understood; save the mesh as an unstructured grid");
    }
    for (std::size_t i = 0; i < cell_types_.size() && i < cell_nodes_.size(); ++i)
      if (!add_vtk_cell(static_cast<int>(cell_types_[i]), checked(cell_nodes_[i]),
                        static_cast<int>(i), cells_))
        lines_.fail("cell " + std::to_string(i) + " is of type " + number_text(cell_types_[i]) +
                    ", which is not read; save tetrahedra, hexahedra, prisms or pyramids");
    if (cells_.solids.empty() && cells_.faces.empty())
      lines_.fail("the file holds no solid cells and no polygons; save the mesh again");
    number_by(regions_, cells_);
    return std::move(cells_);
  }

 private:
  void read_header() {
    constexpr std::string_view first = "# vtk DataFile Version ";
    const std::string_view text = lines_.file_text();
    if (lower_case(text.substr(0, first.size())) != lower_case(first))
      lines_.fail(
          "the file does not begin with `# vtk DataFile Version`; give it the ending of its real "
          "format");
    const auto version = leading_number(text.substr(first.size(), 8));
    offsets_ = version && version->value >= 5.0;
    bool known = step();
    if (known && lines_.line() == 2) known = step();  // the title
    const std::string format = known ? lower_case(lines_.words()[0]) : "";
    if (format != "ascii" && format != "binary")
      lines_.fail("the third line wants `ASCII` or `BINARY`; save the file again");
    binary_ = format == "binary";
    if (!step() || lower_case(lines_.words()[0]) != "dataset" || lines_.words().size() < 2)
      lines_.fail("`DATASET` should stand here; save the file again");
    const std::string kind = lower_case(lines_.words()[1]);
    if (kind != "unstructured_grid" && kind != "polydata")
      lines_.fail_at(1, "a data set of kind `" + kind +
                            "` is not read; save it as an unstructured grid or as polygons");
  }

  // Goes to the next line.
  bool step() {
    word_ = 0;
    return lines_.next();
  }
  std::size_t count(std::size_t i) const {
    const int number = i < lines_.words().size() ? lines_.whole(i, "a count") : -1;
    if (number < 0) lines_.fail("a count is missing or negative; save the file again");
    return as_index(number);
  }
  std::string type_word(std::size_t i) const {
    if (i >= lines_.words().size())
      lines_.fail("the type of numbers is missing; save the file again");
    return lower_case(lines_.words()[i]);
  }

  // So many numbers, which follow the current line.
  std::vector<double> array(std::size_t size, const std::string& type) {
    const NumberType* const known = type_named(vtk_types, type);
    if (known == nullptr)
      lines_.fail("numbers of type `" + type + "` are not read; save the file again");
    std::vector<double> values;
    if (binary_) {
      if (size > lines_.file_text().size())
        lines_.fail("more numbers are counted than the file has; it is cut short: save it again");
      const std::string_view bytes = lines_.take(size * known->bytes);
      for (std::size_t i = 0; i < size; ++i)
        values.push_back(known->read(bytes.data() + i * known->bytes, true));
    } else {
      for (word_ = lines_.words().size(); values.size() < size; ++word_) {
        if (word_ >= lines_.words().size() && !step())
          lines_.fail("the file ends in its numbers; it is cut short: save it again");
        values.push_back(lines_.number(word_, "a value"));
      }
    }
    return values;
  }

  void read_points() {
    const std::size_t total = count(1);
    const std::vector<double> values = array(3 * total, type_word(2));
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
      cells_.nodes.emplace_back(values[i], values[i + 1], values[i + 2]);
      if (!cells_.nodes.back().allFinite())
        lines_.fail("point " + std::to_string(i / 3) +
                    " has a coordinate that is not a finite number; save the file again");
    }
  }

  static int node_number(double value) {
    return value >= 0.0 && value < 2147483647.0 ? static_cast<int>(value) : -1;
  }

  // The nodes of all cells of a section.
  std::vector<std::vector<int>> read_lists() {
    const std::size_t first = count(1), second = count(2);
    std::vector<std::vector<int>> lists;
    if (!offsets_) {
      const std::vector<double> values = array(second, "int");
      std::size_t at = 0;
      for (std::size_t i = 0; i < first; ++i) {
        const double size = at < values.size() ? values[at++] : -1.0;
        if (!(size >= 0.0 && size <= static_cast<double>(values.size() - at)))
          lines_.fail("cell " + std::to_string(i) + " has more nodes than follow; save it again");
        std::vector<int>& list = lists.emplace_back();
        for (double k = 0.0; k < size; ++k) list.push_back(node_number(values[at++]));
      }
      return lists;
    }
    const auto part = [&](const char* name, std::size_t size) {
      if (!step() || lower_case(lines_.words()[0]) != name)
        lines_.fail("`" + std::string(name) + "` should stand here; save the file again");
      return array(size, type_word(1));
    };
    const std::vector<double> offsets = part("offsets", first);
    const std::vector<double> nodes = part("connectivity", second);
    for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
      if (!(offsets[i] >= 0.0 && offsets[i] <= offsets[i + 1] &&
            offsets[i + 1] <= static_cast<double>(nodes.size())))
        lines_.fail("cell " + std::to_string(i) + " has a wrong offset; save the file again");
      std::vector<int>& list = lists.emplace_back();
      for (double k = offsets[i]; k < offsets[i + 1]; ++k)
        list.push_back(node_number(nodes[static_cast<std::size_t>(k)]));
    }
    return lists;
  }

  const std::vector<int>& checked(const std::vector<int>& list) const {
    for (const int node : list)
      if (node < 0 || as_index(node) >= cells_.nodes.size())
        lines_.fail("a cell names a point that the file does not have; save it again");
    return list;
  }

  void add_polygons(bool strips) {
    for (const auto& list : read_lists()) {
      if (list.size() < 3) lines_.fail("a polygon wants three corners or more; save it again");
      std::vector<int> corners = checked(list);
      if (strips)
        std::ranges::copy(triangles_of_strip(corners), std::back_inserter(cells_.faces));
      else
        cells_.faces.push_back(std::move(corners));
    }
  }

  void take_regions(const std::string& name, std::size_t components, std::vector<double> values) {
    if (in_cells_ && components == 1 && numbers_parts(name) && values.size() == rows_)
      regions_ = std::move(values);
  }
  void read_scalars() {
    if (lines_.words().size() < 3) lines_.fail("`SCALARS` wants a name and a type; save it again");
    const std::string name(lines_.words()[1]);
    const std::string type = type_word(2);
    const std::size_t components = lines_.words().size() > 3 ? count(3) : 1;
    if (!step() || lower_case(lines_.words()[0]) != "lookup_table")
      lines_.fail("`LOOKUP_TABLE` should stand here; save the file again");
    if (components > 4) lines_.fail("`SCALARS` have at most 4 components; save the file again");
    take_regions(name, components, array(components * rows_, type));
  }
  void read_field() {
    const std::size_t arrays = count(2);
    for (std::size_t i = 0; i < arrays; ++i) {
      if (!step()) lines_.fail("the file ends in its fields; it is cut short: save it again");
      if (lower_case(lines_.words()[0]) == "metadata") {
        lines_.skip_paragraph();
        if (!step()) break;
      }
      const std::string name(lines_.words()[0]);
      const std::size_t components = count(1), tuples = count(2);
      if (components > 1000) lines_.fail("a field has too many components; save the file again");
      take_regions(name, components, array(components * tuples, type_word(3)));
    }
  }
  TableLines lines_;
  std::size_t word_ = 0;  // of the current line
  bool binary_ = false, offsets_ = false, in_cells_ = false;
  std::size_t rows_ = 0;  // of the values of cells or points
  std::vector<std::vector<int>> cell_nodes_;
  std::vector<double> cell_types_, regions_;
  Cells cells_;
};

}  // namespace

Cells read_vtk_cells(const std::string& path) { return VtkReader(path).read(); }

}  // namespace palpate::meshing
