// Reads Abaqus's .inp and MEDIT's .mesh, texts of sections that begin with a word.
#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/text.h"
#include "meshing/cells.h"
#include "meshing/table_lines.h"

namespace palpate::meshing {
namespace {

void refuse_without_cells(const Cells& cells, const TableLines& lines) {
  if (cells.solids.empty() && cells.faces.empty())
    lines.fail("the file holds no solid cells and no faces; save the mesh again");
}

// The number of corners of an Abaqus element, 0 for others than solids and shells, and the nodes.
struct AbaqusKind {
  int corners = 0;
  std::size_t nodes = 0;
  bool solid = false;
};
AbaqusKind abaqus_kind(const std::string& type) {
  struct Row {
    const char* begins;
    AbaqusKind kind;
  };
  static constexpr Row rows[] = {
      {"C3D4", {4, 4, true}},    {"C3D5", {5, 5, true}},   {"C3D6", {6, 6, true}},
      {"C3D8", {8, 8, true}},    {"C3D10", {4, 10, true}}, {"C3D13", {5, 13, true}},
      {"C3D15", {6, 15, true}},  {"C3D20", {8, 20, true}}, {"C3D27", {8, 27, true}},
      {"DC3D4", {4, 4, true}},   {"DC3D8", {8, 8, true}},  {"STRI3", {3, 3, false}},
      {"S3", {3, 3, false}},     {"S4", {4, 4, false}},    {"STRI65", {3, 6, false}},
      {"S8", {4, 8, false}},     {"R3D3", {3, 3, false}},  {"R3D4", {4, 4, false}},
      {"M3D3", {3, 3, false}},   {"M3D4", {4, 4, false}},  {"CPS3", {3, 3, false}},
      {"CPS4", {4, 4, false}},   {"CPS6", {3, 6, false}},  {"CPS8", {4, 8, false}},
      {"SFM3D3", {3, 3, false}}, {"SFM3D4", {4, 4, false}}};
  // `C3D10MH` is a C3D10: letters may follow, digits may not.
  for (const Row& row : rows) {
    const std::string_view begins(row.begins);
    if (type.starts_with(begins) &&
        (type.size() == begins.size() || !is_digit(type[begins.size()])))
      return row.kind;
  }
  return {};
}

class AbaqusReader {
 public:
  explicit AbaqusReader(const std::string& path) : lines_(path) {}

  // Format: Abaqus Keywords Guide, *NODE, *ELEMENT, *ELSET.
  Cells read() {
    while (lines_.next()) {
      const std::string_view line = lines_.text();
      if (trimmed(line).starts_with("**")) continue;
      if (trimmed(line).starts_with("*"))
        keyword(line);
      else if (section_ == "*node")
        node();
      else if (section_ == "*element")
        element();
      else if (section_ == "*elset")
        members();
    }
    for (const auto& [name, set] : sets_) {
      // A set of all elements names no part.
      std::size_t found = 0;
      for (const Cell& cell : cells_.solids) found += set.contains(cell.region) ? 1 : 0;
      if (found == 0 || found == cells_.solids.size()) continue;
      const int number = region_of(name);
      for (std::size_t i = 0; i < cells_.solids.size(); ++i)
        if (set.contains(cells_.solids[i].region)) regions_[i] = number;
    }
    for (std::size_t i = 0; i < cells_.solids.size(); ++i) cells_.solids[i].region = regions_[i];
    refuse_without_cells(cells_, lines_);
    return std::move(cells_);
  }

 private:
  // Numbers of elements: single ones, and ranges of a first, a last and a step.
  struct Set {
    std::set<int> members;
    std::vector<std::array<int, 3>> ranges;

    [[nodiscard]] bool contains(int number) const {
      return members.contains(number) ||
             std::ranges::any_of(ranges, [&](const std::array<int, 3>& range) {
               return range[0] <= number && number <= range[1] &&
                      (static_cast<long>(number) - range[0]) % range[2] == 0;
             });
    }
  };

  void keyword(std::string_view line) {
    const std::vector<std::string> parts = split(line, ',');
    section_ = lower_case(trimmed(parts[0]));
    std::map<std::string, std::string> options;
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const std::size_t equals = parts[i].find('=');
      options[lower_case(trimmed(parts[i].substr(0, equals)))] =
          equals == std::string::npos ? "" : trimmed(parts[i].substr(equals + 1));
    }
    if (section_ == "*include")
      lines_.fail("an included file is not read; save the mesh as one file");
    if (section_ == "*part" && !cells_.nodes.empty())
      lines_.fail("a second part begins here; save one part, or the assembly as one mesh");
    if (section_ == "*node" && options.contains("system"))
      lines_.fail(
          "nodes in another system of coordinates are not read; save them in Cartesian ones");
    if (section_ == "*element") {
      std::string type = options["type"];
      for (char& letter : type)
        if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
      kind_ = abaqus_kind(type);
      if (kind_.corners == 0 && type.starts_with("C3D"))
        lines_.fail("elements of type `" + type + "` are not read; mesh again with C3D4 or C3D10");
      region_ = options["elset"].empty() ? 0 : region_of(options["elset"]);
    }
    if (section_ == "*elset") {
      set_ = options["elset"];
      generated_ = options.contains("generate");
    }
  }

  int region_of(const std::string& name) {
    const auto known = cells_.names.find(name);
    if (known != cells_.names.end()) return known->second;
    const int next = static_cast<int>(cells_.names.size()) + 1;
    cells_.names[name] = next;
    return next;
  }

  void node() {
    if (lines_.words().size() < 4)
      lines_.fail("a node wants its number and three coordinates; save the file again");
    const int number = lines_.whole(0, "the node's number");
    if (!node_of_number_.emplace(number, static_cast<int>(cells_.nodes.size())).second)
      lines_.fail("there are two nodes with number " + std::to_string(number) +
                  "; save one part, or the assembly as one mesh");
    const double x = lines_.number(1, "x");
    const double y = lines_.number(2, "y");
    const double z = lines_.number(3, "z");
    cells_.nodes.emplace_back(x, y, z);
  }

  void element() {
    if (kind_.corners == 0) return;  // beams, springs, masses
    std::vector<int> numbers;
    for (bool more = true; more;) {
      for (std::size_t i = 0; i < lines_.words().size(); ++i)
        numbers.push_back(lines_.whole(i, "a node"));
      more = numbers.size() < kind_.nodes + 1;
      if (more && (!lines_.next() || lines_.text().starts_with("*")))
        lines_.fail("the element before this line has too few nodes; save the file again");
    }
    const bool quadratic = kind_.solid && kind_.corners == 4 && kind_.nodes == 10;
    std::vector<int> nodes;
    for (int c = 1; c <= (quadratic ? 10 : kind_.corners); ++c) {
      const auto node = node_of_number_.find(numbers[as_index(c)]);
      if (node == node_of_number_.end())
        lines_.fail("there is no node `" + std::to_string(numbers[as_index(c)]) +
                    "`; save the file again");
      nodes.push_back(node->second);
    }
    if (!kind_.solid) {
      cells_.faces.push_back(std::move(nodes));
      return;
    }
    Cell cell{.corners = kind_.corners, .region = numbers[0]};
    std::copy_n(nodes.begin(), kind_.corners, cell.nodes.begin());
    if (quadratic)
      cell.middles = {nodes[4], nodes[5], nodes[6], nodes[7], nodes[8], nodes[9]};
    else
      cells_.curved = cells_.curved || kind_.nodes > as_index(kind_.corners);
    cells_.solids.push_back(cell);
    regions_.push_back(region_);
  }

  void members() {
    Set& set = sets_[set_];
    if (generated_) {
      if (lines_.words().size() < 2) lines_.fail("`GENERATE` wants a first and a last element");
      const int step = lines_.words().size() > 2 ? lines_.whole(2, "the step") : 1;
      if (step < 1) lines_.fail("`GENERATE` wants a step of 1 or more; save the file again");
      set.ranges.push_back(
          {lines_.whole(0, "the first element"), lines_.whole(1, "the last element"), step});
      return;
    }
    for (const std::string_view word : lines_.words())
      if (const auto number = whole_number(word); number && *number >= 0.0 && *number < 2e9)
        set.members.insert(static_cast<int>(*number));
  }

  TableLines lines_;
  std::string section_, set_;
  AbaqusKind kind_;
  int region_ = 0;
  bool generated_ = false;
  std::unordered_map<int, int> node_of_number_;
  std::map<std::string, Set> sets_;
  std::vector<int> regions_;  // one per solid
  Cells cells_;
};

class MeditReader {
 public:
  explicit MeditReader(const std::string& path) : lines_(path) {}

  // Format: P. Frey, MEDIT, INRIA technical report 0253, appendix.
  Cells read() {
    if (lower_case(word("the version")) != "meshversionformatted")
      lines_.fail("the file does not begin with `MeshVersionFormatted`; save it as a MEDIT text");
    (void)whole("the version");
    while (next()) {
      const std::string section = lower_case(lines_.words()[word_++]);
      if (section == "end") break;
      if (section == "dimension") {
        if (whole("the dimension") != 3)
          lines_.fail("the mesh wants three dimensions; save a mesh of solids");
      } else if (section == "vertices") {
        vertices();
      } else if (section == "tetrahedra" || section == "tetrahedrap2") {
        solids(4, 10, section.ends_with("p2"));
      } else if (section == "hexahedra") {
        solids(8);
      } else if (section == "prisms" || section == "wedges" || section == "pentahedra") {
        solids(6);
      } else if (section == "pyramids") {
        solids(5);
      } else if (section == "triangles" || section == "trianglesp2") {
        faces(3, 6, section.ends_with("p2"));
      } else if (section == "quadrilaterals") {
        faces(4);
      } else {
        skip();
      }
    }
    refuse_without_cells(cells_, lines_);
    return std::move(cells_);
  }

 private:
  // Goes to the next word, on this line or a later one; false at the end of the file.
  bool next() {
    if (word_ < lines_.words().size()) return true;
    word_ = 0;
    return lines_.next();
  }
  // The number of the next word.
  std::size_t must(const std::string& what) {
    if (!next()) lines_.fail("the file ends before " + what + "; it is cut short: save it again");
    return word_++;
  }
  std::string word(const std::string& what) { return std::string(lines_.words()[must(what)]); }
  int whole(const std::string& what) { return lines_.whole(must(what), what); }
  double real(const std::string& what) { return lines_.number(must(what), what); }
  // Sections of numbers that a mesh does not need.
  void skip() {
    while (next() && whole_number(lines_.words()[word_])) ++word_;
  }

  void vertices() {
    for (int left = whole("the number of vertices"); left > 0; --left) {
      const double x = real("x");
      const double y = real("y");
      const double z = real("z");
      (void)real("the reference");
      cells_.nodes.emplace_back(x, y, z);
    }
  }
  std::vector<int> vertices_of_cell(int count) {
    std::vector<int> found;
    for (int c = 0; c < count; ++c) {
      const int node = whole("a vertex");
      if (node < 1 || as_index(node) > cells_.nodes.size())
        lines_.fail_at(word_ - 1,
                       "there is no vertex `" + std::to_string(node) + "`, they run from 1 to " +
                           std::to_string(cells_.nodes.size()) + "; save the file again");
      found.push_back(node - 1);
    }
    return found;
  }
  // The vertices of each cell of the section that begins. Gmsh 4.8 names quadratic cells as it does
  // others: their first line tells, which ends in a reference.
  int width(int corners, int quadratic, bool named) {
    const bool whole_line = next() && word_ == 0;
    const bool curved =
        quadratic > 0 && whole_line && lines_.words().size() == as_index(quadratic) + 1;
    return named || curved ? quadratic : corners;
  }
  void solids(int corners, int quadratic = 0, bool named = false) {
    int left = whole("the number of cells");
    for (const int count = width(corners, quadratic, named); left > 0; --left) {
      const std::vector<int> own = vertices_of_cell(count);
      Cell cell{.corners = corners, .region = 0};
      std::copy_n(own.begin(), corners, cell.nodes.begin());
      if (count == 10) cell.middles = {own[4], own[5], own[6], own[7], own[8], own[9]};
      cell.region = std::max(0, whole("the reference"));
      cells_.solids.push_back(cell);
    }
  }
  void faces(int corners, int quadratic = 0, bool named = false) {
    int left = whole("the number of faces");
    for (const int count = width(corners, quadratic, named); left > 0; --left) {
      std::vector<int> own = vertices_of_cell(count);
      own.resize(as_index(corners));
      cells_.faces.push_back(std::move(own));
      cells_.face_groups.push_back({whole("the reference")});
    }
  }

  TableLines lines_;
  std::size_t word_ = 0;  // the next one of the line
  Cells cells_;
};

}  // namespace

Cells read_abaqus_cells(const std::string& path) { return AbaqusReader(path).read(); }

Cells read_medit_cells(const std::string& path) { return MeditReader(path).read(); }

}  // namespace palpate::meshing
