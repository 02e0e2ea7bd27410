// Reads Gmsh's .msh files: the sections between `$Name` and `$EndName` that a mesh needs.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <unordered_map>
#include <utility>

#include "meshing/binary_numbers.h"
#include "meshing/cells.h"
#include "meshing/table_lines.h"

namespace palpate::meshing {
namespace {

// A type of elements: all its nodes, and its corners, which come first.
struct GmshKind {
  int type, nodes, corners, dimension;
};
constexpr GmshKind gmsh_kinds[] = {
    {1, 2, 2, 1},   {2, 3, 3, 2},   {3, 4, 4, 2},   {4, 4, 4, 3},   {5, 8, 8, 3},   {6, 6, 6, 3},
    {7, 5, 5, 3},   {8, 3, 2, 1},   {9, 6, 3, 2},   {10, 9, 4, 2},  {11, 10, 4, 3}, {12, 27, 8, 3},
    {13, 18, 6, 3}, {14, 14, 5, 3}, {15, 1, 1, 0},  {16, 8, 4, 2},  {17, 20, 8, 3}, {18, 15, 6, 3},
    {19, 13, 5, 3}, {20, 9, 3, 2},  {21, 10, 3, 2}, {22, 12, 3, 2}, {23, 15, 3, 2}, {24, 15, 3, 2},
    {25, 21, 3, 2}, {26, 4, 2, 1},  {27, 5, 2, 1},  {28, 6, 2, 1},  {29, 20, 4, 3}, {30, 35, 4, 3},
    {31, 56, 4, 3}, {36, 16, 4, 2}, {37, 25, 4, 2}, {90, 40, 6, 3}, {91, 75, 6, 3}, {92, 64, 8, 3},
    {93, 125, 8, 3}};

constexpr int quadratic_tetrahedron = 11;

constexpr const char* save_again = "; save the file again from Gmsh";

// The numbers of a section: one record a line in ASCII, one after the other in binary.
class GmshReader {
 public:
  explicit GmshReader(const std::string& path) : path_(path), lines_(path) {}

  Cells read() {
    bool more = lines_.next();
    if (more && lines_.words()[0] == "$NOD") {
      version_1_ = true;
    } else {
      read_format(more);
      more = lines_.next();
    }
    for (; more; more = lines_.next()) {
      const std::string section(lines_.words()[0]);
      section_ = section;
      if (section == "$Entities" && version_4_) {
        read_entities();
      } else if (section == "$PhysicalNames") {
        read_names();
      } else if (section == "$Nodes" || (version_1_ && section == "$NOD")) {
        version_4_ ? read_nodes_4() : read_nodes_2();
      } else if (section == "$Elements" || (version_1_ && section == "$ELM")) {
        version_4_ ? read_elements_4() : read_elements_2();
      } else if (section == "$PartitionedEntities") {
        lines_.fail_at(0, "the mesh is cut into partitions; save it without them");
      } else if (section.starts_with("$") && !section.starts_with("$End")) {
        skip(section);
        continue;
      } else {
        lines_.fail_at(
            0, "a section such as `$Nodes` should begin here, got `" + section + "`" + save_again);
      }
      expect_end(section);
    }
    if (cells_.solids.empty() && cells_.faces.empty())
      lines_.fail(
          "the file holds no solid cells and no faces; mesh the volumes (`gmsh -3`), and where "
          "there are physical groups put the volumes into them");
    return std::move(cells_);
  }

 private:
  void read_format(bool any) {
    if (!any || lines_.words()[0] != "$MeshFormat")
      lines_.fail(
          "the file does not begin with `$MeshFormat`; save it from Gmsh as version 4.1 (`gmsh "
          "-format msh41`)");
    section_ = "$MeshFormat";
    begin(2);
    const std::string version(lines_.words()[0]);
    if (version != "4.1" && version != "2.2" && version != "2.1" && version != "2.0" &&
        version != "2")
      lines_.fail_at(
          0, "version `" + version + "` is not read; save it as 4.1 (`gmsh -format msh41`)");
    version_4_ = version == "4.1";
    if (lines_.words()[1] != "0") {
      if (lines_.words().size() < 3 || lines_.words()[2] != "8")
        lines_.fail("a binary file wants numbers of 8 bytes" + std::string(save_again));
      binary_ = true;
      const auto one = lines_.take(4);
      big_endian_ = number_at<std::int32_t>(one.data(), false) != 1;
      if (number_at<std::int32_t>(one.data(), big_endian_) != 1)
        lines_.fail("no binary numbers follow, as `1 8` announces" + std::string(save_again));
    }
    expect_end("$MeshFormat");
  }

  // Begins a record of at least `least` words.
  void begin(std::size_t least) {
    word_ = 0;
    if (binary_) return;
    if (!lines_.next() || lines_.words()[0].starts_with("$"))
      lines_.fail("section `" + section_ + "` ends too early" + save_again);
    want_words(least);
  }
  void want_words(std::size_t least) const {
    if (!binary_ && lines_.words().size() < least)
      lines_.fail("the line has " + std::to_string(lines_.words().size()) +
                  " words, but at least " + std::to_string(least) + " belong here" + save_again);
  }
  // The counts of sections are text in binary files of version 2.2.
  int text_count(const std::string& what) {
    const bool before = std::exchange(binary_, false);
    begin(1);
    const int found = static_cast<int>(count(what));
    binary_ = before;
    return found;
  }

  template <class Number>
  Number binary() {
    return number_at<Number>(lines_.take(sizeof(Number)).data(), big_endian_);
  }
  [[noreturn]] void fail(const std::string& message, const std::string& remedy = save_again) const {
    if (!binary_ && word_ > 0 && word_ <= lines_.words().size())
      lines_.fail_at(word_ - 1, message + remedy);
    throw InputError({path_, binary_ ? 0 : lines_.line()},
                     (binary_ ? "in section `" + section_ + "` " : "") + message + remedy);
  }
  int whole(const std::string& what) {
    if (binary_) return binary<std::int32_t>();
    want_words(word_ + 1);
    return lines_.whole(word_++, what);
  }
  // What version 4.1 stores in 8 bytes.
  std::int64_t wide(const std::string& what) {
    return binary_ ? binary<std::int64_t>() : whole(what);
  }
  std::int64_t count(const std::string& what, bool of_8_bytes = false) {
    const std::int64_t number = of_8_bytes ? wide(what) : whole(what);
    if (number < 0 || number > std::numeric_limits<int>::max())
      fail(what + " wants 0 or more, got `" + std::to_string(number) + "`");
    return number;
  }
  double real(const std::string& what) {
    if (!binary_) {
      want_words(word_ + 1);
      return lines_.number(word_++, what);
    }
    const double number = binary<double>();
    if (!std::isfinite(number)) fail(what + " wants a finite number");
    return number;
  }

  void expect_end(const std::string& section) {
    const std::string end = (version_1_ ? "$END" : "$End") + section.substr(1);
    if (!lines_.next() || lines_.words()[0] != end)
      lines_.fail("`" + end + "` should stand here" + save_again);
  }
  // Its end follows binary numbers on the same line in files of some programs.
  void skip(const std::string& section) {
    const std::string end = "$End" + section.substr(1);
    while (lines_.next())
      if (lines_.words()[0] == end || trimmed(lines_.text()).ends_with(end)) return;
    lines_.fail("section `" + section + "` has no `" + end + "`" + save_again);
  }

  // `3 7 "surface"`: the dimension, the tag and the name of a group.
  void read_names() {
    const int total = text_count("the number of names");
    const bool before = std::exchange(binary_, false);
    for (int i = 0; i < total; ++i) {
      begin(3);
      const int dimension = whole("the dimension");
      const int tag = std::abs(whole("the physical tag"));
      const std::string_view line = lines_.text();
      const std::size_t open = line.find('"'), close = line.rfind('"');
      if (dimension < 2 || close <= open) continue;
      (dimension == 3 ? cells_.names
                      : cells_.face_names)[std::string(line.substr(open + 1, close - open - 1))] =
          tag;
    }
    binary_ = before;
  }

  // Reads the physical group of each volume and surface.
  void read_entities() {
    std::array<std::int64_t, 4> totals{};
    begin(4);
    for (auto& total : totals) total = count("the number of entities", true);
    for (std::size_t dimension = 0; dimension < 4; ++dimension)
      for (std::int64_t i = 0; i < totals[dimension]; ++i) {
        begin(dimension == 0 ? 4 : 7);
        const int entity = whole("the entity's tag");
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) (void)real("a coordinate");
        const auto groups = count("the number of physical groups", true);
        if (dimension == 3 && groups > 1)
          fail("the volume belongs to " + std::to_string(groups) +
                   " physical groups, so its tissue is not clear",
               "; leave it in one");
        // A negative tag means that the group reverses the element, which has no effect here.
        for (std::int64_t g = 0; g < groups; ++g) {
          const int group = std::abs(whole("the physical tag"));
          if (dimension == 2) surface_groups_[entity].push_back(group);
          if (dimension == 3) volume_region_[entity] = group;
        }
        if (dimension == 0) continue;
        const auto bounds = count("the number of bounds", true);
        for (std::int64_t b = 0; b < bounds; ++b) (void)whole("a bound");
      }
  }

  void add_node(std::int64_t tag) {
    Vec3 place;
    for (int axis = 0; axis < 3; ++axis) place[axis] = real(std::string(1, "xyz"[axis]));
    if (!node_of_tag_.emplace(tag, static_cast<int>(cells_.nodes.size())).second) {
      word_ = 0;
      fail("there are two nodes with tag " + std::to_string(tag));
    }
    cells_.nodes.push_back(place);
  }

  void read_nodes_2() {
    const int total = text_count("the number of nodes");
    for (int i = 0; i < total; ++i) {
      begin(4);
      add_node(whole("the node's tag"));
    }
  }

  void read_nodes_4() {
    begin(4);
    const auto blocks = count("the number of blocks", true);
    for (int k = 0; k < 3; ++k) (void)wide("a tag");
    for (std::int64_t b = 0; b < blocks; ++b) {
      begin(4);
      const int dimension = whole("the dimension");
      (void)whole("the entity's tag");
      const bool parametric = whole("whether nodes have parameters") != 0;
      const auto total = count("the number of nodes", true);
      std::vector<std::int64_t> tags;
      for (std::int64_t i = 0; i < total; ++i) {
        begin(1);
        tags.push_back(wide("the node's tag"));
      }
      for (const std::int64_t tag : tags) {
        begin(3);
        add_node(tag);
        if (binary_ && parametric)  // on a line of an ASCII file the rest is not looked at
          for (int k = 0; k < dimension; ++k) (void)real("a parameter");
      }
    }
  }

  const GmshKind& kind_of(int type) const {
    for (const GmshKind& kind : gmsh_kinds)
      if (kind.type == type) return kind;
    fail("elements of type " + std::to_string(type) + " are not known",
         "; mesh again with tetrahedra of first or second order");
  }

  void add_element(const GmshKind& kind, const std::vector<int>& groups, bool of_8_bytes) {
    std::vector<int> nodes;
    for (int n = 0; n < kind.nodes; ++n) {
      const std::int64_t tag = of_8_bytes ? wide("a node") : whole("a node");
      if ((n >= kind.corners && kind.type != quadratic_tetrahedron) || kind.dimension < 2) continue;
      const auto node = node_of_tag_.find(tag);
      if (node == node_of_tag_.end())
        fail("there is no node `" + std::to_string(tag) + "` in `$Nodes`");
      nodes.push_back(node->second);
    }
    if (kind.dimension < 2) return;
    if (kind.dimension == 2) {
      cells_.faces.push_back(std::move(nodes));
      cells_.face_groups.push_back(groups);
      return;
    }
    Cell cell{.corners = kind.corners, .region = groups.front()};
    std::copy_n(nodes.begin(), kind.corners, cell.nodes.begin());
    if (kind.type == quadratic_tetrahedron)
      cell.middles = {nodes[4], nodes[5], nodes[6], nodes[7], nodes[9], nodes[8]};
    else
      cells_.curved = cells_.curved || kind.nodes > kind.corners;
    cells_.solids.push_back(cell);
  }

  void read_elements_2() {
    const int total = text_count("the number of elements");
    for (int i = 0; i < total;) {
      begin(3);
      if (!binary_) (void)whole("the element's tag");
      const GmshKind& kind = kind_of(whole("the element's type"));
      const auto together = binary_ ? count("the number of elements") : 1;
      // Version 1 has the group, the entity and the number of nodes here.
      const auto tags = version_1_ ? 3 : count("the number of tags");
      if (together < 1 || together > total - i) fail("more elements follow than are counted");
      want_words(word_ + as_index(static_cast<int>(tags)) + as_index(kind.nodes));
      for (std::int64_t k = 0; k < together; ++k, ++i) {
        if (binary_) (void)whole("the element's tag");
        int region = 0;
        for (std::int64_t t = 0; t < tags; ++t) {
          const int tag = whole("a tag");
          if (t == 0) region = std::abs(tag);
        }
        add_element(kind, {region}, false);
      }
    }
  }

  void read_elements_4() {
    begin(4);
    const auto blocks = count("the number of blocks", true);
    for (int k = 0; k < 3; ++k) (void)wide("a tag");
    for (std::int64_t b = 0; b < blocks; ++b) {
      begin(4);
      (void)whole("the dimension");
      const int entity = whole("the entity's tag");
      const GmshKind& kind = kind_of(whole("the element's type"));
      const auto total = count("the number of elements", true);
      std::vector<int> groups{0};
      if (kind.dimension == 2 && surface_groups_.contains(entity)) groups = surface_groups_[entity];
      if (kind.dimension == 3 && volume_region_.contains(entity)) groups = {volume_region_[entity]};
      for (std::int64_t i = 0; i < total; ++i) {
        begin(1 + as_index(kind.nodes));
        (void)wide("the element's tag");
        add_element(kind, groups, true);
      }
    }
  }

  std::string path_;
  TableLines lines_;
  std::string section_;
  std::size_t word_ = 0;  // the next one of a line
  bool version_1_ = false, version_4_ = false, binary_ = false, big_endian_ = false;
  // The physical tags of each surface and volume that has some.
  std::unordered_map<int, std::vector<int>> surface_groups_;
  std::unordered_map<int, int> volume_region_;
  std::unordered_map<std::int64_t, int> node_of_tag_;
  Cells cells_;
};

}  // namespace

Cells read_gmsh_cells(const std::string& path) { return GmshReader(path).read(); }

}  // namespace palpate::meshing
